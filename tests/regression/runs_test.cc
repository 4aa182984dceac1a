// Short whole runs of a small cracked plate: coupled against pure discrete elements, repeated, in
// all kinds of bodies, with guards and ends.
#include "core/files.h"
#include "src/analysis/compare.h"
#include "src/output/broken_bonds.h"
#include "src/output/table.h"
#include "src/simulation/simulation.h"
#include "tests/support/static_body.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
// Bonds break at a strain of 1e-3; the plate is pulled apart over some thirty passages of a wave.
const std::vector<std::string> pulled = {
    R"(/material/fracture={"criterion": "maximum_tension", "strength": 1e-3})",
    R"(/loads=[{"boundary": "top", "velocity": [null, 1.2e-5], "ramp": 1000},
               {"boundary": "bottom", "velocity": [null, -1.2e-5], "ramp": 1000}])",
    "/time/duration=6000", "/output/history_interval=10"};
const std::vector<std::string> cracked =
    std::vector<std::string>{R"(/specimen/cracks=[{"points": [[-4, 0], [4, 0]]}])"} + pulled;
const std::string until_broken = R"(/time/stop_when="specimen_broken")";

template <int dim>
RunRecord run(const std::string &folder, const Scene &scene)
{
  const RunFolder place{folder};
  std::filesystem::remove_all(folder);
  place.create();
  std::FILE *quiet = std::fopen("/dev/null", "w");
  const RunRecord record = Simulation<dim>(scene, place, quiet).run();
  std::fclose(quiet);
  return record;
}
RunRecord run(const std::string &folder, const std::vector<std::string> &overrides)
{
  return run<2>(folder, small_scene(overrides));
}

std::string content(const std::string &path)
{
  std::ifstream in(path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(Runs, CoupledPlateBreaksLikeItsPureDiscreteTwin)
{
  const auto until = cracked + std::vector<std::string>{until_broken};
  const RunRecord coupled = run("coupled", until);
  const RunRecord discrete = run("discrete", until + std::vector<std::string>{"/far_field=none"});
  EXPECT_EQ(coupled.kind, "coupled");
  EXPECT_EQ(discrete.kind, "pure_dem");
  for (const auto &record : {coupled, discrete}) {
    EXPECT_EQ(record.status, "done");
    EXPECT_EQ(record.reason.substr(0, 15), "specimen broken");
    // A crack along one row: two faces per spacing of the 16 left, less what the ends of the
    // initial crack and the sides take, at most a spacing each.
    EXPECT_GE(record.broken_bonds, 2 * (16 - 4));
    EXPECT_LT(*record.energy_residual, 0.02);
  }
  const CompareResult r = compare("coupled", "discrete");
  EXPECT_LT(std::abs(r.peak_load_error.value()), 0.01);
  EXPECT_LT(std::abs(r.stiffness_error.value()), 0.003);
  EXPECT_LT(r.crack_distance_mean.value(), 1);
  EXPECT_GT(r.particle_ratio.value(), 2);
}

// The crack runs through, and the load falls, between two rows, or within a few: the peak is that
// of the run, however far they are apart.
TEST(Runs, ThePeakIsThatOfTheRunNotOfItsRows)
{
  const auto peak = [](const std::string &interval) {
    const RunRecord record = run(
        "rows", cracked + std::vector<std::string>{
                              R"(/loads=[{"boundary": "top", "velocity": [null, 4e-4], "ramp": 50},
                                     {"boundary": "bottom", "velocity": [null, -4e-4], "ramp": 50}])",
                              until_broken, "/output/history_interval=" + interval});
    EXPECT_EQ(record.reason.substr(0, 15), "specimen broken");
    return record.peak_load.value_or(0);
  };
  const double of_each_step = peak("0.1");
  EXPECT_GT(of_each_step, 0);
  for (const std::string interval : {"10", "20", "30", "40", "600"})
    EXPECT_NEAR(peak(interval) / of_each_step, 1, 0.005) << interval;
}

// What moves when a load is there at once has F v dt/2 in the kinetic energy of its first step.
TEST(Runs, LoadsThatMeetABodyInMotionAreInTheBalance)
{
  for (const std::string ratio : {"1", "3"})
    for (const auto &kind : body_kinds) {
      SCOPED_TRACE(kind.name + (" " + ratio));
      const RunRecord record =
          run("moving", kind.overrides + std::vector<std::string>{
                                             R"(/initial_motion=[{"velocity": [0, 1e-5]}])",
                                             R"(/body_force={"acceleration": [0, -1e-5]})",
                                             "/coupling/step_ratio=" + ratio, "/time/duration=20"});
      EXPECT_LT(record.energy_residual.value_or(1), ratio == "1" ? 1e-9 : 1e-6);
    }
}

