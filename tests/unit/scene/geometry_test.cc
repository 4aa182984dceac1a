#include "src/scene/geometry.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace ligament::program;

namespace
{
const Box unit{{0, 0, 0}, {1, 1, 1}};
}

TEST(Geometry, ClipOfASegment)
{
  EXPECT_DOUBLE_EQ(diameter(clip({{-1, 0.5, 0}, {2, 0.5, 0}}, unit, 2)), 1);
  EXPECT_DOUBLE_EQ(diameter(clip({{0.25, 0.5, 0}, {0.75, 0.5, 0}}, unit, 2)), 0.5);
  // Cuts the corner (1, 1) between (0.5, 1) and (1, 0.5).
  EXPECT_DOUBLE_EQ(diameter(clip({{0, 1.5, 0}, {1.5, 0, 0}}, unit, 2)), std::sqrt(0.5));
  EXPECT_TRUE(clip({{0, 2.5, 0}, {2.5, 0, 0}}, unit, 2).empty()); // passes beside it
  EXPECT_TRUE(clip({{-1, 2, 0}, {2, 2, 0}}, unit, 2).empty());
}

TEST(Geometry, ClipOfAPolygon)
{
  const std::vector<Point> square = {{-1, -1, 0.5}, {3, -1, 0.5}, {3, 3, 0.5}, {-1, 3, 0.5}};
  EXPECT_DOUBLE_EQ(polygon_area(square), 16);
  EXPECT_DOUBLE_EQ(polygon_area(clip(square, unit, 3)), 1);
  // The plane x + y + z = 1.5 cuts the unit cube in a regular hexagon of side 1/sqrt(2).
  const std::vector<Point> plane = {{4.5, -1.5, -1.5}, {-1.5, 4.5, -1.5}, {-1.5, -1.5, 4.5}};
  EXPECT_NEAR(polygon_area(clip(plane, unit, 3)), 1.5 * std::sqrt(3.0) * 0.5, 1e-14);
}

TEST(Geometry, PlaneAndConvex)
{
  const std::vector<Point> square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_TRUE(is_plane(square) && is_convex(square));
  EXPECT_FALSE(is_plane({{0, 0, 0}, {1, 0, 0}, {1, 1, 0.1}, {0, 1, 0}}));
  EXPECT_FALSE(is_convex({{0, 0, 0}, {1, 0, 0}, {0.2, 0.2, 0}, {0, 1, 0}}));
}
