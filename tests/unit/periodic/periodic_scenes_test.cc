// Scenes whose bodies repeat themselves, from the file to the history: their stiffness, their
// ledger, and that a body built anew goes on to the bit.
#include "core/extremes.h"
#include "src/output/history.h"
#include "src/scene/read_scene.h"
#include "src/simulation/coupled_body.h"
#include "src/simulation/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace ligament::program
{
namespace
{
const std::string porous = LIGAMENT_SOURCE_DIR "/tests/support/scenes/periodic.json";

Scene scene_of(const std::vector<std::string> &overrides)
{
  ReadResult result = read_scene(porous, overrides);
  for (const auto &error : result.errors)
    ADD_FAILURE() << core::to_string(error);
  return *result.scene;
}

RunRecord run(const std::string &folder, const std::vector<std::string> &overrides,
              int rebuild_interval = 0)
{
  const RunFolder place{folder};
  std::filesystem::remove_all(folder);
  place.create();
  std::FILE *quiet = std::fopen("/dev/null", "w");
  Simulation<2> simulation(scene_of(overrides), place, quiet, false);
  simulation.rebuild_every(rebuild_interval);
  const RunRecord record = simulation.run();
  std::fclose(quiet);
  return record;
}

std::string text_of(const std::string &file)
{
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

using Overrides = std::vector<std::string>;

const Overrides solid = {"/specimen/holes=[]", "/time/duration=\"60 us\""},
                slow = {"/loads/0/ramp=\"50 us\"", "/damping/mass=2e5"},
                mesh = {"/discrete_zone=\"none\"", "/far_field={\"cell_size\": \"2 mm\"}"},
                coupled = {"/specimen/size=[0.13, 0.12]",
                           "/discrete_zone/packing=random",
                           "/discrete_zone/spacing=\"1 mm\"",
                           R"(/discrete_zone/region={"lower": [-0.027, -0.026],
                                                     "upper": [0.025, 0.027]})",
                           "/discrete_zone/extent=box",
                           R"(/far_field={"cell_size": "4 mm"})"};

const Overrides slower = {"/time/duration=\"240 us\"", // of a body that is three times as large
                          "/loads/0/ramp=\"200 us\"", "/damping/mass=6e4"};

Overrides operator+(Overrides a, const Overrides &b)
{
  a.insert(a.end(), b.begin(), b.end());
  return a;
}
} // namespace

// A strain of 2e-4 across y: G times it, in particles and mesh.
TEST(PeriodicScenes, AJumpAcrossSolidBodiesGivesTheShearModulus)
{
  const double stress = 72e9 / (2 * 1.22) * 2e-4;
  for (const Overrides &model :
       {Overrides{}, Overrides{"/discrete_zone/packing=random"}, mesh, coupled + slower})
  {
    const RunRecord record = run("periodic_solid", solid + slow + model);
    EXPECT_EQ(record.status, "done") << record.reason;
    ASSERT_TRUE(record.largest_stress);
    EXPECT_NEAR(*record.largest_stress / stress, 1, 0.02); // what still swings
    EXPECT_LT(std::abs(record.energy_residual.value_or(1)), 1e-5);
  }
}

// A crack runs through pores on the seam.
TEST(PeriodicScenes, ABreakingBodyThatIsBuiltAnewGoesOnToTheBit)
{
  const Overrides breaking = {"/time/duration=\"40 us\"",
                              "/loads/0/ramp=\"30 us\"",
                              "/loads/0/strain=[4e-3, 2e-3]",
                              "/discrete_zone/packing=random",
                              "/discrete_zone/spacing=\"0.8 mm\"",
                              "/material/friction=0.3",
                              "/material/fracture={\"criterion\": \"maximum_tension\", "
                              "\"strength\": \"50 MPa\"}"};
  const RunRecord whole = run("periodic_whole", breaking),
                  anew = run("periodic_anew", breaking, 150);
  EXPECT_GT(whole.broken_bonds, 50);
  EXPECT_EQ(whole.broken_bonds, anew.broken_bonds);
  EXPECT_EQ(text_of("periodic_whole/history.csv"), text_of("periodic_anew/history.csv"));
  EXPECT_LT(std::abs(whole.energy_residual.value_or(1)), 1e-2);
}

