// Compare: known figures from runs that differ in known ways.
#include "src/analysis/compare.h"

#include "core/check.h"
#include "src/analysis/crack_path.h"
#include "tests/unit/output/synthetic_run.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace ligament;
using namespace ligament::program;
using ligament::tests::SyntheticRun;

namespace
{
// A few operations on doubles.
constexpr double rounding = 1e-12;

TEST(Compare, FindsTheFactorsBetweenTwoRuns)
{
  SyntheticRun run, reference;
  run.peak_stress = 1.03 * reference.peak_stress;
  run.stiffness = 0.98 * reference.stiffness;
  run.wall_seconds = reference.wall_seconds / 8;
  run.particles = reference.particles / 10;
  run.crack_y = 1.5 * run.spacing;
  run.displacement_factor = 1.25;
  run.first_id = 77; // numbers differ between a zone and the whole specimen
  run.write("a");
  reference.write("b");
  const CompareResult r = compare("a", "b/");

  EXPECT_NEAR(*r.peak_load_error, 0.03, rounding);
  EXPECT_NEAR(*r.stiffness_error, -0.02, rounding);
  EXPECT_NEAR(*r.energy_error, run.work() / reference.work() - 1, rounding);
  EXPECT_NEAR(*r.time_ratio, 8, rounding);
  EXPECT_NEAR(*r.particle_ratio, 10, rounding);
  // The same faces, shifted by 1.5 d: every distance is 1.5, in both directions.
  for (const auto &distance : {r.crack_distance_mean, r.crack_distance_max,
                               r.crack_distance_mean_to_onset, r.crack_distance_max_to_onset,
                               r.crack_distance_mean_after_onset, r.crack_distance_max_after_onset})
    EXPECT_NEAR(distance.value(), 1.5, rounding);
  EXPECT_EQ(r.matched_particles, 10);
  EXPECT_NEAR(*r.displacement_error, 0.25, rounding);
  EXPECT_NEAR(*r.displacement_error_max, 0.25, rounding);
  EXPECT_NEAR(*r.velocity_error, 0, rounding);
  EXPECT_TRUE(r.notes.empty()) << table(r);
  EXPECT_NE(r.plot.find("<svg"), std::string::npos);
  EXPECT_EQ(r.file_name, "compare_b");
}

// A run by equilibria beside one by steps: how many each of them did.
TEST(Compare, CountsTheStepsOfPhases)
{
  SyntheticRun().write("stepped");
  const RunFolder folder = SyntheticRun().write("by_equilibria");
  EXPECT_EQ(table(compare("by_equilibria", "stepped")).find("skipped"), std::string::npos);
  RunRecord record = read_run_record(folder.record());
  record.phases = {{"static", 0, 1, 0, 64000, 3, 84, 0, 1, "a bond breaks", 1},
                   {"dynamic", 1, 2, 2000, 0, 0, 0, 0, 77, "end", 1}};
  write_run_record(folder.record(), record);
  const RunFolder stepped{"stepped"};
  record = read_run_record(stepped.record());
  record.steps = 66000;
  write_run_record(stepped.record(), record);
  const CompareResult r = compare("by_equilibria", "stepped");
  const auto line =
      std::find_if(r.lines.begin(), r.lines.end(), [](const auto &l) { return l.name == "steps"; });
  ASSERT_NE(line, r.lines.end());
  EXPECT_EQ(line->run, "2 000");
  EXPECT_EQ(line->reference, "66 000");
  EXPECT_EQ(line->difference, "33.00 x");
  EXPECT_NE(table(r).find("skipped by static phases"), std::string::npos);
}

// The run breaks first, and its last state is too near to its onset.
TEST(Compare, FieldsAreThoseOfTheSameTimeBeforeTheOnset)
{
  SyntheticRun run, reference;
  run.displacement_factor = 1.25;
  run.peak_time = 1e-3;
  reference.peak_time = 1.02e-3;
  const double onset = run.onset * run.peak_time;
  run.snapshot_times = {0.995 * onset, 0.975 * onset, 0.955 * onset};
  reference.snapshot_times = {1.015 * onset, 0.995 * onset, 0.975 * onset};
  run.write("first");
  reference.write("second");
  const CompareResult same = compare("first", "second");
  EXPECT_NEAR(same.displacement_error.value(), 0.25, rounding);
  EXPECT_NE(table(same).find("926 µs"), std::string::npos) << table(same);

  // 5 per mille apart: no error is better than a wrong one.
  run.snapshot_times = {0.97 * onset};
  run.write("other");
  const CompareResult other = compare("other", "second");
  EXPECT_FALSE(other.displacement_error);
  EXPECT_FALSE(other.notes.empty());
}

// The run's crack is longer by n faces: only its own direction sees 1, 2, ... n diameters.
TEST(Compare, LongerCrackCountsInOneDirection)
{
  SyntheticRun run, reference;
  run.n_broken_after = 5;
  reference.n_broken_after = 2;
  run.write("longer");
  reference.write("shorter");
  const CompareResult r = compare("longer", "shorter");
  const int n_run = run.n_broken_before + run.n_broken_after;
  EXPECT_NEAR(*r.crack_distance_max, 3, rounding);
  EXPECT_NEAR(*r.crack_distance_mean, 0.5 * (1. + 2. + 3.) / n_run, rounding);
  EXPECT_NEAR(*r.crack_distance_max_to_onset, 0, rounding);
  EXPECT_NEAR(*r.crack_distance_mean_after_onset, 0.5 * (1. + 2. + 3.) / run.n_broken_after,
              rounding);
}

TEST(Compare, WhatCannotBeComputedIsNull)
{
  SyntheticRun run, intact;
  intact.n_broken_before = intact.n_broken_after = 0;
  intact.snapshot_times = {};
  run.write("broken");
  intact.write("intact");
  const auto json = to_json(compare("broken", "intact"));
  for (const char *name :
       {"crack_distance_mean", "crack_distance_max", "displacement_error", "velocity_error"})
    EXPECT_TRUE(json.at(name).is_null()) << name;
  EXPECT_TRUE(json.at("peak_load_error").is_null()) << "nothing broke in one of them";
  EXPECT_TRUE(json.at("largest_load_error").is_number());
  EXPECT_FALSE(json.at("notes").empty());
}

// Waves, or loads that nothing has broken under: fields at one time, histories, no peak.
TEST(Compare, RunsInWhichNothingBroke)
{
  SyntheticRun run, reference;
  for (SyntheticRun *r : {&run, &reference})
    r->n_broken_before = r->n_broken_after = 0;
  run.displacement_factor = 1.25;
  run.peak_stress = 1.1 * reference.peak_stress;
  run.peak_time = 1.1 * reference.peak_time; // the same load at the same time, for longer
  run.noise = 0.02;
  run.write("wave");
  reference.write("twin");
  const CompareResult r = compare("wave", "twin");
  EXPECT_FALSE(r.peak_load_error);
  EXPECT_NEAR(*r.largest_load_error, 0.1, rounding);
  EXPECT_EQ(table(r).find("peak load"), std::string::npos) << table(r);
  EXPECT_NEAR(*r.displacement_error, 0.25, rounding);
  EXPECT_NEAR(*r.kinetic_share, 2e-3, rounding);
  // The load of the reference falls after its last row of loading, at 1.01 of its peak's time, when
  // that of the run is at 1.01/1.1 of its own: up to there the runs differ.
  EXPECT_NEAR(*r.compared_until, 1.1 * reference.peak_time, rounding);
  EXPECT_NEAR(*r.load_history.largest, 1.1, 0.01);
  // The work of 1.1 times the time at the same rate is that times squared; it rests at the end.
  EXPECT_NEAR(*r.energy_error, 1.1 * 1.1 - 1, rounding);
}

TEST(Compare, HistoriesAreComparedAtEqualTimes)
{
  SyntheticRun run, reference;
  for (SyntheticRun *r : {&run, &reference})
    r->n_broken_before = r->n_broken_after = 0;
  run.noise = 0.02;
  run.trusted_until = 1e-4 + 1e-12; // just before the fall
  run.write("noisy");
  reference.write("plain");
  const CompareResult r = compare("noisy", "plain");
  // sin against a ramp over a whole number of periods: sqrt((1/2)/(1/3)); trapezoids of 100 rows.
  EXPECT_NEAR(*r.load_history.mean / (0.02 * std::sqrt(1.5)), 1, 1e-3);
  EXPECT_NEAR(*r.load_history.largest, 0.02, 1e-4);
  EXPECT_NEAR(*r.displacement_history.mean, 0, rounding);
  EXPECT_NEAR(*r.elastic_history.mean, 0, rounding);
}

TEST(Compare, RunsThatAreNotCompleteAreNamed)
{
  SyntheticRun run, reference;
  reference.write("whole");
  run.write("also_whole");
  EXPECT_TRUE(compare("also_whole", "whole").complete);
  for (const auto &[status, words] :
       std::vector<std::pair<std::string, std::string>>{{"stopped", "was stopped by its guard"},
                                                        {"interrupted", "was interrupted"},
                                                        {"failed", "failed"},
                                                        {"running", "is not finished"}})
  {
    run.status = status;
    run.write("part");
    for (const auto &r : {compare("part", "whole"), compare("whole", "part")}) {
      EXPECT_FALSE(r.complete);
      EXPECT_EQ(to_json(r).at("complete"), false);
      EXPECT_NE(table(r).find(words + ": why it ended"), std::string::npos) << table(r);
    }
  }
}

// Three faces break before the run leaves its range, four later ones are not compared.
TEST(Compare, WhatIsNotTrustedDoesNotCount)
{
  SyntheticRun run, reference;
  reference.crack_y = 2 * reference.spacing;
  reference.n_broken_after = 0;
  run.trusted_until = run.onset * run.peak_time;
  run.write("left");
  reference.write("stayed");
  const CompareResult r = compare("left", "stayed");
  EXPECT_NEAR(*r.crack_distance_max, 2, rounding); // 4 along x with the later ones
  EXPECT_LE(*r.compared_until, *run.trusted_until);
}

TEST(Compare, CurveWithUnitsAsReference)
{
  SyntheticRun run;
  run.write("run");
  // 1.25 times the peak at the same stiffness, in other units and without anything else.
  std::string text = "displacement;load\nmm;kN\n";
  for (int i = 0; i <= 50; ++i)
    text += std::to_string(1e3 * 1.25 * i / 50. * run.peak_strain() * run.length) + ";" +
            std::to_string(1e-3 * 1.25 * i / 50. * run.peak_load()) + "\n";
  core::write_file("paper.csv", text);
  const CompareResult r = compare("run", "paper.csv");
  // std::to_string keeps 6 decimals of about 3e-3 mm and 100 kN.
  const double cut = 0.5e-6 / (1e3 * 1.25 / 50 * run.peak_strain() * run.length);
  EXPECT_NEAR(*r.peak_load_error, 1 / 1.25 - 1, cut);
  EXPECT_NEAR(*r.stiffness_error, 0, cut);
  EXPECT_NEAR(*r.energy_error, 1 / (1.25 * 1.25) - 1, 2 * cut);
  EXPECT_FALSE(r.time_ratio);
  EXPECT_FALSE(r.particle_ratio);
  EXPECT_FALSE(r.crack_distance_max);
  EXPECT_EQ(r.file_name, "compare_paper");
}

// A laboratory that counts compression as positive measures the same; nothing is turned unasked.
TEST(Compare, LoadsOfOppositeSignAreNamed)
{
  SyntheticRun run;
  run.write("run");
  for (const double sign : {1., -1.}) {
    std::string text = "displacement;load\nmm;kN\n";
    for (int i = 0; i <= 50; ++i)
      text += fmt::format("{};{}\n", sign * i / 50. * 1e3 * run.peak_strain() * run.length,
                          sign * i / 50. * 1e-3 * run.peak_load());
    core::write_file("paper.csv", text);
    const CompareResult r = compare("run", "paper.csv");
    EXPECT_NEAR(*r.peak_load_error, sign > 0 ? 0 : -2, 1e-12);
    EXPECT_EQ(std::any_of(
                  r.notes.begin(), r.notes.end(),
                  [](const std::string &note) { return note.find("opposite signs") != note.npos; }),
              sign < 0);
  }
}

// A cell that is empty, or a number that is none, is a row that nobody measured.
TEST(Compare, RowsWithGapsAreLeftOut)
{
  SyntheticRun run;
  run.write("run");
  const auto curve = [&](bool has_gaps) {
    std::string text = "displacement,load\nmm,kN\n";
    for (int i = 0; i <= 100; ++i) {
      const std::string x = std::to_string(1e3 * i / 100. * run.peak_strain() * run.length),
                        y = std::to_string(1e-3 * i / 100. * run.peak_load());
      text += (has_gaps && i % 7 == 3 ? "" : x) + "," + (has_gaps && i % 7 == 5 ? "" : y) + "\n";
    }
    return text;
  };
  core::write_file("whole.csv", curve(false));
  core::write_file("gaps.csv", curve(true));
  const CompareResult whole = compare("run", "whole.csv"), gaps = compare("run", "gaps.csv");
  EXPECT_NEAR(gaps.peak_load_error.value(), whole.peak_load_error.value(), rounding);
  EXPECT_NEAR(gaps.stiffness_error.value(), whole.stiffness_error.value(), 1e-3);
  EXPECT_NEAR(gaps.energy_error.value(), whole.energy_error.value(), 1e-3);
  core::write_file("none.csv", "displacement,load\nmm,kN\n");
  EXPECT_THROW(compare("run", "none.csv"), core::InputError);
  core::write_file("strain_alone.csv", "strain\n1\n0.1\n");
  EXPECT_THROW(compare("run", "strain_alone.csv"), core::InputError);
}

TEST(Compare, RefusesWhatIsNeither)
{
  SyntheticRun().write("good");
  EXPECT_THROW(compare("good", "nothing_there"), core::InputError);
  EXPECT_THROW(compare("nothing_there", "good"), core::InputError);
  std::filesystem::create_directories("empty_folder");
  EXPECT_THROW(compare("good", "empty_folder"), core::InputError);
}

TEST(CrackPath, NearestDistancesAgreeWithTheSlowSearch)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<BrokenBond> a(40), b(60);
  for (auto *bonds : {&a, &b})
    for (auto &bond : *bonds)
      for (double &x : bond.centroid)
        x = uniform(random);
  const auto distances = nearest_distances(a, b);
  ASSERT_EQ(distances.size(), a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    double best = HUGE_VAL;
    for (const auto &other : b)
      best = std::min(best, std::hypot(a[i].centroid[0] - other.centroid[0],
                                       a[i].centroid[1] - other.centroid[1],
                                       a[i].centroid[2] - other.centroid[2]));
    EXPECT_EQ(distances[i], best);
  }
  EXPECT_TRUE(nearest_distances(a, {}).empty());
}

