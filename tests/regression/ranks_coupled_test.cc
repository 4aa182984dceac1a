// Particles inside finite elements on several ranks: byte for byte what one process writes, also
// where they go on on other numbers of ranks. Through the programs.
#include "tests/support/rank_runs.h"

using namespace ligament::tests;

namespace
{
class RanksCoupled : public OnRanks
{
};

/// The zone closed by mesh all around, its cells cut by the seams.
Json closed_zone()
{
  Json scene = coupled(2, "hexagonal", {90, 90}, {48, 42}, 3.7);
  scene["specimen"]["cracks"] = {{{"points", {{-6, 0}, {6, 0}}}}};
  scene["material"]["fracture"]["strength"] = 1e-3;
  pull(scene, 1, 1, 4e-4);
  scene["time"]["duration"] = 75;
  return scene;
}

/// Through the body; several steps of particles to one of the mesh, all dampers.
Json turned_with_steps()
{
  Json scene = coupled(2, "hexagonal", {30, 120}, {0, 44}, 4.3);
  scene["discrete_zone"]["orientation"] = 17;
  scene["specimen"]["cracks"] = {{{"points", {{-5, 1}, {6, -2}}}}};
  scene["coupling"]["step_ratio"] = 3;
  scene["coupling"]["fine_damper"] = 0.3;
  scene["coupling"]["gap_filter"] = 0.2;
  scene["damping"] = {{"mass", 1e-3}, {"local", 0.05}};
  scene["material"]["fracture"]["strength"] = 1e-3;
  pull(scene, 1, 1, 4e-4);
  scene["time"]["duration"] = 260;
  return scene;
}

/// Sheared so far that the overlap turns and bends, its energy then that of the particles
/// themselves.
Json bent_strip()
{
  Json scene = coupled(2, "square", {24, 110}, {0, 40}, 4.1);
  scene["material"]["fracture"]["strength"] = 0.03;
  scene["coupling"]["regime"] = "nonlinear";
  scene["coupling"]["step_ratio"] = 2;
  pull(scene, 1, 0, 6e-3, 60);
  scene["time"]["duration"] = 220;
  return scene;
}

Json turning_strip()
{
  Json scene = bent_strip();
  scene["coupling"]["regime"] = "automatic";
  return scene;
}

/// Pads at the seam turn when the regime changes, between two steps.
Json zone_that_turns()
{
  Json scene = closed_zone();
  scene["discrete_zone"]["packing"] = "random";
  scene["material"]["fracture"]["strength"] = 0.03;
  scene["coupling"]["regime"] = "automatic";
  scene["loads"] = Json::array();
  pull(scene, 1, 0, 6e-3, 20);
  scene["time"]["duration"] = 110;
  return scene;
}

/// The guard ends it: the crack runs into the overlap.
Json crack_into_the_overlap()
{
  Json scene = closed_zone();
  scene["time"]["duration"] = 260;
  return scene;
}

/// And goes on through it where the guard only warns.
Json crack_through_the_overlap()
{
  Json scene = crack_into_the_overlap();
  scene["coupling"]["guard"] = "warn";
  scene["time"]["duration"] = 120;
  return scene;
}

/// Two zones, random.
Json two_zones()
{
  Json scene = coupled(2, "random", {136, 78}, {40, 30}, 3.9);
  scene["discrete_zone"].erase("region");
  scene["discrete_zone"]["boxes"] = {{{"lower", {-60, -23}}, {"upper", {-8, 23}}},
                                     {{"lower", {10, -23}}, {"upper", {60, 23}}}};
  scene["specimen"]["cracks"] = {{{"points", {{-38, 0}, {-30, 2}}}},
                                 {{"points", {{29, -2}, {36, 0}}}}};
  scene["material"]["fracture"]["strength"] = 1e-3;
  pull(scene, 1, 1, 4e-4);
  scene["time"]["duration"] = 60;
  return scene;
}

Json block_with_a_crack()
{
  Json scene = coupled(3, "fcc", {12, 50, 10}, {0, 26, 0}, 3.1);
  scene["specimen"]["cracks"] = {
      {{"points", {{-6.5, 0.3, -6}, {0, 0.3, -6}, {0, 0.3, 6}, {-6.5, 0.3, 6}}}}};
  scene["material"]["fracture"]["strength"] = 1.5e-3;
  scene["coupling"]["guard"] = "warn";
  scene["coupling"]["regime"] = "corotated";
  pull(scene, 1, 1, 1e-3, 10);
  scene["time"]["duration"] = 45;
  return scene;
}

/// Overlap and far field wait for a wave from one end.
Json bar_that_rests()
{
  Json scene = coupled(2, "hexagonal", {16, 260}, {0, 60}, 4.1);
  scene["material"]["fracture"]["strength"] = 0.1;
  scene["loads"] = {{{"boundary", "top"}, {"velocity", {nullptr, 4e-3}}, {"ramp", 10}}};
  scene["time"]["duration"] = 330;
  return scene;
}

/// A bar whose waist flows: the zone goes on into its wide ends.
Json waist_that_flows()
{
  Json scene = coupled(2, "hexagonal", {40, 130}, {0, 74}, 3.9);
  scene["plane"] = "stress";
  scene["specimen"]["notches"] = {{{"lower", {-21, -9}}, {"upper", {-9, 9}}},
                                  {{"lower", {9, -9}}, {"upper", {21, 9}}}};
  let_flow(scene, 2e-3);
  scene["material"]["fracture"]["strength"] = 0.01;
  scene["coupling"]["step_ratio"] = 2;
  scene["damping"] = {{"mass", 1e-2}};
  scene["gauges"] = {{{"name", "length"}, {"kind", "opening"}, {"points", {{0, -8}, {0, 8}}}},
                     {{"name", "s"}, {"kind", "stress"}, {"lower", {-6, -8}}, {"upper", {6, 8}}}};
  pull(scene, 1, 1, 6e-4, 60);
  scene["time"]["duration"] = 300;
  return scene;
}

/// The guard ends it: flow comes into the overlap.
Json flow_into_the_overlap()
{
  Json scene = waist_that_flows();
  scene["specimen"].erase("notches");
  return scene;
}

/// A crack that flows and creeps while it grows, closed in by mesh.
Json crack_that_flows_and_creeps()
{
  Json scene = closed_zone();
  let_flow(scene, 4e-4);
  let_creep(scene);
  scene["coupling"]["guard"] = "warn";
  return scene;
}

Json block_that_flows()
{
  Json scene = block_with_a_crack();
  scene["material"]["plasticity"] = {{"law", "drucker_prager"},
                                     {"cohesion", 1.5e-3},
                                     {"friction_angle", "25 deg"},
                                     {"dilatancy_angle", "10 deg"}};
  return scene;
}

TEST_F(RanksCoupled, AZoneClosedByMesh)
{
  expect_the_same_on({2, 3}, closed_zone(), 10);
}
TEST_F(RanksCoupled, TheGuardOfTheOverlapEndsAll)
{
  expect_the_same_on({3}, crack_into_the_overlap(), 10, 3);
}
TEST_F(RanksCoupled, ACrackThroughTheOverlap)
{
  expect_the_same_on({2}, crack_through_the_overlap(), 50);
}
TEST_F(RanksCoupled, TurnedWithStepsOfTheMeshAndDampers)
{
  expect_the_same_on({2, 4}, turned_with_steps(), 10);
}
TEST_F(RanksCoupled, AStripThatBends)
{
  expect_the_same_on({3}, bent_strip(), 0);
}
TEST_F(RanksCoupled, AStripThatTurns)
{
  expect_the_same_on({2}, turning_strip(), 0);
  const std::string regimes = file_json("on_1/run.json")["regime"];
  EXPECT_NE(regimes.find(" from "), std::string::npos) << regimes;
}
TEST_F(RanksCoupled, CheckKnowsPartsAndGhosts)
{
  for (const Json &scene : {closed_zone(), block_with_a_crack(), two_zones()})
    expect_check_to_know(scene);
}
TEST_F(RanksCoupled, AZoneThatTurns)
{
  expect_the_same_on({2, 3}, zone_that_turns(), 0);
  const std::string regimes = file_json("on_1/run.json")["regime"];
  EXPECT_NE(regimes.find(" from "), std::string::npos) << regimes;
}
TEST_F(RanksCoupled, TwoZonesOfRandomParticles)
{
  expect_the_same_on({2}, two_zones(), 10);
}
TEST_F(RanksCoupled, ABlockWithACrack)
{
  expect_the_same_on({2}, block_with_a_crack(), 10);
}
TEST_F(RanksCoupled, ABarThatRests)
{
  expect_the_same_on({2}, bar_that_rests(), 0);
  for (const char *share : {"share_at_rest", "overlap_at_rest"})
    EXPECT_GT(file_json("on_2/run.json")["figures"][share]["value"], 0.02) << share;
}
// What rests before a new cut rests after it; the overlap, which the wave has woken, goes on.
TEST_F(RanksCoupled, ABarThatRestsCutAnew)
{
  expect_the_same_when_cut_anew(2, bar_that_rests(), 60, 0);
  for (const char *share : {"share_at_rest", "overlap_at_rest"})
    EXPECT_GT(file_json("cut_anew/run.json")["figures"][share]["value"], 0.02) << share;
}
TEST_F(RanksCoupled, AWaistThatFlows)
{
  expect_the_same_on({3}, waist_that_flows(), 0);
  EXPECT_GT(last_in_history("on_1", "plastic_heat"), 0);
}
TEST_F(RanksCoupled, TheGuardOfFlowEndsAll)
{
  expect_the_same_on({2}, flow_into_the_overlap(), 0, 3);
}
TEST_F(RanksCoupled, ACrackThatFlowsAndCreeps)
{
  expect_the_same_on({2}, crack_that_flows_and_creeps(), 1);
  EXPECT_GT(last_in_history("on_1", "plastic_heat"), 0);
  EXPECT_GT(last_in_history("on_1", "viscous"), 0);
}
TEST_F(RanksCoupled, SlowABlockThatFlows)
{
  expect_the_same_on({2}, block_that_flows(), 5);
  EXPECT_GT(last_in_history("on_1", "plastic_heat"), 0);
}
TEST_F(RanksCoupled, CutAnewWhileFacesOfTheOverlapBreak)
{
  expect_the_same_when_cut_anew(3, crack_through_the_overlap(), 60, 50);
}

/// From equilibrium to equilibrium, with gauges.
Json calm_until_it_breaks()
{
  Json scene = coupled(2, "random", {40, 100}, {0, 46}, 4.1);
  scene["specimen"]["cracks"] = {{{"points", {{-21, 0}, {-8, 0}}}}};
  scene["material"]["fracture"]["strength"] = 1e-3;
  scene["time"] = {{"duration", 4000}, {"loading", "static"}};
  scene["damping"] = {{"local", 0.4}};
  scene["coupling"]["guard"] = "warn";
  scene["loads"] = {{{"boundary", "top"}, {"velocity", {0, 5e-5}}},
                    {{"boundary", "bottom"}, {"velocity", {0, -5e-5}}}};
  scene["gauges"] = {
      {{"name", "length"}, {"kind", "distance"}, {"points", {{0, -40}, {3, 9}}}},
      {{"name", "mouth"}, {"kind", "opening"}, {"points", {{-18, -0.6}, {-18, 0.6}}}},
      {{"name", "e"}, {"kind", "strain"}, {"lower", {-6, -8}}, {"upper", {6, 30}}},
      {{"name", "s"}, {"kind", "stress"}, {"lower", {-6, -8}}, {"upper", {6, 30}}},
      {{"name", "e_point"}, {"kind", "strain"}, {"points", {{2, 3}}}},
      {{"name", "s_point"}, {"kind", "stress"}, {"points", {{2, 3}}}},
      {{"name", "f"}, {"kind", "force"}, {"side", "top"}},
      {{"name", "tip"}, {"kind", "crack_tip"}, {"points", {{-8, 0}}}, {"direction", {1, 0}}}};
  return scene;
}

TEST_F(RanksCoupled, FromEquilibriumToEquilibriumWithGauges)
{
  expect_the_same_on({2}, calm_until_it_breaks(), 10);
}

TEST_F(RanksCoupled, CutAnewBetweenEquilibria)
{
  expect_the_same_when_cut_anew(3, calm_until_it_breaks(), 100, 10);
}

// To the tolerance of equilibria: up to the first broken bond, behind which such differences grow.
TEST_F(RanksCoupled, EquilibriaByAllRanks)
{
  Json scene = calm_until_it_breaks();
  scene["specimen"]["size"] = {50, 120};
  scene["discrete_zone"]["region"] = {{"lower", {nullptr, -32}}, {"upper", {nullptr, 32}}};
  scene["time"]["duration"] = 1200;
  written(scene, "scene.json");
  ASSERT_EQ(run_ligament("run scene.json --set /time/static_solver=multigrid -o by_one").code, 0);
  for (const int n : {2, 3}) {
    const std::string run = fmt::format("by_{}", n);
    const Outcome outcome = run_ligament(fmt::format(
        "run scene.json -n {} --set /time/static_solver=parallel_multigrid -o {}", n, run));
    ASSERT_EQ(outcome.code, 0) << outcome.errors;
    const auto wanted = file_json("by_one/run.json")["phases"],
               found = file_json(run + "/run.json")["phases"];
    ASSERT_GE(wanted.size(), 2u);
    ASSERT_GE(found.size(), 2u);
    EXPECT_EQ(found[0]["reason"], wanted[0]["reason"]);
    EXPECT_EQ(found[0]["end"], wanted[0]["end"]);
    EXPECT_NEAR(found[0]["load"].get<double>(), wanted[0]["load"].get<double>(),
                1e-8 * wanted[0]["load"].get<double>());
    EXPECT_LT(found[0]["iterations"].get<double>(), 1.5 * wanted[0]["iterations"].get<double>());
    EXPECT_NE(file_text(run + "/run.log").find("parallel multigrid"), std::string::npos);
  }
  // Runs that end within a phase, by their duration or by a guard, which the first rank alone sees.
  const std::string by_all = "run scene.json -n 2 --set /time/static_solver=parallel_multigrid ";
  const Outcome ended = run_ligament(by_all + "--set /time/duration=100 -o ended");
  ASSERT_EQ(ended.code, 0) << ended.errors;
  EXPECT_EQ(file_json("ended/run.json")["phases"].size(), 1u);
  const Outcome stopped = run_ligament(by_all + "--set /coupling/guard=stop --set "
                                                "/specimen/cracks=[] --set /gauges=[] -o stopped");
  EXPECT_EQ(stopped.code, 3) << stopped.errors;
  EXPECT_EQ(file_json("stopped/run.json")["status"], "stopped");
}

/// Steps of the states that a run keeps, which lie between two equilibria here.
std::vector<long> kept_steps(const std::string &run)
{
  std::vector<long> steps;
  for (const auto &entry : fs::directory_iterator(run + "/checkpoints"))
    if (fs::exists(entry.path() / "manifest.json"))
      steps.push_back(file_json((entry.path() / "manifest.json").string())["step"]);
  std::sort(steps.begin(), steps.end());
  return steps;
}

// Faces that tear from equilibrium to equilibrium: the first rank seeks them, and what it has between
// two of them is a state of the run as any other.
TEST_F(RanksCoupled, KeepsStatesBetweenEquilibriaAndGoesOnFromThem)
{
  Json scene = scene_of(2, "square", {12, 6});
  scene["specimen"]["cracks"] = {{{"points", {{-7, 0}, {-2, 0}}}}};
  scene["material"]["poissons_ratio"] = 0;
  scene["material"]["fracture"]["strength"] = 1e-3;
  scene["material"]["fracture"]["energy"] = 1e-4;
  scene["time"] = {{"duration", 2000}, {"loading", "static"}};
  scene["damping"] = {{"mass", 0.02}};
  scene["loads"] = {{{"boundary", "top"}, {"velocity", {0, 1e-4}}},
                    {{"boundary", "bottom"}, {"velocity", {0, -1e-4}}}};
  scene["output"]["history_interval"] = 20;
  expect_the_same_on({2}, scene, 1);
  EXPECT_EQ(kept_steps("on_2"), kept_steps("on_1"));
  for (const int n : {1, 2, 3}) {
    const std::string run = fmt::format("from_between_on_{}", n);
    fs::copy("on_1", run, fs::copy_options::recursive);
    fs::remove_all(newest_checkpoint(run));
    Json record = Json::parse(file_text(run + "/run.json"));
    record["status"] = "running";
    written(record, run + "/run.json");
    const Outcome more = run_ligament(fmt::format("resume {} -n {}", run, n));
    EXPECT_EQ(more.code, 0) << more.errors;
    expect_same_body(run, "on_1");
  }
}

/// Faces soften over some spacings.
Json softening(Json scene)
{
  Json &fracture = scene["material"]["fracture"];
  const double strength = fracture["strength"];
  fracture["energy"] = 4 * strength * strength;
  return scene;
}

Json cohesive_with_steps()
{
  return softening(turned_with_steps());
}
Json cohesive_through_the_overlap()
{
  return softening(crack_through_the_overlap());
}
Json cohesive_block()
{
  return softening(block_with_a_crack());
}
Json calm_until_it_softens()
{
  Json scene = softening(calm_until_it_breaks());
  scene["time"]["duration"] = 500;
  return scene;
}

TEST_F(RanksCoupled, ACohesiveCrackWithStepsOfTheMesh)
{
  expect_the_same_on({4}, cohesive_with_steps(), 10);
}
TEST_F(RanksCoupled, ACohesiveCrackThroughTheOverlap)
{
  expect_the_same_on({3}, cohesive_through_the_overlap(), 10);
}
TEST_F(RanksCoupled, ACohesiveBlock)
{
  expect_the_same_on({2}, cohesive_block(), 5);
}
TEST_F(RanksCoupled, FromEquilibriumToEquilibriumWhereFacesSoften)
{
  expect_the_same_on({3}, calm_until_it_softens(), 5);
}
TEST_F(RanksCoupled, CutAnewWhereFacesSoften)
{
  expect_the_same_when_cut_anew(3, cohesive_with_steps(), 20, 10);
}

// `check` warns of branches and ramps by the duration.
TEST_F(RanksCoupled, GoOnWhereItFlowsAndCreeps)
{
  Json scene = crack_that_flows_and_creeps();
  scene["material"]["viscosity"].erase("branches");
  for (Json &load : scene["loads"])
    load["ramp"] = 30;
  expect_to_go_on(scene, 2);
}

TEST_F(RanksCoupled, GoOnOnAnotherNumber)
{
  expect_to_go_on(turned_with_steps(), 2);
}

TEST_F(RanksCoupled, SlowAllOnAnyNumber)
{
  for (const Json &scene :
       {closed_zone(), crack_through_the_overlap(), turned_with_steps(), bent_strip(),
        turning_strip(), two_zones(), block_with_a_crack(), bar_that_rests(), cohesive_with_steps(),
        cohesive_through_the_overlap(), cohesive_block(), waist_that_flows(),
        crack_that_flows_and_creeps(), block_that_flows()})
  {
    fs::remove_all("on_1");
    expect_the_same_on({2, 3, 4}, scene, 0);
  }
}

TEST_F(RanksCoupled, SlowGoOnWhereTheStripBends)
{
  expect_to_go_on(bent_strip(), 4);
}

TEST_F(RanksCoupled, SlowGoOnWhereFacesSoften)
{
  expect_to_go_on(cohesive_with_steps(), 3);
}

TEST_F(RanksCoupled, SlowGoOnWhereItFlows)
{
  expect_to_go_on(waist_that_flows(), 4);
}

TEST_F(RanksCoupled, SlowGoOnInABlock)
{
  expect_to_go_on(block_with_a_crack(), 4);
}

TEST_F(RanksCoupled, SlowGoOnThroughTheOverlap)
{
  expect_to_go_on(crack_through_the_overlap(), 3);
}
} // namespace
