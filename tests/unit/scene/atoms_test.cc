// Scenes whose particles are atoms: what follows from the crystal, and that reading again what was
// read gives the same.
#include "md/analytic.h"
#include "md/atomic_units.h"
#include "src/scene/atoms.h"
#include "src/scene/read_scene.h"

#include <fmt/format.h>
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

// What reaches to such a side moves with it; sides are known by name alone when the period is
// found.
TEST(AtomScenes, LoadsFollowSidesThatAreMoved)
{
  const auto check = [](int axis, const std::string &side, const std::string &traction) {
    const Scene scene =
        *read(crystal_scene(),
              {fmt::format(R"(/specimen/periodic=["{}"])", "xy"[axis]),
               R"(/specimen/size=["41 nm", "60 nm"])",
               R"(/discrete_zone={"extent": "all", "packing": "hexagonal"})", "/far_field=none",
               fmt::format(R"(/loads=[{{"boundary": "{}", "traction": {}, "from": "-{} nm",
                                        "to": "{} nm"}}])",
                           side, traction, axis ? "30" : "20.5", axis ? "30" : "20.5")})
             .scene;
    const double size = scene.specimen.size[axis];
    EXPECT_GT(std::abs(size - (axis ? 60e-9 : 41e-9)), 1e-12);
    EXPECT_NEAR(*scene.loads[0].to - *scene.loads[0].from, size, 1e-15);
  };
  check(1, "right", R"(["1 MPa", null])");
  check(0, "top", R"([null, "1 MPa"])");
}

// [13 12 0] is longer than 24 primitive vectors; across it the lattice repeats itself, too.
TEST(AtomScenes, PeriodsOfHighIndicesAreFound)
{
  const std::string copper = R"({
    "dimension": 3, "specimen": {"size": ["100 nm", "20 nm", "20 nm"], "periodic": ["x"]},
    "atoms": {"potential": "zhou", "species": "Cu", "along_x": [13, 12, 0], "along_y": [-12, 13, 0]},
    "discrete_zone": {"extent": "all", "packing": "fcc"}, "far_field": "none",
    "time": {"duration": "1 ps"}
  })";
  const Scene scene = *read(copper).scene;
  const double a = crystal_of<3>(scene).lattice_parameter();
  EXPECT_NEAR(scene.specimen.size[0] / (16 * std::sqrt(313.) * a), 1, 1e-9); // 13 + 12 is odd
  EXPECT_NEAR(period_along<3>(crystal_of<3>(scene), 1, 100e-9) / (std::sqrt(313.) * a), 1, 1e-9);
  EXPECT_NEAR(period_along<3>(crystal_of<3>(scene), 2, 100e-9) / a, 1, 1e-12);
}

// Two or three atoms thick: a period or two of the crystal, of which atoms see several images.
TEST(AtomScenes, JoinedSidesMayLieCloseTogether)
{
  const auto sized = [](const std::string &z) {
    return parse_scene(solid, "scene.json",
                       {R"(/discrete_zone={"extent": "all", "packing": "bcc"})",
                        R"(/specimen/size=["20 nm", "20 nm", ")" + z + R"("])"});
  };
  EXPECT_TRUE(sized("0.6 nm").scene);
  const ReadResult thin = sized("0.3 nm");
  ASSERT_EQ(thin.errors.size(), 1u);
  EXPECT_EQ(thin.errors[0].key, "/specimen/size");
  EXPECT_EQ(thin.errors[0].remedy, "make it longer");
}

TEST(AtomScenes, LatticesThatThePotentialIsNotMadeForAreDoubted)
{
  const auto warnings = [](const std::string &packing) {
    return read(solid, {R"(/discrete_zone={"extent": "all", "packing": ")" + packing + R"("})"})
        .warnings;
  };
  const auto is_of_packing = [](const core::Diagnostic &w) {
    return w.key == "/discrete_zone/packing";
  };
  const auto of_fcc = warnings("fcc"), of_bcc = warnings("bcc");
  EXPECT_EQ(std::count_if(of_fcc.begin(), of_fcc.end(), is_of_packing), 1);
  EXPECT_EQ(std::count_if(of_bcc.begin(), of_bcc.end(), is_of_packing), 0);
  const ReadResult plane = parse_scene(
      solid, "scene.json",
      {R"(/discrete_zone={"extent": "all", "packing": "fcc"})",
       R"(/atoms={"potential": "plane_crystal", "energy": 5e-19, "distance": 2.5e-10, "mass": 1e-25})"});
  ASSERT_EQ(plane.errors.size(), 1u);
  EXPECT_EQ(plane.errors[0].key, "/atoms/potential");
}

// The taper begins before a cut-off that is shorter than usual.
TEST(AtomScenes, CutOffsBelowTheUsualTaper)
{
  EXPECT_TRUE(read(crystal_scene(), {"/atoms/cutoff=\"680 pm\""}).scene); // 2 sigma
  const ReadResult wrong = parse_scene(
      crystal_scene(), "scene.json", {"/atoms/cutoff=\"680 pm\"", "/atoms/taper_begin=\"700 pm\""});
  ASSERT_EQ(wrong.errors.size(), 1u);
  EXPECT_EQ(wrong.errors[0].key, "/atoms/cutoff");
  EXPECT_NE(wrong.errors[0].message.find("from 7e-10 m to 6.8e-10 m"), std::string::npos)
      << wrong.errors[0].message;
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
