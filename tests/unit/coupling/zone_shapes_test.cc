// Overlaps of zones that are several boxes.
#include "tests/support/coupled_bodies.h"

#include <gtest/gtest.h>

namespace ligament
{
namespace
{
using namespace tests;
using Zone2 = core::BoxUnion<2>;

const Zone2 l_shape{{{{-32, -30}, {31, 1}}, {{-32, -30}, {0, 30}}}};
const Zone2 apart{{{{-40, -15}, {-7, 15}}, {{6, -15}, {40, 15}}}};

TEST(BoxUnion, DistanceIsThatOfTheLargestCube)
{
  EXPECT_DOUBLE_EQ(l_shape.distance({-10, -10}), 11); // to the re-entrant corner: max(10, 11)
  EXPECT_DOUBLE_EQ(l_shape.distance({20, -20}), 10);  // a convex side: min
  EXPECT_DOUBLE_EQ(l_shape.distance({-20, 10}), 12);
  EXPECT_DOUBLE_EQ(l_shape.distance({5, 5}), -4); // outside
  EXPECT_EQ(l_shape.eroded(3).boxes.size(), 2u);
  EXPECT_TRUE(l_shape.eroded(16).boxes.empty());
  EXPECT_EQ(apart.eroded(3).boxes.size(), 2u);
}

// The same L in boxes that only touch: their common side is no edge.
TEST(BoxUnion, TouchingBoxesAreOnePiece)
{
  const Zone2 touching{{{{0, -30}, {31, 1}}, {{-32, -30}, {0, 30}}}};
  for (double x = -40; x <= 40; x += 2.5)
    for (double y = -40; y <= 40; y += 2.5)
      EXPECT_DOUBLE_EQ(touching.distance({x, y}), l_shape.distance({x, y})) << x << " " << y;
  EXPECT_DOUBLE_EQ(touching.distance({0, -15}), 15); // on the common side
  EXPECT_TRUE(touching.covers({-10, -20}, {10, 0}, 1e-9));
  EXPECT_FALSE(touching.covers({-10, -20}, {10, 2}, 1e-9)); // around the corner
}

void check_patch(const Zone2 &zone, const Vector<2> &size)
{
  CoupledBodiesParameters<2> p;
  p.material.poissons_ratio = 0.3;
  p.size = size;
  p.zone = zone;
  p.cell_size = 3.1;
  p.transition_cells = 2;
  const auto body = make_coupled_bodies(p);
  const auto &report = body.split->report();
  EXPECT_LT(report.patch_residual, 1e-13);
  EXPECT_LT(report.patch_modulus, 0.02);
}

TEST(ZoneShapes, PatchFitOfAnLShape)
{
  check_patch(l_shape, {100, 96});
}
TEST(ZoneShapes, PatchFitOfTwoZones)
{
  check_patch(apart, {106, 60});
}
} // namespace
} // namespace ligament
