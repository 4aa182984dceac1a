// Scenes whose particles are atoms: what follows from the crystal, and that reading again what was
// read gives the same.
#include "md/analytic.h"
#include "md/atomic_units.h"
#include "src/scene/atoms.h"
#include "src/scene/read_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

namespace ligament::program
{
namespace
{
const std::string solid = R"({
  "dimension": 3,
  "specimen": {"size": ["20 nm", "20 nm", "1.9 nm"], "periodic": ["z"]},
  "atoms": {"potential": "zhou", "species": "Fe", "along_x": [1, 1, 0], "along_y": [-1, 1, 0]},
  "time": {"duration": "1 ps"}
})";

std::string crystal_scene()
{
  std::ifstream file(LIGAMENT_SOURCE_DIR "/tests/support/scenes/crystal.json");
  EXPECT_TRUE(file);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

ReadResult read(const std::string &text, const std::vector<std::string> &set = {})
{
  ReadResult result = parse_scene(text, "scene.json", set);
  for (const auto &error : result.errors)
    ADD_FAILURE() << core::to_string(error);
  return result;
}
} // namespace

TEST(AtomScenes, SpacingAndMaterialFollowFromThePotential)
{
  const std::string text = crystal_scene();
  const Scene scene = *read(text).scene;
  const md::Crystal<2> crystal(
      md::lennard_jones({"A", 39.95 * md::atomic_mass_unit}, 0.0104 * md::electron_volt, 3.4e-10),
      {md::CrystalKind::triangular, 0, md::Matrix<2>::Identity(), 0.38e-9});
  const auto constants = crystal.elastic_constants();
  EXPECT_NEAR(scene.zone.spacing / crystal.spacing(), 1, 1e-14);
  EXPECT_NEAR(scene.material.density / constants.density, 1, 1e-14);
  EXPECT_NEAR(scene.material.youngs_modulus / constants.youngs_modulus, 1, 1e-12);
  // Pairs on a triangular lattice: Cauchy's relation, lambda = mu.
  EXPECT_NEAR(scene.material.poissons_ratio, 0.25, 1e-12);
  EXPECT_EQ(crystal_of<2>(scene).spacing(), scene.zone.spacing);
}

TEST(AtomScenes, WhatWasReadIsReadAgain)
{
  const std::string with_packing = R"({"extent": "all", "packing": "bcc"})";
  const ReadResult first = read(solid, {"/discrete_zone=" + with_packing});
  const ReadResult again = read(first.resolved.dump());
  EXPECT_EQ(again.resolved, first.resolved);
  EXPECT_EQ(again.scene->zone.spacing, first.scene->zone.spacing);
  EXPECT_EQ(again.scene->specimen.size, first.scene->specimen.size);
}

// [001] lies along z: its period is the lattice parameter; 1.9 nm are 6.6 of them.
TEST(AtomScenes, PeriodicSidesAreWholePeriodsOfTheLattice)
{
  const Scene scene = *read(solid, {R"(/discrete_zone={"extent": "all", "packing": "bcc"})"}).scene;
  const double a = crystal_of<3>(scene).lattice_parameter();
  EXPECT_NEAR(scene.specimen.size[2] / a, 7, 1e-12);
  EXPECT_EQ(scene.specimen.size[0], 20e-9);
}

// What reaches to such a side moves with it.
TEST(AtomScenes, LoadsFollowSidesThatAreMoved)
{
  const Scene scene =
      *read(crystal_scene(),
            {R"(/specimen/periodic=["y"])",
             R"(/discrete_zone={"extent": "all", "packing": "hexagonal"})", "/far_field=none",
             R"(/loads=[{"boundary": "right", "traction": ["1 MPa", null], "from": "-30 nm",
                         "to": "30 nm"}])"})
           .scene;
  const double size = scene.specimen.size[1];
  EXPECT_GT(std::abs(size - 60e-9), 1e-12);
  EXPECT_NEAR(*scene.loads[0].to - *scene.loads[0].from, size, 1e-15);
}

TEST(AtomScenes, UnitsOfAtoms)
{
  const std::string text = crystal_scene();
  const Scene scene =
      *read(text, {"/atoms/energy=\"10.4 meV\"", "/atoms/distance=\"340 pm\""}).scene;
  EXPECT_NEAR(scene.atoms->energy / (0.0104 * md::electron_volt), 1, 1e-14);
  EXPECT_NEAR(scene.atoms->distance / 3.4e-10, 1, 1e-14);
  EXPECT_NEAR(scene.atoms->mass / (39.95 * md::atomic_mass_unit), 1, 1e-14);
}
} // namespace ligament::program
