// Runs on several ranks beside one process: what both wrote, byte for byte. LIGAMENT_PROGRAM is the
// program.
#pragma once

#include "core/state_file.h"
#include "tests/support/run_results.h"

#include <fmt/format.h>

#include <algorithm>

namespace ligament::tests
{
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A body of particles alone, in units of d = 1, E = 1, rho = 1. A checkpoint is due whenever the
/// run looks at the clock: a longer interval may last longer than a whole run on a fast machine.
inline Json scene_of(int dim, const std::string &packing, std::vector<double> size)
{
  Json scene = {{"title", packing},
                {"dimension", dim},
                {"specimen", {{"size", size}}},
                {"material",
                 {{"youngs_modulus", 1},
                  {"poissons_ratio", 0.25},
                  {"density", 1},
                  {"friction", 0.4},
                  {"fracture", {{"criterion", "maximum_tension"}, {"strength", 2e-3}}}}},
                {"discrete_zone", {{"extent", "all"}, {"packing", packing}, {"spacing", 1}}},
                {"time", {{"duration", 160}}},
                {"output",
                 {{"history_interval", 1.7},
                  {"field_interval", 60},
                  {"progress_interval", 1000},
                  {"checkpoint_interval", 1e-9}}}};
  return scene;
}

/// The two sides across an axis move apart, or along each other.
inline void pull(Json &scene, int axis, int component, double velocity, double ramp = 40)
{
  const char *const sides[][2] = {{"left", "right"}, {"bottom", "top"}, {"back", "front"}};
  for (const int side : {0, 1}) {
    Json v = Json::array();
    for (int c = 0; c < scene["dimension"]; ++c)
      v.push_back(c == component ? Json(side ? velocity : -velocity) : Json());
    scene["loads"].push_back({{"boundary", sides[axis][side]}, {"velocity", v}, {"ramp", ramp}});
  }
}

/// Cut in two, whose flanks slide along each other.
inline Json halves_that_slide()
{
  Json scene = scene_of(2, "hexagonal", {30, 40});
  scene["discrete_zone"]["orientation"] = 10;
  scene["specimen"]["cracks"] = {{{"points", {{0, -20.5}, {0, 20.5}}}}};
  pull(scene, 0, 1, 2e-3);
  return scene;
}

/// A zone in the middle of a plate or block, in units of d = 1, E = 1, rho = 1.
inline Json coupled(int dim, const std::string &packing, std::vector<double> size,
                    std::vector<double> zone, double cell)
{
  Json scene = scene_of(dim, packing, size), lower = Json::array(), upper = lower;
  for (const double width : zone) { // 0: through the body
    lower.push_back(width > 0 ? Json(-width / 2) : Json());
    upper.push_back(width > 0 ? Json(width / 2) : Json());
  }
  scene["discrete_zone"].erase("extent");
  scene["discrete_zone"]["region"] = {{"lower", lower}, {"upper", upper}};
  scene["far_field"]["cell_size"] = cell;
  scene["coupling"] = {{"overlap_cells", 2}, {"transition_cells", 2}};
  return scene;
}

/// Von Mises' law, whose yield stress doubles.
inline void let_flow(Json &scene, double yield)
{
  scene["material"]["plasticity"] = {{"law", "von_mises"},
                                     {"yield_stress", yield},
                                     {"saturation", yield},
                                     {"saturation_rate", 200}};
}

/// Branches and a dashpot, of times near those of the steps.
inline void let_creep(Json &scene)
{
  scene["material"]["viscosity"] = {
      {"branches",
       {{{"share", 0.3}, {"relaxation_time", 8}}, {{"share", 0.2}, {"relaxation_time", 60}}}},
      {"shear_viscosity", 0.05}};
}

/// In the last row of the history.
inline double last_in_history(const std::string &run, const std::string &column)
{
  std::istringstream rows(file_text(run + "/history.csv"));
  std::string header, row, last;
  std::getline(rows, header);
  while (std::getline(rows, row))
    last = row;
  std::istringstream names(header), values(last);
  for (std::string name, value; std::getline(names, name, ',') && std::getline(values, value, ',');)
    if (name.substr(0, name.find('[')).find(column) != name.npos)
      return std::stod(value);
  ADD_FAILURE() << "no column " << column << " in " << header;
  return 0;
}

inline std::string written(const Json &scene, const std::string &name)
{
  std::ofstream(name) << scene.dump(2);
  return name;
}

/// The newest state without what it says of blocks at rest, which each rank cuts otherwise.
inline core::State last_state(const std::string &run)
{
  core::State state = core::read_state_file(newest_checkpoint(run) + "/body.bin");
  for (const char *table : {"blocks", "rest", "split_rest"})
    state.erase(table);
  return state;
}

/// What a record says of the body: neither how long it took nor how much of it rested.
inline nlohmann::json said(const nlohmann::json &record, const std::string &key)
{
  nlohmann::json value = record.value(key, nlohmann::json()), kept;
  if (key != "phases" && key != "skipped")
    return value;
  for (auto &part : value) {
    part.erase("seconds");
    if (std::string(part.value("why", "")).rfind("at rest", 0) != 0)
      kept.push_back(part);
  }
  return kept;
}

/// All that they computed; how much of it rested is not part of that. Runs that guards end have no
/// state of their end.
inline void expect_same_body(const std::string &run, const std::string &reference,
                             bool has_state = true)
{
  auto found = results(run), expected = results(reference);
  EXPECT_GT(expected.size(), 4u);
  found.erase("body.bin");
  expected.erase("body.bin");
  EXPECT_EQ(found.size(), expected.size()) << run;
  for (const auto &[name, content] : expected) {
    EXPECT_FALSE(content.empty()) << name;
    EXPECT_TRUE(found.count(name) && found.at(name) == content) << run << "/" << name;
  }
  if (has_state) {
    EXPECT_TRUE(last_state(run) == last_state(reference)) << run;
  }
  const auto record = file_json(run + "/run.json"), wanted = file_json(reference + "/run.json");
  for (const char *key : {"status",
                          "reason",
                          "steps",
                          "particles",
                          "dt",
                          "broken_bonds",
                          "crack_length",
                          "peak_load",
                          "external_work",
                          "energy_residual",
                          "states",
                          "warnings",
                          "magnification",
                          "stiffness",
                          "broken_time",
                          "regime",
                          "overlap_particles",
                          "broken_in_overlap",
                          "trusted_until",
                          "gauges",
                          "phases",
                          "skipped"})
  {
    const bool is_of_some = key == std::string("phases") || key == std::string("gauges");
    EXPECT_TRUE(is_of_some || wanted.contains(key)) << key;
    EXPECT_EQ(said(record, key), said(wanted, key)) << key;
  }
}

/// In a folder of its own.
class OnRanks : public testing::Test
{
protected:
  void SetUp() override
  {
    const auto *test = testing::UnitTest::GetInstance()->current_test_info();
    const std::string folder = std::string("ranks_") + test->name();
    fs::remove_all(folder);
    fs::create_directory(folder);
    fs::current_path(folder);
  }
  void TearDown() override { fs::current_path(".."); }