TEST(Compare, NamesTheColumnsOfACurveThatItDoesNotKnow)
{
  SyntheticRun().write("a");
  core::write_file("half.csv",
                   "\xEF\xBB\xBFstrain,stress,temperature\n1,MPa,K\n0,0,1\n1e-5,0.7,1\n");
  const CompareResult r = compare("a", "half.csv");
  EXPECT_NE(table(r).find("does not know: \"temperature\""), std::string::npos) << table(r);
  EXPECT_TRUE(r.peak_load_error) << "the byte order mark belongs to no name";
  core::write_file("alien.csv", "mass,temperature\nkg,K\n0,1\n");
  try {
    compare("a", "alien.csv");
    ADD_FAILURE() << "was read";
  } catch (const core::InputError &error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("alien.csv: none of its columns"), std::string::npos) << text;
    EXPECT_NE(text.find("\"stress\""), std::string::npos) << text;
  }
}

TEST(Compare, WritesWhereItIsTold)
{
  SyntheticRun().write("a");
  SyntheticRun().write("b");
  CompareResult r = compare("a", "b");
  EXPECT_FALSE(std::filesystem::exists("a/compare_b.svg"));
  std::filesystem::remove_all("elsewhere");
  write_comparison(r, "elsewhere/deep");
  EXPECT_TRUE(std::filesystem::exists("elsewhere/deep/compare_b.svg"));
  EXPECT_EQ(r.html_file, "elsewhere/deep/compare_b.html");
}

