// Sizes from volumes: formulas of simple shapes, and what the examples were measured to have.
#include "src/scene/read_scene.h"
#include "src/scene/size_estimate.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace ligament::program;

namespace
{
const std::string bar = R"({
  "dimension": 2, "specimen": {"size": [0.1, 0.4],
    "holes": [{"centre": [0, 0], "radius": 0.02}], "notches": [{"lower": [-0.05, -0.01], "upper": [-0.04, 0.01]}]},
  "material": {"youngs_modulus": "72 GPa", "poissons_ratio": 0.22, "density": 2450},
  "discrete_zone": {"region": {"lower": [null, -0.1], "upper": [null, 0.1]}, "packing": "square", "spacing": "1 mm"},
  "far_field": {"cell_size": "5 mm"}, "coupling": {"overlap_cells": 3}, "time": {"duration": "1 us"}})";

SizeEstimate estimate(const std::string &text, double cell_volume,
                      const std::vector<std::string> &overrides = {})
{
  const ReadResult result = parse_scene(text, "scene", overrides);
  EXPECT_TRUE(result.scene) << to_string(result.errors.at(0));
  return estimate_size(*result.scene, cell_volume);
}

// 2e5 points that are more even than random ones: boundaries of length L are missed by a few points
// of the spacing 1/sqrt(2e5).
constexpr double few_points = 0.01;
} // namespace

TEST(SizeEstimate, FollowsFromVolumes)
{
  const double d2 = 1e-6, voids = M_PI * 0.02 * 0.02 + 0.01 * 0.02;
  const SizeEstimate size = estimate(bar, d2);
  EXPECT_NEAR(size.particles, (0.1 * 0.2 - voids) / d2, few_points * 0.02 / d2);
  EXPECT_NEAR(size.overlap_particles, 2 * 0.1 * 0.015 / d2, few_points * 0.003 / d2);
  EXPECT_NEAR(size.equivalent_particles, (0.1 * 0.4 - voids) / d2, few_points * 0.04 / d2);
  EXPECT_NEAR(size.cells, 0.1 * (0.2 + 2 * 0.015) / 25e-6, few_points * 920);
  const SizeEstimate pure = estimate(bar, d2, {"/far_field=none"});
  EXPECT_NEAR(pure.particles, size.equivalent_particles, few_points * 0.04 / d2);
  EXPECT_EQ(pure.cells, 0);
  EXPECT_EQ(pure.overlap_particles, 0);
  const SizeEstimate mesh = estimate(bar, 1, {"/discrete_zone=none"});
  EXPECT_EQ(mesh.particles, 0);
  EXPECT_NEAR(mesh.cells, (0.04 - voids) / 25e-6, few_points * 1600);
}

// Its README and the first page of the project have 12 800 particles and 1 480 cells, which grow
// twice.
TEST(SizeEstimate, IsNearToWhatIsBuilt)
{
  const ReadResult result = read_scene(LIGAMENT_SOURCE_DIR "/examples/cracked_plate/fast.json");
  ASSERT_TRUE(result.scene);
  const double d = result.scene->zone.spacing;
  const SizeEstimate size = estimate_size(*result.scene, std::sqrt(0.75) * d * d);
  EXPECT_NEAR(size.particles, 12800, 0.03 * 12800);
  EXPECT_NEAR(size.equivalent_particles, 147802, 0.01 * 147802);
  EXPECT_NEAR(size.cells, 1480, 0.2 * 1480);
}
