// Meshes that follow an outline: area, sides, angles, and what is refused.
#include "core/check.h"
#include "core/extremes.h"
#include "core/outline.h"
#include "fem/cell_map.h"
#include "fem/cell_quality.h"
#include "fem/fem_solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

namespace
{
using namespace ligament;
using namespace ligament::fem;
using core::Outline;
using core::Polygon;

core::Polygon turned(Polygon polygon)
{
  std::reverse(polygon.begin(), polygon.end());
  return polygon; // all of its sides belong to one boundary
}

template <int dim>
double area(const Mesh<dim> &mesh)
{
  double sum = 0;
  for (int c = 0; c < mesh.n_cells(); ++c)
    sum += cell_volume(mesh, c);
  return sum;
}

template <int dim>
std::map<int, double> surfaces(const Mesh<dim> &mesh)
{
  std::map<int, double> sum;
  for (const auto &face : mesh.boundary_faces)
    sum[face.boundary] +=
        core::face_area<dim>(face_corners<dim>(cell_corners(mesh, face.cell), face.face));
  return sum;
}

template <int dim>
double least_quality(const Mesh<dim> &mesh)
{
  double least = 1;
  for (int c = 0; c < mesh.n_cells(); ++c)
    keep_smallest(least, scaled_jacobian<dim>(cell_corners(mesh, c)));
  return least;
}

/// Every boundary face is free, every other one has a neighbour: the surface of the mesh is closed.
template <int dim>
void expect_closed(const Mesh<dim> &mesh)
{
  Vector<dim> sum = Vector<dim>::Zero();
  double all = 0;
  for (const auto &face : mesh.boundary_faces) {
    const auto corners = cell_corners(mesh, face.cell);
    const double a = core::face_area<dim>(face_corners<dim>(corners, face.face));
    sum += a * face_normal<dim>(corners, face.face);
    all += a;
  }
  EXPECT_LT(sum.norm(), 1e-12 * all);
}

std::shared_ptr<const core::Solid<2>> solid_of(const std::vector<Polygon> &polygons)
{
  return std::make_shared<core::Solid<2>>(core::make_solid(polygons));
}

MeshParameters<2> parameters(std::shared_ptr<const core::Solid<2>> outline, double cell_size)
{
  MeshParameters<2> p;
  p.outline = outline;
  p.lower = outline->lower();
  p.upper = outline->upper();
  p.cell_size = cell_size;
  return p;
}

Polygon box(const Vector<2> &lower, const Vector<2> &upper)
{
  return core::polygon(core::rectangle(lower, upper, {0, 1, 2, 3}), 1);
}

TEST(FitOutline, HolesAndRoundEnds)
{
  // A bar with a round end and a hole.
  const Outline bar = {{{0, 0}, {}, false, 0},
                       {{30, 0}, {}, false, 2},
                       {{30, 10}, {{30, 5}}, false, 7},
                       {{0, 10}, {}, false, 3}};
  const auto outline = solid_of(
      {core::polygon(bar, 0.05), turned(core::polygon(core::circle({12, 5}, 2, 8), 0.05))});
  for (const double h : {1., 0.5, 0.31}) {
    const auto mesh = make_mesh(parameters(outline, h));
    EXPECT_GT(least_quality(mesh), 0.3) << h;
    expect_closed(mesh);
    // Chords of the arcs: h^2/(8 R) deep.
    EXPECT_NEAR(area(mesh) / outline->volume(), 1, 0.02 * h * h) << h;
    const auto sides = surfaces(mesh);
    EXPECT_NEAR(sides.at(0), 10, 1e-9);
    EXPECT_NEAR(sides.at(2), 30, 1e-9);
    EXPECT_NEAR(sides.at(3), 30, 1e-9);
    EXPECT_NEAR(sides.at(7) / (5 * M_PI), 1, 0.02 * h * h);
    EXPECT_NEAR(sides.at(8) / (4 * M_PI), 1, 0.1 * h * h);
    require_convex(mesh);
  }
}

TEST(FitOutline, ReentrantCornersOnLinesNeedNoGeneralCells)
{
  Polygon l;
  for (const auto &[x, y, b] : std::vector<std::tuple<double, double, int>>{
           {0, 0, 2}, {10, 0, 1}, {10, 4, 7}, {4, 4, 8}, {4, 10, 3}, {0, 10, 0}})
    l.push_back({{x, y}, b});
  auto p = parameters(solid_of({l}), 0.5);
  p.levels = 2; // counts nothing where there is neither a zone nor a slanted side
  const auto mesh = make_mesh(p);
  EXPECT_EQ(mesh.n_cells(), 256);
  for (int c = 0; c < mesh.n_cells(); ++c)
    EXPECT_TRUE(mesh.is_box(c));
  EXPECT_NEAR(area(mesh), 64, 1e-10);
  const auto sides = surfaces(mesh);
  EXPECT_NEAR(sides.at(7), 6, 1e-10);
  EXPECT_NEAR(sides.at(8), 6, 1e-10);
  expect_closed(mesh);
}

TEST(FitOutline, CornersOfSlantedSidesAreNodes)
{
  Polygon p;
  const std::vector<Vector<2>> corners = {{0, 0}, {20, 3}, {24, 14}, {13, 11}, {9, 22}, {-3, 12}};
  for (std::size_t k = 0; k < corners.size(); ++k)
    p.push_back({corners[k], 7 + int(k)});
  const auto outline = solid_of({p});
  for (const double h : {1., 0.6}) {
    const auto mesh = make_mesh(parameters(outline, h));
    expect_closed(mesh);
    EXPECT_NEAR(area(mesh) / outline->volume(), 1, 1e-12);
    EXPECT_GT(least_quality(mesh), 0.15) << h;
    const auto sides = surfaces(mesh);
    for (std::size_t k = 0; k < corners.size(); ++k)
      EXPECT_NEAR(sides.at(7 + int(k)), (corners[(k + 1) % corners.size()] - corners[k]).norm(),
                  1e-9);
    require_convex(mesh);
  }
}

TEST(FitOutline, RandomOutlinesAreFilledOrRefused)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<double> share(0, 1);
  int n_made = 0;
  constexpr int n_drawn = 40;
  for (int k = 0; k < n_drawn; ++k) {
    // A star of 5 to 12 corners, some sides as arcs of circles outward, with a round hole.
    const int n = 5 + int(8 * share(random));
    Outline star;
    for (int c = 0; c < n; ++c) {
      const double angle = 2 * M_PI * (c + 0.6 * share(random)) / n, r = 8 + 6 * share(random);
      star.push_back({{r * std::cos(angle), r * std::sin(angle)}, {}, false, 4});
    }
    const auto outline =
        solid_of({core::polygon(star, 0.05),
                  turned(core::polygon(core::circle({0.3, 0.2}, 1 + 2 * share(random), 8), 0.05))});
    try {
      const auto mesh = make_mesh(parameters(outline, 0.5));
      expect_closed(mesh);
      EXPECT_NEAR(area(mesh) / outline->volume(), 1, 0.01) << k;
      require_convex(mesh);
      ++n_made;
    } catch (const core::InputError &error) {
      EXPECT_NE(std::string(error.what()).find("near ("), std::string::npos) << error.what();
      std::printf("%d: %s\n", k, error.what());
    }
  }
  EXPECT_GT(n_made, n_drawn * 9 / 10);
}