TEST(Compare, EarlierPlotsOfOthersStay)
{
  SyntheticRun other;
  other.peak_stress *= 2;
  SyntheticRun().write("a");
  for (const char *study : {"first", "second"})
    std::filesystem::create_directories(study);
  SyntheticRun().write("first/out");
  other.write("second/out");
  std::filesystem::remove_all("plots");
  const auto page_of = [](const char *run, const char *reference) {
    CompareResult r = compare(run, reference);
    write_comparison(r, "plots");
    EXPECT_EQ(core::read_file(r.svg_file), r.plot);
    return r.html_file;
  };
  EXPECT_EQ(page_of("a", "first/out"), "plots/compare_out.html");
  const std::string first = core::read_file("plots/compare_out.html");
  EXPECT_EQ(page_of("a", "second/out/"), "plots/compare_out_2.html");
  EXPECT_EQ(page_of("first/out", "second/out"), "plots/compare_out_3.html");
  EXPECT_EQ(core::read_file("plots/compare_out.html"), first);
  // The same two again, named otherwise.
  EXPECT_EQ(page_of("a", "./second/out"), "plots/compare_out_2.html");
}

/// A history of two rows with one column of a gauge.
void write_gauge(const RunFolder &folder, const std::string &unit)
{
  RunRecord record = read_run_record(folder.record());
  record.gauges = {{"g", "distance", {"g"}, ""}};
  write_run_record(folder.record(), record);
  auto columns = history_columns(2);
  columns.push_back({"g", unit});
  HistoryWriter history(folder.history(), columns);
  for (int row = 0; row < 2; ++row) {
    for (const Column &column : columns)
      history.set(column.name, row);
    history.end_row();
  }
  history.flush();
}

