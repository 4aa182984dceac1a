// From a study to its cases: order, names, resolved scenes, and what their ids depend on.
#include "src/sweep/cases.h"

#include "core/files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

using namespace ligament;
using namespace ligament::program;

namespace
{
const std::string plate = LIGAMENT_SOURCE_DIR "/tests/support/scenes/plate.json";

CaseList cases_of(const std::string &text)
{
  core::write_file("study.json", text);
  const StudyResult read = read_study("study.json");
  for (const auto &error : read.errors)
    ADD_FAILURE() << to_string(error);
  return read.study ? make_cases(*read.study, read.json) : CaseList();
}

std::string study(const std::string &keys)
{
  return "{\"scene\": \"" + plate + "\"" + (keys.empty() ? "" : ", " + keys) + "}";
}

std::vector<std::string> names(const CaseList &list)
{
  std::vector<std::string> result;
  for (const Case &c : list.cases)
    result.push_back(c.name);
  return result;
}

TEST(Cases, GridsMultiplyAndRowsFollow)
{
  const CaseList list = cases_of(study(R"("set": {"/time/step_fraction": 0.5},
    "grids": [{"vary": {"/coupling/overlap_cells": [2, 3], "/far_field/cell_size": ["2 mm", 1.5e-3]}},
              {"name": "damper", "set": {"/coupling/gap_filter": 1}, "vary": {"/coupling/fine_damper": [0]}}],
    "rows": [{"name": "as it is"}, {"name": "pure DEM", "rival": true, "set": {"/far_field": "none"}}])"));
  EXPECT_TRUE(list.errors.empty());
  EXPECT_EQ(names(list), (std::vector<std::string>{
                             "overlap_cells=2, cell_size=2 mm", "overlap_cells=2, cell_size=1.5e-3",
                             "overlap_cells=3, cell_size=2 mm", "overlap_cells=3, cell_size=1.5e-3",
                             "damper: fine_damper=0", "as it is", "pure DEM"}));
  const auto value = [&](std::size_t k, const char *key) {
    return list.cases.at(k).scene.at(nlohmann::ordered_json::json_pointer(key));
  };
  EXPECT_EQ(value(1, "/coupling/overlap_cells"), 2);
  EXPECT_EQ(value(1, "/far_field/cell_size"), 1.5e-3);
  EXPECT_EQ(value(2, "/far_field/cell_size"), 2e-3);
  EXPECT_EQ(value(4, "/coupling/gap_filter"), 1);
  EXPECT_EQ(value(6, "/far_field"), "none");
  for (std::size_t k = 0; k < list.cases.size(); ++k)
    EXPECT_EQ(value(k, "/time/step_fraction"), 0.5);
  EXPECT_TRUE(list.cases[6].rival);
  EXPECT_EQ(list.cases[0].group, "overlap_cells, cell_size");
  EXPECT_EQ(list.cases[5].group, "");
  EXPECT_EQ(list.keys, (std::vector<std::string>{"/coupling/overlap_cells", "/far_field/cell_size",
                                                 "/coupling/fine_damper", "/coupling/gap_filter",
                                                 "/far_field"}));
}

// Two components of vectors: their numbers alone would be the same name twice.
TEST(Cases, ComponentsOfVectorsAreNamedWithTheVector)
{
  const CaseList list = cases_of(study(
      R"("grids": [{"vary": {"/loads/0/velocity/1": [0.1, 0.2], "/specimen/size/1": [0.2]}}])"));
  EXPECT_EQ(names(list),
            (std::vector<std::string>{"velocity/1=0.1, size/1=0.2", "velocity/1=0.2, size/1=0.2"}));
  EXPECT_EQ(list.cases.at(0).group, "velocity/1, size/1");
}

TEST(Cases, IdsNameTheSceneAndNothingElse)
{
  // Unit, order and title do not change what is computed; each value does.
  const CaseList list = cases_of(study(R"("rows": [{"name": "a"},
    {"name": "b", "set": {"/far_field/cell_size": "2 mm", "/title": "other"}},
    {"name": "c", "set": {"/far_field/cell_size": 2e-3, "/output/progress_interval": 9}},
    {"name": "d", "set": {"/far_field/cell_size": "1.9 mm"}},
    {"name": "e", "set": {"/coupling/gap_filter": 3.9999999999}},
    {"name": "f", "set": {"/output/history_interval": "2 us"}}])"));
  std::set<std::string> ids;
  for (const Case &c : list.cases) {
    ids.insert(c.id);
    EXPECT_EQ(c.id.size(), 16u);
  }
  EXPECT_EQ(list.cases[0].id, list.cases[1].id);
  EXPECT_EQ(list.cases[0].id, list.cases[2].id);
  EXPECT_EQ(ids.size(), 4u);
  // The published value of FNV-1a for the text "a": ids are the same on all machines.
  EXPECT_EQ(text_id("a"), "af63dc4c8601ec8c");
}

TEST(Cases, ValuesThatDoNotGoTogetherAreRefused)
{
  // Two overlaps of 20 cells of 2 mm are wider than the zone of 60 mm; the other case stays.
  const CaseList list =
      cases_of(study(R"("grids": [{"vary": {"/coupling/overlap_cells": [20, 3]}}])"));
  EXPECT_TRUE(list.errors.empty());
  ASSERT_EQ(list.cases.size(), 2u);
  EXPECT_FALSE(list.cases[0].refused.empty());
  EXPECT_TRUE(list.cases[0].scene.is_null());
  EXPECT_TRUE(list.cases[1].refused.empty());
}

// Warnings of all scenes that are computed, one that many have once; what they are about is the
// case.
TEST(Cases, WarningsAreKeptOnce)
{
  const CaseList list = cases_of(study(
      R"("set": {"/loads/0/ramp": "2 ms"},
         "grids": [{"vary": {"/coupling/gap_filter": [1, 2], "/coupling/scheme": ["fine_scale_split", "none"]}}])"));
  const auto count = [&](const std::string &part) {
    return std::count_if(list.warnings.begin(), list.warnings.end(),
                         [&](const auto &w) { return w.message.find(part) != std::string::npos; });
  };
  EXPECT_EQ(count("\"ramp\" in /loads/0 is 0.002 s, longer than the duration"), 1);
  EXPECT_EQ(count("\"gap_filter\" in /coupling is not used"), 1);
}

TEST(Cases, ReferencesMustBeScenes)
{
  const CaseList list = cases_of(study(
      R"("rows": [{"name": "r", "set": {"/coupling/overlap_cells": 20}}, {"name": "ok"}], "reference": "r")"));
  EXPECT_FALSE(list.errors.empty());
}
} // namespace