/// The last value of a column of a run's history.
double last_of(const std::string &folder, const std::string &column)
{
  std::istringstream lines(content(folder + "/history.csv"));
  std::string names, line, last, value;
  std::getline(lines, names);
  while (std::getline(lines, line))
    last = line;
  std::istringstream in_names(names), in_last(last);
  for (std::string name; std::getline(in_names, name, ',');) {
    std::getline(in_last, value, ',');
    if (name == column)
      return std::stod(value);
  }
  ADD_FAILURE() << "no " << column;
  return 0;
}

// A box without hardening that is pulled by 4 % bears 2/sqrt(3) of its yield stress in plane
// strain, however its lattice lies: cells that the sides cut neither stay elastic nor gain energy
// by flowing.
TEST(Runs, LatticesFlowAlikeHoweverTheyLie)
{
  const double yield = 2e-3, width = 16;
  for (const std::string packing : {"hexagonal", "square"})
    for (const double degrees : {5., 15., 25., 45.}) {
      SCOPED_TRACE(packing + " " + std::to_string(degrees));
      const RunRecord record =
          run("flows", {"/specimen={\"size\": [16, 16]}", "/far_field=none",
                        R"(/material={"youngs_modulus": 1, "poissons_ratio": 0.25, "density": 1,
                            "plasticity": {"law": "von_mises", "yield_stress": 2e-3}})",
                        fmt::format(R"(/discrete_zone={{"extent": "all", "packing": "{}",
                                    "spacing": 1, "orientation": {}}})",
                                    packing, degrees * M_PI / 180),
                        R"(/loads=[{"boundary": "top", "velocity": [null, 1.5e-3], "ramp": 20},
                                   {"boundary": "bottom", "velocity": [null, -1.5e-3], "ramp": 20}])",
                        "/time/duration=240"});
      EXPECT_NEAR(last_of("flows", "load") / (2 / std::sqrt(3.) * yield * width), 1, 0.02);
      EXPECT_LT(record.energy_residual.value_or(1), 1e-4);
    }
}

TEST(Runs, LatticesInSpaceFlowAlikeHoweverTheyLie)
{
  const double yield = 2e-3, section = 64;
  for (const std::string packing : {"fcc", "simple_cubic"})
    for (const std::string orientation : {"[0, 0, 0]", "[0.3, -0.2, 0.5]"}) {
      SCOPED_TRACE(packing + " " + orientation);
      run<3>("flows",
             static_scene<3>(
                 {"/specimen={\"size\": [8, 8, 8]}", "/far_field=none",
                  R"(/material={"youngs_modulus": 1, "poissons_ratio": 0.25, "density": 1,
                      "plasticity": {"law": "von_mises", "yield_stress": 2e-3}})",
                  R"(/discrete_zone={"extent": "all", "spacing": 1, "packing": ")" + packing +
                      R"(", "orientation": )" + orientation + "}",
                  R"(/loads=[{"boundary": "top", "velocity": [null, 5e-4, null], "ramp": 20},
                             {"boundary": "bottom", "velocity": [null, -5e-4, null], "ramp": 20}])",
                  "/time/duration=160"}));
      EXPECT_NEAR(last_of("flows", "load") / (yield * section), 1, 0.03);
    }
}

// No side bears a load that another one answers: whichever way it hangs, nothing is said of a path.
TEST(Runs, WhatItsWeightBreaksHasNoLoadPath)
{
  for (const bool along_x : {false, true}) {
    SCOPED_TRACE(along_x);
    const RunRecord record = run(
        "hanging",
        {along_x ? "/specimen={\"size\": [60, 24], \"cracks\": [{\"points\": [[0, -12], [0, 8]]}]}"
                 : "/specimen={\"size\": [24, 60], \"cracks\": [{\"points\": [[-12, 0], [8, 0]]}]}",
         R"(/material/fracture={"criterion": "maximum_tension", "strength": 1e-3})",
         along_x ? R"(/loads=[{"boundary": "right", "velocity": [0, 0]}])"
                 : R"(/loads=[{"boundary": "top", "velocity": [0, 0]}])",
         along_x ? R"(/body_force={"acceleration": [-4e-5, 0]})"
                 : R"(/body_force={"acceleration": [0, -4e-5]})",
         "/far_field=none",
         R"(/discrete_zone={"extent": "all", "packing": "square", "spacing": 1})",
         "/time/duration=400", until_broken});
    EXPECT_GE(record.broken_bonds, 3);
    EXPECT_FALSE(record.broken_time);
    EXPECT_EQ(record.reason, "end of the scene's duration");
  }
}

