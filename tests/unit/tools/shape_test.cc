// Depth and way out of points against shapes, from their outlines alone.
#include "core/extremes.h"
#include "src/simulation/tools/make_tools.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <random>

using namespace ligament;
using namespace ligament::program;

namespace
{
/// Distance of a point from a segment.
double distance(const Vector<2> &x, const Vector<2> &a, const Vector<2> &b)
{
  const double share = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0., 1.);
  return (x - a - share * (b - a)).norm();
}

/// How often a polygon goes round a point.
bool is_inside(const Vector<2> &x, const std::vector<Vector<2>> &corners)
{
  double angle = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vector<2> a = corners[k] - x, b = corners[(k + 1) % corners.size()] - x;
    angle += std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b));
  }
  return std::abs(angle) > 3;
}

std::mt19937 generator(3);
double uniform(double from, double to)
{
  return std::uniform_real_distribution<double>(from, to)(generator);
}

TEST(ToolShape, AWedgeIsAsDeepAsItsNearestEdge)
{
  ToolParameters p;
  p.shape = ToolKind::wedge;
  p.points = {{0, -2, 0}, {-1, 1, 0}, {0.2, 1.5, 0}, {1.4, 0.6, 0}}; // clockwise
  p.orientation[0] = 0.4;
  const auto tool = make_tool<2>(p);
  std::vector<Vector<2>> corners;
  for (const Point &x : p.points)
    corners.push_back(Eigen::Rotation2Dd(0.4) * Vector<2>(x.data()));
  int n_inside = 0;
  for (int k = 0; k < 2000; ++k) {
    const Vector<2> x(uniform(-3, 3), uniform(-3, 3));
    const auto touch = tool.shape.touch(x);
    double least = 1e9;
    for (std::size_t e = 0; e < corners.size(); ++e)
      keep_smallest(least, distance(x, corners[e], corners[(e + 1) % corners.size()]));
    if (is_inside(x, corners)) {
      ++n_inside;
      EXPECT_NEAR(touch.depth, least, 1e-14);
      // Along the normal, on the outline.
      EXPECT_NEAR(tool.shape.touch(x + touch.depth * touch.normal).depth, 0, 1e-14);
    } else {
      EXPECT_LE(touch.depth, 0);
      EXPECT_LE(-touch.depth, least + 1e-14); // near points are never missed
    }
  }
  EXPECT_GT(n_inside, 100);
}

TEST(ToolShape, ACylinderLiesAlongItsAxis)
{
  ToolParameters p;
  p.shape = ToolKind::roller;
  p.radius = 2;
  p.length = 6;
  p.orientation = {0, M_PI / 2, 0}; // z to x
  const auto tool = make_tool<3>(p);
  EXPECT_NEAR(tool.shape.touch({1, 0, 1.5}).depth, 0.5, 1e-14);
  EXPECT_NEAR(tool.shape.touch({1, 0, 1.5}).normal[2], 1, 1e-14);
  EXPECT_NEAR(tool.shape.touch({-2.9, 0, 1.5}).depth, 0.1, 1e-14);
  EXPECT_NEAR(tool.shape.touch({-2.9, 0, 1.5}).normal[0], -1, 1e-14);
  EXPECT_LT(tool.shape.touch({3.1, 0, 0}).depth, 0);
  EXPECT_LT(tool.shape.touch({0, 2.1, 0}).depth, 0);
}

TEST(ToolShape, ABoxHasSixSides)
{
  ToolParameters p;
  p.shape = ToolKind::plate;
  p.size = {2, 4, 6};
  const auto tool = make_tool<3>(p);
  for (int c = 0; c < 3; ++c)
    for (const double sign : {-1., 1.}) {
      const Vector<3> inside = sign * (p.size[c] / 2 - 0.1) * Vector<3>::Unit(c);
      EXPECT_NEAR(tool.shape.touch(inside).depth, 0.1, 1e-14);
      EXPECT_NEAR(tool.shape.touch(inside).normal[c], sign, 1e-14);
      EXPECT_LT(tool.shape.touch(inside * 1.2).depth, 0);
    }
}
} // namespace