// The sides of a coarse polygon along x and y are long enough for lines of the mesh, but no cell is
// left beside them.
TEST(FitOutline, HolesOfFewSidesAreFollowed)
{
  for (const int n : {4, 8, 12}) {
    Polygon hole;
    for (int k = 0; k < n; ++k) {
      const double angle = -2 * M_PI * (k + 0.5) / n;
      hole.push_back({{10.3 + 4 * std::cos(angle), 10.1 + 4 * std::sin(angle)}, 8});
    }
    const auto outline = solid_of({box({0, 0}, {20, 20}), hole});
    const auto mesh = make_mesh(parameters(outline, 0.5));
    expect_closed(mesh);
    EXPECT_NEAR(area(mesh) / outline->volume(), 1, 0.01) << n;
    EXPECT_NEAR(surfaces(mesh).at(8) / (2 * n * 4 * std::sin(M_PI / n)), 1, 0.02) << n;
    require_convex(mesh);
  }
}

TEST(FitOutline, GradedCellsFollowAHoleAndLeaveTheZoneOut)
{
  const auto outline =
      solid_of({box({0, 0}, {80, 40}), turned(core::polygon(core::circle({60, 21}, 4, 8), 0.05))});
  auto p = parameters(outline, 1);
  p.inner.push_back({{10, 12}, {30, 28}});
  p.levels = 2;
  p.fine_cells = 4;
  for (const double along : {0., 0.5, 2.}) {
    p.outline_cell_size = along;
    const auto mesh = make_mesh(p);
    expect_closed(mesh);
    EXPECT_GT(least_quality(mesh), 0.3);
    EXPECT_NEAR(area(mesh) / (outline->volume() - 20 * 16), 1, 2e-3);
    EXPECT_FALSE(mesh.hanging.empty());
    for (int c = 0; c < mesh.n_cells(); ++c)
      if (!mesh.is_box(c)) {
        EXPECT_LT((cell_point<2>(cell_corners(mesh, c), {0.5, 0.5}) - Vector<2>(60, 21)).norm(),
                  4 + 4 * std::max(1., along));
      }
  }
}