// The first bond breaks beside a grip and takes a part of the load with it: the peak is what the
// strip bore before, its strength times its width. Particles at lattice sites: all stresses are
// equal.
TEST(Runs, APeakByEquilibriaIsThatBeforeTheBreak)
{
  for (const std::string packing : {"square", "hexagonal"}) {
    SCOPED_TRACE(packing);
    const RunRecord record =
        run("strip", {"/specimen={\"size\": [20, 40]}", "/plane=\"stress\"",
                      R"(/material/fracture={"criterion": "principal_stress", "strength": 1e-3})",
                      R"(/loads=[{"boundary": "top", "velocity": [null, 1e-6], "ramp": 1000},
                             {"boundary": "bottom", "velocity": [null, 0]}])",
                      "/far_field=none",
                      "/discrete_zone={\"extent\": \"all\", \"spacing\": 1, \"packing\": \"" +
                          packing + "\"}",
                      "/time/duration=60000", "/time/loading=\"sequential\"", until_broken});
    ASSERT_TRUE(record.peak_stress);
    EXPECT_NEAR(*record.peak_stress, 1e-3, 1e-6);
  }
}

TEST(Runs, TheSameSceneGivesTheSameBits)
{
  const auto overrides =
      cracked + std::vector<std::string>{"/time/duration=4000", "/coupling/step_ratio=2"};
  run("first", overrides);
  run("second", overrides);
  const std::string history = content("first/history.csv");
  EXPECT_GT(history.size(), 10000u);
  EXPECT_FALSE(content("first/snapshot_0.bin").empty());
  EXPECT_EQ(history, content("second/history.csv"));
  EXPECT_EQ(content("first/broken_bonds.csv"), content("second/broken_bonds.csv"));
  EXPECT_EQ(content("first/snapshot_0.bin"), content("second/snapshot_0.bin"));
}

TEST(Runs, PureBodiesGoThroughTheSameLoop)
{
  // Quasi-static stretch without fracture: stress over strain is E/(1 - nu^2) of plane strain.
  const std::vector<std::string> elastic = {pulled[1], "/time/duration=2000"};
  for (const auto &kind : body_kinds) {
    SCOPED_TRACE(kind.name);
    const RunRecord record = run(std::string("elastic_") + kind.name, kind.overrides + elastic);
    EXPECT_EQ(record.kind, kind.name);
    EXPECT_EQ(record.particles > 0, record.kind != "pure_fem");
    EXPECT_EQ(record.cells > 0, record.kind != "pure_dem");
    EXPECT_EQ(record.broken_bonds, 0);
    // Ramp and waves: the load lags by the inertia of the plate, (L/cT)^2 of it or about 1 %.
    EXPECT_NEAR(record.stiffness.value() * (1 - 0.22 * 0.22), 1, 0.01);
    EXPECT_LT(*record.energy_residual, 0.01);
  }
}

// Impulses on the mesh begin with an energy and a swing of their own: neither is a gain, and the
// guard lets them pass.
TEST(Runs, LoadsThatAreThereAtOnceAreNoGain)
{
  const std::string held = R"({"boundary": "bottom", "displacement": [0, 0]})";
  const std::vector<std::string> loads[] = {
      {"/loads=[" + held + R"(, {"boundary": "top", "traction": [null, 1e-3]}])"},
      {"/loads=[" + held + "]", R"(/body_force={"acceleration": [0, -1e-4]})"}};
  for (const auto &at_once : loads)
    for (const char *ratio : {"1", "2", "3"}) {
      SCOPED_TRACE(at_once[0] + " " + ratio);
      const RunRecord record =
          run("at_once",
              at_once + std::vector<std::string>{std::string("/coupling/step_ratio=") + ratio});
      EXPECT_EQ(record.status, "done") << record.reason;
      ASSERT_TRUE(record.energy_residual);
      EXPECT_LT(*record.energy_residual, 1e-3);
    }
}

