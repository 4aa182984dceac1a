// Runs on several ranks: byte for byte what one process writes, also where they go on on other
// numbers of ranks. Through the programs.
#include "src/output/vtk_reader.h"
#include "tests/support/rank_runs.h"

using namespace ligament;
using namespace ligament::tests;

namespace
{
class RanksProgram : public OnRanks
{
};

/// Rows lie along the crack, and so do the seams.
Json crack_along_the_seam()
{
  Json scene = scene_of(2, "hexagonal", {40, 60});
  scene["specimen"]["cracks"] = {{{"points", {{-8, 0}, {8, 0}}}}};
  pull(scene, 1, 1, 4e-4);
  return scene;
}

/// The crack runs across the seams, its flanks slide along each other.
Json crack_across_the_seam()
{
  Json scene = scene_of(2, "hexagonal", {30, 40});
  scene["discrete_zone"]["orientation"] = 20;
  scene["specimen"]["cracks"] = {{{"points", {{2, -12}, {-2, 14}}}}};
  pull(scene, 0, 1, 2e-3);
  scene["damping"] = {{"mass", 1e-3}, {"local", 0.05}};
  scene["time"]["duration"] = 120;
  return scene;
}

/// Drawn at one side; the mean of the other one, which is free, is that of all ranks.
Json square_with_a_hole()
{
  Json scene = scene_of(2, "square", {30, 40});
  scene["specimen"]["holes"] = {{{"centre", {3, -2}}, {"radius", 6}}};
  scene["loads"] = {{{"boundary", "right"}, {"velocity", {4e-3, nullptr}}, {"ramp", 10}}};
  return scene;
}

/// Pieces meet others that they never touched; bonds break by the stresses of both particles.
Json random_that_is_crushed()
{
  Json scene = scene_of(2, "random", {20, 30});
  scene["material"]["fracture"] = {{"criterion", "principal_stress"}, {"strength", 1e-3}};
  scene["specimen"]["notches"] = {{{"lower", {-10, -1}}, {"upper", {-5, 1}}}};
  pull(scene, 1, 1, -8e-3, 10);
  scene["time"]["duration"] = 200;
  return scene;
}

/// Radii are healed, seeds kept off surfaces; a cut with a blunt end.
Json random_of_unequal_sizes()
{
  Json scene = scene_of(2, "random", {28, 36});
  scene["discrete_zone"]["size_ratio"] = 4;
  scene["specimen"]["holes"] = {{{"centre", {6, -4}}, {"radius", 3}}};
  scene["specimen"]["notches"] = {{{"lower", {-15, 3}}, {"upper", {-8, 5}}}};
  scene["specimen"]["cracks"] = {{{"points", {{-4, -9}, {2, -7}}}}};
  pull(scene, 1, 1, 2e-3, 20);
  scene["time"]["duration"] = 80;
  return scene;
}

Json fcc_with_a_crack()
{
  Json scene = scene_of(3, "fcc", {12, 10, 14});
  scene["specimen"]["cracks"] = {
      {{"points", {{-6.5, 0.3, -8}, {0, 0.3, -8}, {0, 0.3, 8}, {-6.5, 0.3, 8}}}}};
  pull(scene, 1, 1, 3e-3, 10);
  scene["time"]["duration"] = 60;
  return scene;
}

Json random_in_space()
{
  Json scene = scene_of(3, "random", {8, 8, 12});
  pull(scene, 2, 2, 2e-3);
  scene["time"]["duration"] = 60;
  return scene;
}

/// Most of a long bar rests until the wave arrives.
Json bar_that_rests()
{
  Json scene = scene_of(2, "hexagonal", {16, 160});
  scene["loads"] = {{{"boundary", "top"}, {"velocity", {nullptr, 4e-3}}, {"ramp", 10}}};
  scene["time"]["duration"] = 100;
  return scene;
}

/// Faces soften over so many spacings, E G_c/f_t^2.
Json softening(Json scene, double lengths)
{
  Json &fracture = scene["material"]["fracture"];
  const double strength = fracture["strength"];
  fracture["energy"] = lengths * strength * strength;
  return scene;
}

Json cohesive_crack_along_the_seam()
{
  return softening(crack_along_the_seam(), 4);
}
Json cohesive_crack_across_the_seam()
{
  return softening(crack_across_the_seam(), 3);
}

/// From a notch, in two straight lines of softening, strengths that scatter.
Json cohesive_random()
{
  Json scene = softening(scene_of(2, "random", {24, 30}), 4);
  scene["material"]["fracture"]["softening"] = "bilinear";
  scene["specimen"]["notches"] = {{{"lower", {-13, -1}}, {"upper", {-6, 1}}}};
  pull(scene, 1, 1, 1e-3, 10);
  scene["time"]["duration"] = 110;
  return scene;
}

Json cohesive_fcc()
{
  Json scene = softening(fcc_with_a_crack(), 2);
  scene["time"]["duration"] = 35;
  return scene;
}

/// Cracks run at a tenth of the velocity of shear waves.
Json slow_cracks()
{
  Json scene = crack_across_the_seam();
  scene["material"]["fracture"]["crack_velocity"] = 0.06;
  return scene;
}

/// Flows around the crack, and breaks there.
Json crack_that_flows()
{
  Json scene = crack_across_the_seam();
  let_flow(scene, 2e-3);
  scene["material"]["fracture"]["strength"] = 4e-3;
  scene["plane"] = "stress";
  scene["gauges"] = {{{"name", "e"}, {"kind", "strain"}, {"lower", {-6, -8}}, {"upper", {6, 8}}},
                     {{"name", "s"}, {"kind", "stress"}, {"lower", {-6, -8}}, {"upper", {6, 8}}}};
  return scene;
}

/// A granular cone that softens, and creeps below it; bonds break by the stresses of both
/// particles.
Json fcc_that_flows_and_creeps()
{
  Json scene = fcc_with_a_crack();
  scene["material"]["plasticity"] = {{"law", "drucker_prager"},
                                     {"cohesion", 2e-3},
                                     {"friction_angle", "25 deg"},
                                     {"dilatancy_angle", "10 deg"}};
  let_creep(scene);
  scene["material"]["fracture"] = {{"criterion", "principal_stress"}, {"strength", 2e-3}};
  scene["time"]["duration"] = 30;
  return scene;
}

Json random_that_flows()
{
  Json scene = random_that_is_crushed();
  let_flow(scene, 2e-3);
  return scene;
}

TEST_F(RanksProgram, HexagonalWithACrackAlongTheSeam)
{
  expect_the_same_on({2, 4}, crack_along_the_seam(), 20);
}
TEST_F(RanksProgram, HexagonalTurnedWithACrackAcrossTheSeam)
{
  expect_the_same_on({2, 3}, crack_across_the_seam(), 20);
}
TEST_F(RanksProgram, SquareWithAHole)
{
  expect_the_same_on({3}, square_with_a_hole(), 10);
}
TEST_F(RanksProgram, RandomThatIsCrushed)
{
  expect_the_same_on({2}, random_that_is_crushed(), 50);
}
TEST_F(RanksProgram, RandomOfUnequalSizes)
{
  expect_the_same_on({2, 3}, random_of_unequal_sizes(), 10);
  // Relaxed by all together, and kept.
  const std::string reference = "/checkpoints/reference.bin";
  EXPECT_FALSE(file_text("on_1" + reference).empty());
  for (const std::string run : {"on_2", "on_3"})
    EXPECT_TRUE(file_text(run + reference) == file_text("on_1" + reference)) << run;
}
TEST_F(RanksProgram, GoOnInARandomPacking)
{
  Json scene = random_of_unequal_sizes();
  scene["time"]["duration"] = 40;
  expect_to_go_on(scene, 2);
}
TEST_F(RanksProgram, FccWithACrack)
{
  expect_the_same_on({2}, fcc_with_a_crack(), 10);
}
TEST_F(RanksProgram, RandomInSpace)
{
  expect_the_same_on({3}, random_in_space(), 10);
}
// Fewer blocks of particles than ranks.
TEST_F(RanksProgram, RanksWithoutParticles)
{
  Json plate = scene_of(2, "hexagonal", {10, 10});
  plate["specimen"]["cracks"] = {{{"points", {{-6, 0}, {0, 0}}}}};
  pull(plate, 1, 1, 2e-3, 10);
  plate["time"]["duration"] = 60;
  expect_the_same_on({3, 4}, plate, 1);
  ASSERT_EQ(run_ligament("run scene.json -n 3 --pieces -o pieces").code, 0);
  EXPECT_EQ(results("pieces")["broken_bonds.csv"], results("on_1")["broken_bonds.csv"]);
  for (const auto &entry : fs::directory_iterator("pieces/fields"))
    if (entry.path().extension() == ".pvtp")
      program::read_particles_pvtp(entry.path());
}
/// What rests before a new cut rests after it; what its flanks touch is woken.
TEST_F(RanksProgram, ABarThatRestsCutAnew)
{
  Json scene = bar_that_rests();
  scene["specimen"]["cracks"] = {{{"points", {{-3, 70}, {9, 66}}}}};
  expect_the_same_when_cut_anew(3, scene, 20, 5);
  const auto share = [](const std::string &run) -> double {
    return file_json(run + "/run.json")["figures"]["share_at_rest"]["value"];
  };
  EXPECT_GT(share("cut_anew"), share("on_1") / 3);
}
TEST_F(RanksProgram, ABarThatRests)
{
  expect_the_same_on({2}, bar_that_rests(), 5);
  EXPECT_GT(file_json("on_1/run.json")["figures"]["share_at_rest"]["value"], 0.2);
  EXPECT_GT(file_json("on_2/run.json")["figures"]["share_at_rest"]["value"], 0.2);
}

TEST_F(RanksProgram, ACohesiveCrackAlongTheSeam)
{
  expect_the_same_on({4}, cohesive_crack_along_the_seam(), 10);
}
TEST_F(RanksProgram, ACohesiveCrackAcrossTheSeam)
{
  expect_the_same_on({3}, cohesive_crack_across_the_seam(), 10);
}
TEST_F(RanksProgram, ACohesiveCrackFromANotchOfARandomPacking)
{
  expect_the_same_on({2}, cohesive_random(), 10);
}
TEST_F(RanksProgram, CohesiveFcc)
{
  expect_the_same_on({2}, cohesive_fcc(), 2);
}
TEST_F(RanksProgram, SlowCracks)
{
  expect_the_same_on({3}, slow_cracks(), 10);
}

TEST_F(RanksProgram, CutAnewWhereFacesSoften)
{
  expect_the_same_when_cut_anew(3, cohesive_crack_across_the_seam(), 60, 10);
}
TEST_F(RanksProgram, ACrackThatFlows)
{
  expect_the_same_on({3}, crack_that_flows(), 10);
  EXPECT_GT(last_in_history("on_1", "plastic_heat"), 0);
}
TEST_F(RanksProgram, FccThatFlowsAndCreeps)
{
  expect_the_same_on({2}, fcc_that_flows_and_creeps(), 10);
  EXPECT_GT(last_in_history("on_1", "plastic_heat"), 0);
  EXPECT_GT(last_in_history("on_1", "viscous"), 0);
}
TEST_F(RanksProgram, RandomThatFlows)
{
  expect_the_same_on({3}, random_that_flows(), 20);
  EXPECT_GT(last_in_history("on_1", "plastic_heat"), 0);
}

TEST_F(RanksProgram, CutAnewWhereItFlows)
{
  expect_the_same_when_cut_anew(3, crack_that_flows(), 60, 10);
}
TEST_F(RanksProgram, CutAnewWhereAllIsCrushed)
{
  expect_the_same_when_cut_anew(3, random_that_is_crushed(), 60, 50);
}

TEST_F(RanksProgram, SlowAllOnAnyNumber)
{
  for (const Json &scene :
       {crack_along_the_seam(), crack_across_the_seam(), square_with_a_hole(),
        random_that_is_crushed(), random_of_unequal_sizes(), fcc_with_a_crack(), random_in_space(),
        bar_that_rests(), cohesive_crack_along_the_seam(), cohesive_crack_across_the_seam(),
        cohesive_random(), cohesive_fcc(), slow_cracks(), crack_that_flows(),
        fcc_that_flows_and_creeps(), random_that_flows()})
  {
    fs::remove_all("on_1");
    expect_the_same_on({2, 3, 4}, scene, 5);
  }
}

TEST_F(RanksProgram, GoOnOnAnotherNumber)
{
  Json scene = halves_that_slide();
  scene["time"]["duration"] = 80;
  expect_to_go_on(scene, 3);
}

TEST_F(RanksProgram, GoOnWhereItFlowsAndCreeps)
{
  Json scene = crack_that_flows();
  let_creep(scene);
  scene["material"]["viscosity"].erase(
      "branches"); // `check` warns of them and of ramps by the duration
  for (Json &load : scene["loads"])
    load["ramp"] = 30;
  scene["time"]["duration"] = 80;
  expect_to_go_on(scene, 2);
}

// States of parts don't say what rests: whoever goes on wakes what has moved, and what that
// touches.
/// The same values, whatever the files are.
void expect_same_fields(const std::string &run, const std::string &reference)
{
  int n_times = 0;
  for (const auto &entry : fs::directory_iterator(reference + "/fields")) {
    const std::string name = entry.path().stem();
    if (name.compare(0, 10, "particles_") != 0)
      continue;
    ++n_times;
    const auto whole = program::read_particles_vtp(entry.path()),
               pieces = program::read_particles_pvtp(run + "/fields/" + name + ".pvtp");
    EXPECT_TRUE(pieces.reference == whole.reference) << name;
    ASSERT_EQ(pieces.fields.size(), whole.fields.size());
    for (std::size_t k = 0; k < whole.fields.size(); ++k)
      EXPECT_TRUE(pieces.fields[k].name == whole.fields[k].name &&
                  pieces.fields[k].values == whole.fields[k].values)
          << name << " " << whole.fields[k].name;
  }
  EXPECT_GT(n_times, 3);
}

// Each rank the fields of its own particles; where the run is cut anew, also behind the moment when
// the load path is gone, and goes on, too. Pictures, tables and motions are those of one process.
TEST_F(RanksProgram, FieldsInPieces)
{
  const Json scene = crack_along_the_seam();
  expect_the_same_on({}, scene, 10);
  const std::string half = std::to_string(double(scene["time"]["duration"]) / 2),
                    whole = std::to_string(double(scene["time"]["duration"]));
  ASSERT_EQ(run_ligament("run scene.json -n 3 --pieces --rebuild-interval 60 -o pieces "
                         "--set /time/duration=" +
                         half)
                .code,
            0);
  const Outcome outcome = run_ligament(
      "resume pieces -n 2 --pieces --rebuild-interval 60 --set /time/duration=" + whole);
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  expect_same_fields("pieces", "on_1");
  auto found = results("pieces"), expected = results("on_1");
  for (auto *files : {&found, &expected})
    for (auto file = files->begin(); file != files->end();)
      file = file->first.find("particles_") != std::string::npos || file->first == "fields.pvd" ||
                     file->first == "body.bin"
                 ? files->erase(file)
                 : std::next(file);
  EXPECT_GT(expected.size(), 8u);
  EXPECT_TRUE(found == expected);
  EXPECT_TRUE(last_state("pieces") == last_state("on_1"));
  EXPECT_EQ(run_ligament("report pieces").code, 0);
}

TEST_F(RanksProgram, GoOnFromABarThatRests)
{
  Json scene = bar_that_rests();
  scene["time"]["duration"] = 60;
  expect_to_go_on(scene, 2);
}

TEST_F(RanksProgram, GoOnWhereFacesSoften)
{
  expect_to_go_on(cohesive_random(), 2);
}

TEST_F(RanksProgram, SlowGoOnWhereFacesSoften)
{
  expect_to_go_on(cohesive_crack_across_the_seam(), 4);
  for (const auto &entry : fs::directory_iterator("."))
    fs::remove_all(entry.path());
  expect_to_go_on(slow_cracks(), 3);
}

TEST_F(RanksProgram, SlowGoOnOnAnyNumber)
{
  expect_to_go_on(halves_that_slide(), 4);
}

TEST_F(RanksProgram, SlowGoOnWhereItFlows)
{
  expect_to_go_on(crack_that_flows(), 4);
}
TEST_F(RanksProgram, SlowGoOnWhereItFlowsInSpace)
{
  expect_to_go_on(fcc_that_flows_and_creeps(), 4);
}

TEST_F(RanksProgram, SlowGoOnWhereAllIsCrushed)
{
  expect_to_go_on(random_that_is_crushed(), 4);
}

TEST_F(RanksProgram, SlowGoOnInSpace)
{
  expect_to_go_on(fcc_with_a_crack(), 4);
}

TEST_F(RanksProgram, WhatOneProcessMustComputeIsRefusedWithAllReasons)
{
  Json scene = scene_of(2, "hexagonal", {20, 20});
  pull(scene, 1, 1, 4e-4);
  scene["specimen"]["periodic"] = {"x"};
  scene["time"]["loading"] = "sequential";
  written(scene, "scene.json");
  for (const char *how :
       {"exec " LIGAMENT_PROGRAM " run scene.json -n 2 -o out",
        "exec mpirun -q -n 2 --oversubscribe " LIGAMENT_PROGRAM " run scene.json -o out"})
  {
    const Outcome outcome = run_shell(how);
    EXPECT_EQ(outcome.code, 2);
    for (const char *part :
         {"joined sides on several ranks", "loading bond by bond on several ranks"})
      EXPECT_NE(outcome.errors.find(part), std::string::npos) << outcome.errors;
    EXPECT_FALSE(fs::exists("out"));
  }
}

TEST_F(RanksProgram, CheckKnowsPartsAndGhosts)
{
  for (const Json &scene : {crack_along_the_seam(), fcc_with_a_crack()})
    expect_check_to_know(scene);
}
} // namespace
