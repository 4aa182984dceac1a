// run.json: everything comes back, unknown figures are null, damage is refused.
#include "src/output/run_record.h"

#include "core/check.h"
#include "core/files.h"
#include "src/output/run_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <limits>

using namespace ligament;
using namespace ligament::program;

namespace
{
TEST(RunRecord, ComesBackWhole)
{
  RunRecord r;
  r.title = "Plate \"A\" \xe2\x88\x86";
  r.status = "stopped";
  r.reason = "overlap strain";
  r.kind = "coupled";
  r.dimension = 3;
  r.spacing = 1. / 3;
  r.size = {0.1, 0.2, 0.3};
  r.particles = 123456789012;
  r.dt_critical = 5e-9;
  r.step_ratio = 4;
  r.ranks = 3;
  r.steps = 40000;
  r.timing = {{"forces", 1.5, 40000}, {"rest", 0.1, 0}};
  r.skipped = {{"contact search", "nothing is broken"}};
  r.peak_load = -1e5;
  r.figures = {{"strength", {2.5e7, "Pa"}}, {"c", {0.82, ""}}};
  r.magnification = 500;
  r.states = {
      {"peak", "near the peak load", 1e-3, "fields/particles_peak.vtp", ""},
      {"end",
       "at the end",
       2e-3,
       "",
       "",
       {{{0, 0, 0, 1, 0, 0}, {0, -0.25, 0}}, {{}, {}, {0, -1, 0, 2, 1, 0, 0, 0, 0, 0, 1, 0}}}}};
  r.pictures = {{"pictures/peak.png", "at the peak"}};
  r.trusted_until = 2e-4;
  r.broken_in_overlap = 7;
  r.warnings = {{"a face broke", 1e-3}, {"a key is not used"}};
  r.phases = {{"static", 0, 12.5, 0, 120000000, 3, 84, -1.5e5, 1, "a bond is to break", 2.25},
              {"dynamic", 12.5, 12.6, 40000, 0, 0, 0, -1e5, 77, "calm", 9}};
  write_run_record("run.json", r);
  const RunRecord back = read_run_record("run.json");
  EXPECT_EQ(back.title, r.title);
  EXPECT_EQ(back.status, r.status);
  EXPECT_EQ(back.spacing, r.spacing);
  EXPECT_EQ(back.size, r.size);
  EXPECT_EQ(back.particles, r.particles);
  EXPECT_EQ(back.dt_critical, r.dt_critical);
  EXPECT_EQ(back.ranks, 3);
  EXPECT_EQ(back.dt_far, std::nullopt);
  EXPECT_EQ(back.peak_load, r.peak_load);
  ASSERT_EQ(back.timing.size(), 2u);
  EXPECT_EQ(back.timing[0].name, "forces");
  EXPECT_EQ(back.timing[0].seconds, 1.5);
  EXPECT_EQ(back.timing[0].calls, 40000);
  ASSERT_EQ(back.states.size(), 2u);
  EXPECT_TRUE(back.states[0].tools.empty());
  ASSERT_EQ(back.states[1].tools.size(), 2u);
  EXPECT_EQ(back.states[1].tools[0].points, r.states[1].tools[0].points);
  EXPECT_EQ(back.states[1].tools[0].displacement, r.states[1].tools[0].displacement);
  EXPECT_TRUE(back.states[1].tools[0].turn.empty());
  EXPECT_EQ(back.states[1].tools[1].turn, r.states[1].tools[1].turn);
  EXPECT_EQ(back.skipped.at(0).why, "nothing is broken");
  EXPECT_EQ(back.figures.at("strength").value, 2.5e7);
  EXPECT_EQ(back.figures.at("strength").unit, "Pa");
  EXPECT_EQ(back.pictures.at(0).file, "pictures/peak.png");
  EXPECT_EQ(back.magnification, 500);
  EXPECT_EQ(back.states.at(0).time, 1e-3);
  EXPECT_EQ(back.states[0].particles, "fields/particles_peak.vtp");
  EXPECT_EQ(back.states[0].cells, "");

  ASSERT_EQ(back.phases.size(), 2u);
  EXPECT_EQ(back.phases[0].kind, "static");
  EXPECT_EQ(back.phases[0].end, 12.5);
  EXPECT_EQ(back.phases[0].steps_skipped, 120000000);
  EXPECT_EQ(back.phases[0].solves, 3);
  EXPECT_EQ(back.phases[0].iterations, 84);
  EXPECT_EQ(back.phases[0].load, -1.5e5);
  EXPECT_EQ(back.phases[0].seconds, 2.25);
  EXPECT_EQ(back.phases[1].begin, 12.5);
  EXPECT_EQ(back.phases[1].steps, 40000);
  EXPECT_EQ(back.phases[1].broken, 77);
  EXPECT_EQ(back.phases[1].reason, "calm");

  EXPECT_EQ(back.trusted_until, r.trusted_until);
  EXPECT_EQ(back.broken_in_overlap, 7);
  ASSERT_EQ(back.warnings.size(), 2u);
  EXPECT_EQ(back.warnings[0].text, "a face broke");
  EXPECT_EQ(back.warnings[0].energy, 1e-3);
  EXPECT_FALSE(back.warnings[1].energy);

  // Writing what was read gives the same bytes: no field is lost on either way.
  write_run_record("again.json", back);
  EXPECT_EQ(core::read_file("again.json"), core::read_file("run.json"));
  const auto json = nlohmann::json::parse(core::read_file("run.json"));
  EXPECT_TRUE(json.at("stiffness").is_null());
  EXPECT_EQ(json.at("complete"), false);
}

// Of a run whose numbers were none any more: null in the file.
TEST(RunRecord, ComesBackWithWhatIsNoNumber)
{
  const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  RunRecord r;
  r.size = {0.1, nan};
  r.crack_length = nan;
  r.thickness = infinite;
  r.figures = {{"strength", {nan, "Pa"}}};
  r.states = {{"end", "at the end", nan, "", "", {{{0, 0, nan}, {0, -infinite, 2}}}}};
  r.phases = {{"static", 0, nan, 0, 0, 0, 0, nan, 0, "", 0}};
  r.warnings = {{"a face broke", nan}};
  write_run_record("no_numbers.json", r);
  const RunRecord back = read_run_record("no_numbers.json");
  EXPECT_EQ(back.size[0], 0.1);
  EXPECT_TRUE(std::isnan(back.size[1]));
  EXPECT_FALSE(back.crack_length);
  EXPECT_TRUE(std::isnan(back.thickness));
  EXPECT_TRUE(std::isnan(back.figures.at("strength").value));
  const ToolOutline &tool = back.states.at(0).tools.at(0);
  EXPECT_TRUE(std::isnan(tool.points[2]));
  EXPECT_TRUE(std::isnan(tool.displacement[1]));
  EXPECT_EQ(tool.displacement[2], 2);
  EXPECT_TRUE(std::isnan(back.phases.at(0).load));
  write_run_record("no_numbers_again.json", back);
  EXPECT_EQ(core::read_file("no_numbers_again.json"), core::read_file("no_numbers.json"));
}

// Records of runs by steps alone, and those of before, know no phases.
TEST(RunRecord, NamesNoPhasesWhereThereAreNone)
{
  write_run_record("steps.json", {});
  EXPECT_FALSE(nlohmann::json::parse(core::read_file("steps.json")).contains("phases"));
  EXPECT_TRUE(read_run_record("steps.json").phases.empty());
}

TEST(RunRecord, RefusesDamage)
{
  EXPECT_THROW(read_run_record("no_such.json"), core::InputError);
  core::write_file("cut.json", "{\"title\": \"x\"");
  EXPECT_THROW(read_run_record("cut.json"), core::InputError);
  core::write_file("poor.json", "{\"title\": \"x\"}");
  EXPECT_THROW(read_run_record("poor.json"), core::InputError);
  EXPECT_THROW(write_run_record("/dev/full", {}), core::EnvironmentError);
}

TEST(RunFolder, IsMadeAndRecognised)
{
  std::filesystem::remove_all("some");
  const RunFolder folder{"some/new/folder"};
  folder.create();
  folder.create();
  EXPECT_FALSE(folder.holds_a_run());
  write_run_record(folder.record(), {});
  EXPECT_TRUE(folder.holds_a_run());
  EXPECT_EQ(folder.foreign_entry(), "");
  std::filesystem::remove_all("not_of_a_run");
  std::filesystem::create_directories("not_of_a_run");
  core::write_file("not_of_a_run/check_packing.csv", ""); // of `check --draw`
  EXPECT_EQ(RunFolder{"not_of_a_run"}.foreign_entry(), "");
  core::write_file("not_of_a_run/packing.csv", "somebody's own");
  EXPECT_EQ(RunFolder{"not_of_a_run"}.foreign_entry(), "packing.csv");
  core::write_file("a_file", "");
  EXPECT_THROW(RunFolder{"a_file/folder"}.create(), core::EnvironmentError);
}
} // namespace