TEST(Compare, AGaugeThatMeasuresSomethingElseIsLeftOut)
{
  const RunFolder run = SyntheticRun().write("a"), same = SyntheticRun().write("same"),
                  other = SyntheticRun().write("other");
  write_gauge(run, "m");
  write_gauge(same, "m");
  write_gauge(other, "Pa");
  EXPECT_EQ(compare("a", "same").gauges.count("g"), 1u);
  const CompareResult r = compare("a", "other");
  EXPECT_EQ(r.gauges.count("g"), 0u);
  EXPECT_NE(table(r).find("note: gauge g: in m in a, in Pa in other"), std::string::npos)
      << table(r);
  EXPECT_TRUE(r.compared_until);
}

// Of a run that is under way nobody knows yet.
TEST(Compare, WithoutListOfBrokenFacesTheirNumberIsNotZero)
{
  const RunFolder run = SyntheticRun().write("a");
  SyntheticRun().write("b");
  std::filesystem::remove(run.broken_bonds());
  const CompareResult r = compare("a", "b");
  const auto line = std::find_if(r.lines.begin(), r.lines.end(),
                                 [](const auto &l) { return l.name == "broken faces"; });
  ASSERT_NE(line, r.lines.end());
  EXPECT_EQ(line->run, "-");
  EXPECT_EQ(line->reference, "7");
  EXPECT_NE(table(r).find("a has no broken_bonds.csv"), std::string::npos) << table(r);
}

