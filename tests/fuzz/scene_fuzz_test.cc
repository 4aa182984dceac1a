// Scenes that are right, nearly right and wrong: reading them ends, and says all that it must.
#include "core/json.h"
#include "src/scene/read_scene.h"
#include "src/scene/scene_parameters.h"
#include "tests/fuzz/fuzz_cases.h"
#include "tests/fuzz/scene_grammar.h"
#include "tests/fuzz/text_faults.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace
{
using namespace ligament;
using namespace ligament::fuzz;
using program::ReadResult;

const std::string origin = "scene.json";

/// The table of scene files, with variables of its own.
struct SceneTable
{
  program::Scene scene;
  core::ParameterSection root;
  explicit SceneTable(bool may_be_atoms = true)
  {
    program::declare_scene(root, scene, may_be_atoms);
  }
};

std::string all_of(const std::vector<core::Diagnostic> &diagnostics)
{
  std::string text;
  for (const core::Diagnostic &d : diagnostics)
    text += core::to_string(d) + "\n";
  return text;
}

void expect_complete(const core::Diagnostic &d)
{
  EXPECT_EQ(d.place.origin, origin);
  EXPECT_GE(d.place.line, 1);
  EXPECT_GE(d.place.column, 1);
  EXPECT_FALSE(d.message.empty());
  // What a potential says of its own numbers is finding and reason in one.
  const bool of_potential = d.key.compare(0, 6, "/atoms") == 0;
  EXPECT_FALSE(d.reason.empty() && !of_potential) << d.message;
  EXPECT_FALSE(d.remedy.empty()) << d.message;
  const std::string shown = core::to_string(d);
  EXPECT_EQ(std::count(shown.begin(), shown.end(), '\n'), d.reason.empty() ? 1 : 2) << shown;
  EXPECT_EQ(shown.find_first_of("\r\x1b"), shown.npos) << shown;
}

/// Reads the text and asserts what holds for any text at all.
ReadResult read_any(const std::string &text)
{
  note_document(text);
  ReadResult result = program::parse_scene(text, origin);
  EXPECT_EQ(result.scene.has_value(), result.errors.empty()) << all_of(result.errors);
  for (const auto &list : {result.errors, result.warnings})
    for (const core::Diagnostic &d : list)
      expect_complete(d);
  if (!result.scene)
    return result;
  const ReadResult again = program::parse_scene(result.resolved.dump(), origin);
  EXPECT_TRUE(again.scene) << all_of(again.errors);
  EXPECT_EQ(again.resolved.dump(), result.resolved.dump());
  return result;
}

core::JsonValue parsed(const std::string &text)
{
  std::vector<core::Diagnostic> errors;
  core::JsonValue value = core::parse_json(text, origin, errors);
  EXPECT_TRUE(errors.empty()) << all_of(errors);
  return value;
}

/// Reading warm atoms may measure their lattice parameter, which takes seconds: they are cold here.
std::string cheap_text(core::JsonValue document)
{
  core::JsonMember *atoms = document.find("atoms");
  if (core::JsonMember *temperature = atoms ? atoms->value.find("temperature") : nullptr)
    temperature->value = parsed("0");
  return core::to_text(document);
}

/// Scenes of the tests and examples, which are sound.
const std::vector<core::JsonValue> &sound_scenes()
{
  static const std::vector<core::JsonValue> scenes = [] {
    std::vector<std::string> files;
    const std::string root = LIGAMENT_SOURCE_DIR;
    for (const std::string folder : {"/tests/support/scenes", "/examples", "/src/launcher/new"})
      for (const auto &entry : std::filesystem::recursive_directory_iterator(root + folder))
        if (entry.path().extension() == ".json")
          files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    std::vector<core::JsonValue> sound;
    for (const std::string &file : files) {
      std::ostringstream text;
      text << std::ifstream(file).rdbuf();
      const ReadResult result = program::parse_scene(cheap_text(parsed(text.str())), origin);
      if (result.scene) // some need files beside them
        sound.push_back(result.json);
    }
    return sound;
  }();
  return scenes;
}

int dimension_of(const core::JsonValue &scene)
{
  const core::JsonMember *member = scene.find("dimension");
  return member ? int(member->value.number) : 2;
}

/// Nothing but what the table allows: the keys are right, whatever the checks say of their sense.
void grammar_case(Draw &draw)
{
  const bool may_be_atoms = draw.once_in(2);
  const SceneTable table(may_be_atoms);
  const int dimension = draw.between(2, 3);
  core::JsonValue document = draw_document(draw, table.root, dimension);
  const core::JsonMember *atoms = document.find("atoms");
  if (may_be_atoms != (atoms && atoms->value.text != "none"))
    return; // which keys the material needs depends on it
  if (core::JsonMember *member = document.find("dimension"))
    member->value.text = std::to_string(dimension);
  else
    add_member(document, "dimension", parsed(std::to_string(dimension)));
  const ReadResult result = read_any(cheap_text(document));
  EXPECT_TRUE(result.keys_are_right) << all_of(result.errors);
}

/// A sound scene, some of whose keys have other values; says whether it is still accepted.
bool changed_case(Draw &draw)
{
  const SceneTable table;
  core::JsonValue document = draw.of(sound_scenes());
  const int dimension = dimension_of(document);
  for (int n = draw.between(1, 3); n > 0; --n)
    change_key(draw, table.root, dimension, document);
  return read_any(cheap_text(document)).scene.has_value();
}

/// Either of them with faults in its values, its keys or its bytes.
void spoilt_case(Draw &draw)
{
  const SceneTable table;
  core::JsonValue document = draw.once_in(2) ? core::JsonValue(draw.of(sound_scenes()))
                                             : draw_document(draw, table.root, draw.between(2, 3));
  for (int n = draw.between(0, 3); n > 0; --n)
    spoil(draw, document);
  std::string text = cheap_text(document);
  for (int n = draw.once_in(2) ? draw.between(1, 3) : 0; n > 0; --n)
    text = with_wrong_bytes(draw, text);
  read_any(text);
}
} // namespace

TEST(SceneFuzz, WhatTheTableAllowsHasRightKeys)
{
  run_cases(1, 2000, grammar_case);
}

TEST(SceneFuzz, ChangedScenesReadBackFromTheirEcho)
{
  int accepted = 0;
  run_cases(2, 2000, [&](Draw &draw) { accepted += changed_case(draw); });
  EXPECT_TRUE(accepted >= 200 || std::getenv("LIGAMENT_FUZZ_SEED"))
      << accepted << " scenes are accepted: too few for a test of echoes";
}

TEST(SceneFuzz, FaultsAreToldWithPlaceReasonAndRemedy)
{
  run_cases(3, 5000, spoilt_case);
}

TEST(SceneFuzz, SlowManyScenes)
{
  run_cases_for(1800, [](Draw &draw) {
    switch (draw.below(3)) {
    case 0:
      return grammar_case(draw);
    case 1:
      changed_case(draw);
      return;
    default:
      return spoilt_case(draw);
    }
  });
}