// Where nothing holds a body it is sought where it moves as a whole, by the mass that it has: under
// its weight alone nothing is strained, and a push strains it as its twins.
TEST(Runs, FreeBodiesInEquilibriumMoveByTheirMass)
{
  std::map<std::string, double> work;
  for (const BodyKind &kind : body_kinds) {
    SCOPED_TRACE(kind.name);
    const std::vector<std::string> by_equilibria =
        kind.overrides + std::vector<std::string>{"/time/loading=static", "/time/duration=2e4",
                                                  "/output/history_interval=1e3"};
    run("free", by_equilibria + std::vector<std::string>{
                                    R"(/body_force={"acceleration": [0, -1e-5], "ramp": 1e4})"});
    const auto fallen = read_csv("free/history.csv");
    EXPECT_LT(std::abs(fallen.column("external_work", "J").back()), 1e-15);
    run("free", by_equilibria +
                    std::vector<std::string>{
                        R"(/loads=[{"boundary": "top", "traction": [null, 1e-3], "ramp": 1e4}])"});
    work[kind.name] = read_csv("free/history.csv").column("external_work", "J").back();
  }
  EXPECT_NEAR(work["coupled"] / work["pure_dem"], 1, 0.02);
  EXPECT_NEAR(work["coupled"] / work["pure_fem"], 1, 0.02);
}

// The pressure on a closed rim has no resultant, nor have supports any: what is out of balance is
// measured by the force on all of its faces.
TEST(Runs, PressureInAHoleIsOnePhase)
{
  for (const BodyKind &kind : body_kinds) {
    SCOPED_TRACE(kind.name);
    const RunRecord record = run(
        "rim",
        kind.overrides +
            std::vector<std::string>{
                R"(/specimen/cutouts=[{"outline": [{"at": [3, 0], "centre": [0, 0]}], "side": "rim"}])",
                R"(/loads=[{"boundary": "rim", "pressure": 1e-3, "ramp": 1e4}])",
                "/time/loading=static", "/time/duration=2e4", "/output/history_interval=1e3"});
    EXPECT_EQ(record.status, "done") << record.reason;
    ASSERT_EQ(record.phases.size(), 1u);
    EXPECT_LE(record.phases[0].solves, 60);
    ASSERT_TRUE(record.energy_residual);
    EXPECT_LT(*record.energy_residual, 1e-6);
  }
}

// Both ends move sideways, the plate turns by a third of a degree. A linear coarse model would feel
// the strain phi^2/2; at 0.1 degrees it becomes corotated, and log and record say so.
TEST(Runs, ATurningPlateChangesItsRegimeByItself)
{
  const std::string turns = R"(/loads=[{"boundary": "top", "velocity": [3e-4, null], "ramp": 600},
                                       {"boundary": "bottom", "velocity": [-3e-4, null], "ramp": 600}])";
  const RunRecord record = run("turning", {turns, "/time/duration=1500"});
  EXPECT_EQ(record.status, "done");
  ASSERT_EQ(record.regime.substr(0, 23), "linear, corotated from ") << record.regime;
  // The ends have moved by 60 tan(0.1 degrees) when v (t - 300) has, give or take how far the plate
  // lags behind its ends and 50 steps between two looks.
  const double expected = 300 + 60 * std::tan(0.1 * M_PI / 180) / 3e-4;
  EXPECT_NEAR(std::stod(record.regime.substr(23)), expected, 0.25 * expected);
  EXPECT_NE(content("turning/run.json").find(record.regime), std::string::npos);
  EXPECT_NE(content("turning/run.log").find("corotated"), std::string::npos);
  EXPECT_LT(*record.energy_residual, 1e-3);
}

TEST(Runs, GuardStopsAtNineTenthsOfTheStrength)
{
  // Without crack the tension is the same everywhere.
  const RunRecord record = run("guarded", pulled + std::vector<std::string>{"/time/duration=8000"});
  EXPECT_EQ(record.status, "stopped");
  EXPECT_FALSE(record.is_complete());
  EXPECT_NE(record.reason.find("overlap"), std::string::npos);
  EXPECT_EQ(record.broken_bonds, 0);
  EXPECT_FALSE(record.peak_load);
  EXPECT_EQ(record.trusted_until, record.simulated_time);
  EXPECT_EQ(record.verdict.find("nothing unstable"), std::string::npos);
  // The strength is that of a uniaxial state. Three per cent: waves run.
  EXPECT_NEAR(record.largest_stress.value() / 0.9e-3, 1, 0.03);
}