// The same load and crack in another body: figures that mean nothing, said per key.
TEST(Compare, BodiesThatDifferAreNamed)
{
  const auto with = [](const std::string &path, auto change) {
    const RunFolder folder = SyntheticRun().write(path);
    RunRecord record = read_run_record(folder.record());
    change(record);
    write_run_record(folder.record(), record);
  };
  const auto notes = [] { return compare("a", "b").notes; };
  SyntheticRun().write("a");
  with("b", [](RunRecord &r) { r.size[1] *= 1 + 1e-12; });
  EXPECT_TRUE(notes().empty()) << notes()[0];
  with("b", [](RunRecord &r) { r.size[1] *= 1 + 1e-7; });
  ASSERT_EQ(notes().size(), 1u);
  EXPECT_NE(notes()[0].find("specimen size: 0.1 m x 0.2 m in a, 0.1 m x 0.20000002 m in b"),
            std::string::npos)
      << notes()[0];
  with("b", [](RunRecord &r) {
    r.plane = "stress";
    r.thickness = 0.5;
  });
  ASSERT_EQ(notes().size(), 2u);
  EXPECT_NE(notes()[0].find("plane: strain in a, stress in b"), std::string::npos) << notes()[0];
  EXPECT_NE(notes()[1].find("thickness: 1 m in a, 0.5 m in b"), std::string::npos) << notes()[1];
}

TEST(Compare, NoPlacesAcrossDimensions)
{
  SyntheticRun().write("flat");
  const RunFolder folder = SyntheticRun().write("deep");
  RunRecord record = read_run_record(folder.record());
  record.dimension = 3;
  record.plane = "";
  record.size.push_back(0.1);
  write_run_record(folder.record(), record);
  const CompareResult r = compare("flat", "deep");
  ASSERT_EQ(r.notes.size(), 1u) << table(r);
  EXPECT_NE(r.notes[0].find("dimension: 2 in flat, 3 in deep"), std::string::npos) << r.notes[0];
  EXPECT_FALSE(r.crack_distance_mean);
  EXPECT_FALSE(r.breaking_time_error);
  EXPECT_FALSE(r.displacement_error);
  EXPECT_TRUE(r.peak_load_error);
  EXPECT_TRUE(r.time_ratio);
}

TEST(Compare, OfARunWithoutEndThePeakIsUnknown)
{
  SyntheticRun run;
  run.status = "running";
  const RunFolder folder = run.write("open");
  SyntheticRun().write("whole");
  RunRecord record = read_run_record(folder.record());
  record.reason = "";
  record.largest_load = 17; // of an end before, from whose checkpoint it goes on
  write_run_record(folder.record(), record);
  const CompareResult r = compare("open", "whole");
  const std::string text = table(r);
  EXPECT_FALSE(r.peak_load_error);
  EXPECT_NEAR(r.largest_load_error.value(), 0, rounding) << "by its history";
  EXPECT_FALSE(r.time_ratio);
  EXPECT_NE(text.find("note: peak: unknown of open"), std::string::npos) << text;
  EXPECT_NE(text.find("note: open is not finished\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("nothing broke"), std::string::npos) << text;
}
} // namespace
