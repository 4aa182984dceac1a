// Every wrong input of tests/support/wrong_scenes must be refused, with the key and what to do.
//
// A case is a change of one of the valid scenes: {"base": file, "replace": [[old, new], ...] in its
// text, "set": overrides, "expect": parts of the messages, "place": "line:column" of one of them,
// "errors": how many (1 where it is not said)}.
#include "src/scene/read_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

using namespace ligament;
using namespace ligament::program;

namespace
{
const std::string support = LIGAMENT_SOURCE_DIR "/tests/support/";

std::string contents(const std::string &file)
{
  std::ifstream stream(file);
  EXPECT_TRUE(stream) << file;
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::vector<std::string> case_names(const std::string &folder = "wrong_scenes")
{
  std::vector<std::string> names;
  for (const auto &entry : std::filesystem::directory_iterator(support + folder))
    names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

class WrongScene : public testing::TestWithParam<std::string>
{
};

class DoubtfulScene : public testing::TestWithParam<std::string>
{
};

/// The scene of a case, read.
ReadResult read_case(const nlohmann::json &c)
{
  std::string text = contents(support + "scenes/" + c["base"].get<std::string>());
  for (const auto &change : c.value("replace", nlohmann::json::array())) {
    const std::string old = change[0];
    const std::size_t start = text.find(old);
    EXPECT_NE(start, std::string::npos) << old;
    if (start != std::string::npos)
      text.replace(start, old.size(), change[1].get<std::string>());
  }
  return parse_scene(text, "scene.json", c.value("set", std::vector<std::string>()));
}

std::string to_string(const std::vector<core::Diagnostic> &diagnostics)
{
  std::string text;
  for (const core::Diagnostic &d : diagnostics)
    text += core::to_string(d) + "\n";
  return text;
}
} // namespace

TEST_P(WrongScene, IsRefused)
{
  const auto wrong =
      nlohmann::json::parse(contents(support + "wrong_scenes/" + GetParam() + ".json"));
  const ReadResult result = read_case(wrong);

  std::string messages;
  bool at_place = false, has_remedies = true;
  for (const core::Diagnostic &error : result.errors) {
    messages += core::to_string(error) + "\n";
    at_place = at_place || core::to_string(error.place) == "scene.json:" + wrong.value("place", "");
    has_remedies = has_remedies && !error.remedy.empty();
  }
  EXPECT_FALSE(result.scene);
  EXPECT_EQ(int(result.errors.size()), wrong.value("errors", 1)) << messages;
  EXPECT_TRUE(at_place || !wrong.contains("place")) << wrong.value("place", "") << "\n" << messages;
  EXPECT_TRUE(has_remedies) << messages;
  for (const std::string part : wrong["expect"])
    EXPECT_NE(messages.find(part), std::string::npos) << part << "\n" << messages;
}

INSTANTIATE_TEST_SUITE_P(Corpus, WrongScene, testing::ValuesIn(case_names()),
                         [](const auto &info) { return info.param; });

// What is possible but was hardly meant: a warning, with what to do, and a scene. What the scene
// resolves to is as doubtful as the scene, no more.
TEST_P(DoubtfulScene, IsDoubted)
{
  const auto doubtful =
      nlohmann::json::parse(contents(support + "doubtful_scenes/" + GetParam() + ".json"));
  const ReadResult result = read_case(doubtful);
  EXPECT_TRUE(result.scene) << to_string(result.errors);
  const std::string messages = to_string(result.warnings);
  for (const std::string part : doubtful["expect"])
    EXPECT_NE(messages.find(part), std::string::npos) << part << "\n" << messages;
  for (const core::Diagnostic &warning : result.warnings) {
    EXPECT_FALSE(warning.key.empty());
    EXPECT_FALSE(warning.remedy.empty()) << core::to_string(warning);
    EXPECT_NE(core::to_string(warning).find(": warning: "), std::string::npos);
  }
}

INSTANTIATE_TEST_SUITE_P(Corpus, DoubtfulScene, testing::ValuesIn(case_names("doubtful_scenes")),
                         [](const auto &info) { return info.param; });

// The scenes that the others are made from, as they are and resolved.
TEST(DoubtfulScenes, SoundOnesAreNotDoubted)
{
  for (const std::string base : {"plate.json", "bar.json", "periodic.json"}) {
    const ReadResult result = parse_scene(contents(support + "scenes/" + base), base);
    for (const core::Diagnostic &warning : result.warnings)
      EXPECT_NE(warning.message.find("against the rows"), std::string::npos)
          << base << " has a crack off the rows, and no more: " << core::to_string(warning);
    for (const core::Diagnostic &warning : parse_scene(result.resolved.dump(), "echo").warnings)
      EXPECT_NE(warning.message.find("against the rows"), std::string::npos)
          << base << ", resolved: " << core::to_string(warning);
  }
  for (const auto &entry : std::filesystem::directory_iterator(LIGAMENT_SOURCE_DIR "/examples")) {
    const std::string scene = entry.path().string() + "/scene.json";
    if (!std::filesystem::exists(scene))
      continue;
    const ReadResult result = read_scene(scene);
    for (const core::Diagnostic &warning : result.warnings)
      EXPECT_EQ(warning.message.find("unusual"), std::string::npos) << core::to_string(warning);
    const std::string known = to_string(result.warnings);
    for (const core::Diagnostic &warning : parse_scene(result.resolved.dump(), "echo").warnings)
      EXPECT_NE(known.find(warning.message), std::string::npos)
          << scene << ", resolved: " << core::to_string(warning);
  }
}

TEST(WrongScenes, ThereAreMany)
{
  EXPECT_GE(case_names().size(), 150u);
}

// Whatever is damaged, reading ends with errors or with a scene whose echo is a scene again.
TEST(WrongScenes, RandomDamageDoesNoHarm)
{
  std::mt19937 random(1);
  const auto below = [&](std::size_t n) { return random() % n; };
  for (const std::string base : {"plate.json", "bar.json", "periodic.json"}) {
    const std::string text = contents(support + "scenes/" + base);
    for (int k = 0; k < 1000; ++k) {
      std::string damaged = text;
      for (std::size_t edit = 0; edit <= below(3); ++edit) {
        const std::size_t at = below(damaged.size()), n = 1 + below(12), from = below(text.size());
        switch (below(3)) {
        case 0:
          damaged.erase(at, n);
          break;
        case 1:
          damaged.insert(at, text.substr(from, n));
          break;
        default:
          damaged[at] = char(below(256));
        }
      }
      const ReadResult result = parse_scene(damaged, "scene.json");
      ASSERT_EQ(result.scene.has_value(), result.errors.empty()) << damaged;
      if (!result.scene)
        continue;
      const ReadResult again = parse_scene(result.resolved.dump(), "echo");
      ASSERT_TRUE(again.scene) << damaged << core::to_string(again.errors.at(0));
      ASSERT_EQ(again.resolved.dump(), result.resolved.dump());
    }
  }
}
