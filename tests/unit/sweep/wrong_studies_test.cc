// Every wrong study of tests/support/wrong_studies must be refused, with place and remedy.
//
// A file is a study whose first line says what is expected:
// // {"expect": parts of the messages, "place": "line:column" of one of them, "errors": how many}
#include "core/files.h"
#include "src/sweep/cases.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>

using namespace ligament;
using namespace ligament::program;

namespace
{
const std::string corpus = LIGAMENT_SOURCE_DIR "/tests/support/wrong_studies/";

std::vector<std::string> study_names()
{
  std::vector<std::string> names;
  for (const auto &entry : std::filesystem::directory_iterator(corpus))
    names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

class WrongStudy : public testing::TestWithParam<std::string>
{
};
} // namespace

TEST_P(WrongStudy, IsRefused)
{
  const std::string file = corpus + GetParam() + ".json";
  const std::string text = core::read_file(file);
  const auto wrong = nlohmann::json::parse(text.substr(2, text.find('\n') - 2));
  StudyResult read = read_study(file);
  std::vector<core::Diagnostic> errors = read.errors;
  if (read.study)
    errors = make_cases(*read.study, read.json).errors;

  std::string messages;
  bool at_place = false;
  for (const core::Diagnostic &error : errors) {
    messages += to_string(error) + "\n";
    at_place = at_place || to_string(error.place) == file + ":" + wrong.value("place", "");
    EXPECT_FALSE(error.remedy.empty()) << to_string(error);
  }
  EXPECT_EQ(int(errors.size()), wrong.value("errors", 1)) << messages;
  EXPECT_TRUE(at_place || !wrong.contains("place")) << messages; // else it is in the scene
  for (const std::string part : wrong.at("expect"))
    EXPECT_NE(messages.find(part), std::string::npos) << part << "\n" << messages;
}

INSTANTIATE_TEST_SUITE_P(Corpus, WrongStudy, testing::ValuesIn(study_names()),
                         [](const auto &info) { return info.param; });

TEST(WrongStudies, ThereAreMany)
{
  EXPECT_GE(study_names().size(), 15u);
}

TEST(WrongStudies, AFileThatIsNotThere)
{
  const StudyResult read = read_study("no_such_study.json");
  ASSERT_EQ(read.errors.size(), 1u);
  EXPECT_FALSE(read.study);
}