/// Of the faces in broken_bonds.csv those of the overlap, pads excepted.
std::vector<BrokenBond> broken_in_overlap(const std::string &folder, const Scene &scene)
{
  const SmallBody small(scene);
  const auto &state = small.body.zone->state;
  std::map<std::int64_t, bool> is_pad;
  for (const auto &m : small.body.coupler->overlap()->members)
    is_pad[state.global_id[m.particle]] = m.pad;
  std::vector<BrokenBond> found;
  for (const BrokenBond &b : read_broken_bonds(RunFolder{folder}.broken_bonds())) {
    const auto i = is_pad.find(b.i), j = is_pad.find(b.j);
    const bool any = i != is_pad.end() || j != is_pad.end();
    const bool pad = (i != is_pad.end() && i->second) || (j != is_pad.end() && j->second);
    if (any && !pad)
      found.push_back(b);
  }
  return found;
}

// Without a crack, so that waves break it where they meet.
std::vector<std::string> torn(double speed, const std::vector<std::string> &more = {})
{
  return std::vector<std::string>{
             R"(/material/fracture={"criterion": "maximum_tension", "strength": 1e-3})",
             fmt::format(R"(/loads=[{{"boundary": "top", "velocity": [null, {0}]}},
                                    {{"boundary": "bottom", "velocity": [null, -{0}]}}])",
                         speed),
             "/time/duration=600", "/coupling/step_ratio=4", "/output/history_interval=1"} +
         more;
}

// In glass with a strength of 25 MPa these speeds are 0.3, 0.8 and 50 m/s.
TEST(Runs, NoMoreBreaksInTheOverlapThanInOneStepOfTheFarField)
{
  for (const double speed : {1.6e-4, 4.2e-4, 0.026}) {
    SCOPED_TRACE(speed);
    const RunRecord record = run("torn", torn(speed));
    EXPECT_EQ(record.is_complete(), false);
    EXPECT_EQ(record.status, "stopped");
    const auto broken = broken_in_overlap("torn", small_scene(torn(speed)));
    EXPECT_EQ(record.broken_in_overlap, std::int64_t(broken.size()));
    for (const BrokenBond &b : broken)
      EXPECT_GT(b.time, record.simulated_time - 4 * record.dt * (1 + 1e-9));
    EXPECT_EQ(record.trusted_until, record.simulated_time);
  }
}

TEST(Runs, WarnedRunsCountWhatBreaksInTheOverlap)
{
  const auto warn = torn(0.026, {R"(/coupling/guard="warn")"});
  const RunRecord record = run("warned", warn);
  EXPECT_EQ(record.status, "done");
  EXPECT_GT(record.broken_in_overlap, 0);
  EXPECT_EQ(record.broken_in_overlap,
            std::int64_t(broken_in_overlap("warned", small_scene(warn)).size()));
  ASSERT_FALSE(record.warnings.empty());
  EXPECT_NE(record.verdict.find("lie in the overlap"), std::string::npos) << record.verdict;
  EXPECT_NE(content("warned/run.log").find("in the overlap"), std::string::npos);
  EXPECT_LT(record.trusted_until.value(), record.simulated_time);
  EXPECT_LE(record.largest_time.value(), record.trusted_until.value());
  EXPECT_EQ(record.verdict.find("nothing unstable"), std::string::npos);
}

// A pulse of ten cells' length runs through the plate; nothing can break.
TEST(Runs, WavesAreComparedAtEqualTimes)
{
  const std::vector<std::string> wave = {
      R"(/loads=[{"boundary": "top", "velocity": [null, 1e-4], "ramp": 40}])", "/time/duration=150",
      "/output/history_interval=0.5"};
  run("wave", wave + std::vector<std::string>{"/coupling/step_ratio=4"});
  run("wave_twin", wave + std::vector<std::string>{"/far_field=none"});
  const CompareResult r = compare("wave", "wave_twin");
  EXPECT_TRUE(r.complete);
  EXPECT_FALSE(r.peak_load_error);
  EXPECT_EQ(table(r).find("peak load"), std::string::npos) << table(r);
  ASSERT_TRUE(r.displacement_error) << table(r);
  EXPECT_LT(*r.displacement_error, 0.01);
  EXPECT_LT(r.velocity_error.value(), 0.05);
  EXPECT_LT(r.load_history.mean.value(), 0.05); // the mesh disperses waves of ten cells
  EXPECT_GT(r.kinetic_share.value(), 0.1);
}
} // namespace