  /// On one process and on so many ranks; a test in which nothing breaks would prove little.
  static void expect_the_same_on(const std::vector<int> &ranks, const Json &scene, int least_broken,
                                 int code = 0)
  {
    written(scene, "scene.json");
    const Outcome one = run_ligament("run scene.json -o on_1");
    ASSERT_EQ(one.code, code) << one.errors;
    EXPECT_GE(file_json("on_1/run.json")["broken_bonds"], least_broken);
    for (const int n : ranks) {
      const std::string run = "on_" + std::to_string(n);
      fs::remove_all(run);
      const Outcome outcome = run_ligament("run scene.json -n " + std::to_string(n) + " -o " + run);
      ASSERT_EQ(outcome.code, code) << outcome.errors;
      expect_same_body(run, "on_1", code == 0);
    }
  }

  /// What `check` says of two ranks is what they then have.
  static void expect_check_to_know(Json scene)
  {
    scene["time"]["duration"] = 2;
    written(scene, "scene.json");
    const Outcome check = run_ligament("check scene.json -n 2 --json");
    ASSERT_EQ(check.code, 0) << check.errors;
    const auto ranks = check.json()["on_ranks"];
    ASSERT_EQ(run_ligament("run scene.json -n 2 -o out").code, 0);
    const std::string had = fmt::format("on 2 ranks up to {} and {} ghosts",
                                        ranks["particles"].dump(), ranks["ghosts"].dump());
    EXPECT_NE(file_text("out/run.log").find(had), std::string::npos) << had;
    EXPECT_GT(ranks["seconds_per_step"], 0);
    EXPECT_GT(ranks["memory_bytes"], ranks["other_memory_bytes"]);
    fs::remove_all("out");
  }

  /// And where they are cut anew every so many steps of the far field, elsewhere each time.
  static void expect_the_same_when_cut_anew(int n, const Json &scene, int interval,
                                            int least_broken)
  {
    expect_the_same_on({}, scene, least_broken);
    const Outcome outcome = run_ligament(
        fmt::format("run scene.json -n {} --rebuild-interval {} -o cut_anew", n, interval));
    ASSERT_EQ(outcome.code, 0) << outcome.errors;
    expect_same_body("cut_anew", "on_1");
    const std::string log = file_text("cut_anew/run.log"), what = "cut anew at ";
    int n_times = 0;
    for (auto at = log.find(what); at != std::string::npos; at = log.find(what, at + 1)) {
      ++n_times;
      EXPECT_EQ(log.substr(at, 60).find(": 0 of "), std::string::npos) << log.substr(at, 60);
    }
    EXPECT_GE(n_times, 2);
  }

  /// Half of the time on every number of ranks, the rest on every other one.
  static void expect_to_go_on(Json scene, int most)
  {
    const double duration = scene["time"]["duration"];
    // `check` warns of one that is longer than the run.
    scene["output"]["field_interval"] =
        std::min(double(scene["output"]["field_interval"]), 0.4 * duration);
    written(scene, "scene.json");
    ASSERT_EQ(run_ligament("run scene.json -o whole").code, 0);
    const auto number = [](int n) { return std::to_string(n); };
    for (int a = 1; a <= most; ++a) {
      const std::string half = "half_" + number(a);
      ASSERT_EQ(run_ligament("run scene.json --set /time/duration=" + std::to_string(duration / 2) +
                             " -n " + number(a) + " -o " + half)
                    .code,
                0);
      for (int b = 1; b <= most; ++b) {
        const std::string run = "from_" + number(a) + "_to_" + number(b);
        fs::copy(half, run, fs::copy_options::recursive);
        const Outcome outcome = run_ligament("resume " + run + " -n " + number(b) +
                                             " --set /time/duration=" + std::to_string(duration));
        ASSERT_EQ(outcome.code, 0) << outcome.errors;
        expect_same_body(run, "whole");
      }
    }
  }
};
} // namespace ligament::tests