// The far field is joined around a zone that keeps off the sides.
TEST(PeriodicScenes, ACoupledBodyTakesAHomogeneousStrainAtRest)
{
  const double size = 1e-12; // its square is below rounding: the law is linear
  const Scene scene =
      scene_of(coupled + Overrides{"/specimen/holes=[]",
                                   R"(/loads=[{"periodic": "x", "strain": [1e-12, -0.5e-12]},
                                              {"periodic": "y", "strain": [-0.5e-12, 2e-12]}])"});
  core::Log log;
  core::Timers timers;
  auto body = make_body<2>(scene, log, timers);
  Eigen::Matrix2d gradient;
  gradient << 1, -0.5, -0.5, 2;
  gradient *= size;
  auto &zone = body.zone->state;
  for (int i = 0; i < zone.size(); ++i)
    set(zone.displacement, i, Vector<2>(gradient * get(zone.reference, i)));
  for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
    set(body.far->displacement, i, Vector<2>(gradient * body.far->mesh().nodes[i]));
  auto bodies = body.bodies();
  coupling::StepTime step{0, 0, body.dt};
  body.coupler->compute_forces(bodies, step);
  body.coupler->kick(bodies, step);
  // What a step would move, over what waves of this strain move.
  const double speed = size * body.force()->elastic_constants().wave_speed_p;
  double largest = 0;
  for (int i = 0; i < zone.size(); ++i)
    keep_largest(largest, get(zone.velocity, i).norm());
  for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
    keep_largest(largest, get(body.far->velocity, i).norm());
  EXPECT_LT(largest, 1e-10 * speed);
  const double stress = 72e9 / (1.22 * 0.56) * (0.78 * 1 + 0.22 * 2) * size, height = 0.12;
  EXPECT_NEAR(body.far->reaction(0)[0], stress * height, 1e-9 * stress * height);
}

// The mesh goes on through the joined sides, the crystal inside it ends as it would in a body with sides.
TEST(PeriodicScenes, ACrystalKeepsOffJoinedSides)
{
  core::Log log;
  core::Timers timers; // the couplers keep them
  const auto body_of = [&](const std::vector<std::string> &set) {
    const auto read = parse_scene(R"({
      "dimension": 2,
      "specimen": {"size": ["37 nm", "36 nm"], "thickness": "0.38 nm"},
      "atoms": {"potential": "lennard_jones", "energy": "0.0104 eV", "distance": "3.4 angstrom",
                "mass": "39.95 u"},
      "discrete_zone": {"packing": "hexagonal",
                        "region": {"lower": ["-10 nm", "-10 nm"], "upper": ["10 nm", "10 nm"]}},
      "far_field": {"cell_size": "1 nm"},
      "coupling": {"overlap_cells": 5, "transition_cells": 3},
      "time": {"duration": "20 ps", "step_fraction": 0.2}
    })",
                                  "crystal.json", set);
    for (const auto &error : read.errors)
      ADD_FAILURE() << core::to_string(error);
    return make_body<2>(*read.scene, log, timers);
  };
  auto joined = body_of({R"(/specimen/periodic=["x"])"}), sided = body_of({});
  const auto &zone = joined.zone->state;
  ASSERT_EQ(zone.size(), sided.zone->state.size());
  auto bodies = joined.bodies();
  coupling::StepTime step{0, 0, joined.dt};
  joined.coupler->compute_forces(bodies, step);
  joined.coupler->kick(bodies, step);
  double largest = 0;
  for (int i = 0; i < zone.size(); ++i) {
    EXPECT_EQ(zone.global_id[i], sided.zone->state.global_id[i]);
    keep_largest(largest, get(zone.velocity, i).norm());
  }
  EXPECT_LT(largest, 1e-10 * joined.force()->elastic_constants().wave_speed_p);
}
} // namespace ligament::program