TEST(FitOutline, PrismsHaveTheSameCellsAllAlong)
{
  const auto outline =
      solid_of({box({0, 0}, {20, 10}), turned(core::polygon(core::circle({14, 5}, 2, 9), 0.05))});
  MeshParameters<3> p;
  p.lower << outline->lower(), -3;
  p.upper << outline->upper(), 3;
  p.cell_size = 1;
  p.outline = outline;
  const auto mesh = make_mesh(p);
  expect_closed(mesh);
  EXPECT_NEAR(area(mesh) / (6 * outline->volume()), 1, 5e-3);
  const auto sides = surfaces(mesh);
  EXPECT_NEAR(sides.at(4), sides.at(5), 1e-9);
  EXPECT_NEAR(sides.at(9) / (4 * M_PI * 6), 1, 0.02);
  EXPECT_NEAR(sides.at(2), 120, 1e-9);
  p.growth = 1.3; // there is no zone that cells could grow from
  EXPECT_EQ(make_mesh(p).n_cells(), mesh.n_cells());
  p.growth = 1;
  p.inner.push_back({{2, 2, -1}, {8, 8, 1e300}});
  const auto ring = make_mesh(p);
  expect_closed(ring);
  EXPECT_NEAR(area(mesh) - area(ring), 6 * 6 * 4, 1e-9);
}
// Where a name ends a load does: there must be a node, also where nothing turns.
TEST(FitOutline, NamedPartsOfStraightSidesAreMeshedExactly)
{
  for (const double lean : {0., 2.}) {
    Polygon p;
    const Vector<2> left(-50, 50 + lean), right(50, 50 - lean);
    const auto on_top = [&](double x) { return Vector<2>(left + (x + 50) / 100 * (right - left)); };
    for (const auto &[x, b] : std::vector<std::pair<Vector<2>, int>>{{{-50, -50}, 2},
                                                                     {{50, -50}, 1},
                                                                     {right, 3},
                                                                     {on_top(5), 7},
                                                                     {on_top(-5), 3},
                                                                     {left, 0}})
      p.push_back({x, b});
    const auto mesh = make_mesh(parameters(solid_of({p}), 4));
    expect_closed(mesh);
    EXPECT_NEAR(surfaces(mesh).at(7), 10 * std::hypot(1, lean / 50), 1e-6) << lean;
  }
}

// The first corner may lie at any node of the path: the last one, too.
TEST(FitOutline, TriangularHolesAtAnyAngle)
{
  int n_meshed = 0;
  for (int k = 0; k < 60; ++k) {
    Polygon hole;
    for (int c = 0; c < 3; ++c) {
      const double angle = 4.197 + 0.1 * k - 2 * M_PI / 3 * c;
      hole.push_back({{10.3 + 4 * std::cos(angle), 10.1 + 4 * std::sin(angle)}, 7});
    }
    const auto outline = solid_of({box({0, 0}, {20, 20}), hole});
    try {
      const auto mesh = make_mesh(parameters(outline, 1));
      EXPECT_NEAR(area(mesh) / outline->volume(), 1, 1e-9);
      ++n_meshed;
    } catch (const core::InputError &) { // sharp corners may not go with these cells
    }
  }
  EXPECT_GT(n_meshed, 20);
}

} // namespace
