#include "core/check.h"
#include "core/extremes.h"
#include "core/outline.h"
#include "core/part.h"
#include "packings/random_packing.h"
#include "tests/unit/packings/packing_checks.h"

#include <Eigen/Geometry>

#include <map>
#include <random>

namespace
{
using namespace ligament;
using namespace ligament::core;
using namespace ligament::packings;
using namespace ligament::packings::test;

/// A body with a rounded corner, a re-entrant one, slanted sides and a hole with corners, in units
/// of the spacing; sides of its boundary by number.
std::vector<Polygon> odd_polygons(double d)
{
  const Outline outer = {{{0, 0}, {}, false, 0},         {{20, 0}, {}, false, 2},
                         {{24, 4}, {{20, 4}}, false, 7}, {{24, 20}, {}, false, 1},
                         {{14, 24}, {}, false, 8},       {{11, 13}, {}, false, 4},
                         {{0, 14}, {}, false, 3}};
  Outline hole = {
      {{4.3, 4.1}, {}, false, 4}, {{4.3, 9.3}, {}, false, 4}, {{9.7, 7.2}, {}, false, 9}};
  std::vector<Polygon> polygons = {polygon(outer, 0.5), polygon(hole, 0.5),
                                   polygon({{{18.2, 10}, {{15.7, 10}}, true, 10}}, 0.5)};
  for (Polygon &p : polygons)
    for (PolygonCorner &corner : p)
      corner.place = d * (corner.place - Vector<2>(12, 12)) + Vector<2>(0.31, -0.2);
  return polygons;
}

template <int dim, typename Parameters>
void put(std::shared_ptr<const Solid<dim>> solid, Parameters &p)
{
  p.solid = solid;
  p.lower = solid->lower();
  p.upper = solid->upper();
}

/// Areas by boundary.
template <int dim>
std::map<int, double> surfaces(const Packing<dim> &packing)
{
  std::map<int, double> area;
  for (const auto &face : packing.boundary_faces)
    area[face.boundary] += face.area;
  return area;
}

template <int dim>
std::map<int, double> surfaces(const Solid<dim> &solid, double thickness)
{
  std::map<int, double> area;
  for (std::size_t f = 0; f < solid.facets().size(); ++f) {
    Vector<3> sum = Vector<3>::Zero();
    for (const auto &[a, b] : solid.facets()[f].edges) {
      const Vector<dim> &u = solid.vertices()[a], &v = solid.vertices()[b];
      if constexpr (dim == 2)
        sum[2] = (v - u).norm() * thickness;
      else
        sum += u.cross(v) / 2;
    }
    area[solid.facets()[f].boundary] += sum.norm();
  }
  return area;
}

template <int dim>
void check(const Packing<dim> &packing, const Solid<dim> &solid, double round_off)
{
  EXPECT_LT(closure_error(packing), round_off);
  const double thickness = dim == 2 ? packing.thickness : 1;
  EXPECT_NEAR(total_volume(packing) / (solid.volume() * thickness), 1, 1e-12);
  const auto found = surfaces(packing), expected = surfaces(solid, thickness);
  EXPECT_EQ(found.size(), expected.size());
  for (const auto &[boundary, area] : expected)
    EXPECT_NEAR(found.at(boundary) / area, 1, 1e-11) << "boundary " << boundary;
}

TEST(SolidPackings, CellsFillAnyOutlineIn2D)
{
  for (const LatticeKind kind : {LatticeKind::square, LatticeKind::hexagonal})
    for (const auto &angle : orientations<2>()) {
      auto p = specimen<2>(kind, 20);
      p.orientation = angle;
      const auto solid = std::make_shared<Solid<2>>(make_solid(odd_polygons(p.spacing)));
      put<2>(solid, p);
      const auto packing = make_lattice_packing(p);
      check(packing, *solid, round_off(p));
      int whole = 0;
      for (const auto &face : packing.faces)
        whole += face.direction >= 0;
      EXPECT_GT(whole, int(packing.faces.size()) / 3);
    }
  RandomParameters<2> p;
  p.spacing = 0.01;
  const auto solid = std::make_shared<Solid<2>>(make_solid(odd_polygons(p.spacing)));
  put<2>(solid, p);
  for (p.seed = 1; p.seed < 4; ++p.seed)
    for (const double ratio : {1., 2.}) {
      p.size_ratio = ratio;
      check(make_random_packing(p).packing, *solid, 1e-11);
    }
}

TEST(SolidPackings, CellsFillPrismsAndBalls)
{
  for (const LatticeKind kind : {LatticeKind::simple_cubic, LatticeKind::fcc})
    for (const auto &angle : orientations<3>()) {
      auto p = specimen<3>(kind, 10);
      p.orientation = angle;
      const auto prism =
          std::make_shared<Solid<3>>(extrude(odd_polygons(p.spacing), 0.02, 0.075, {4, 5}));
      put<3>(prism, p);
      check(make_lattice_packing(p), *prism, 10 * round_off(p));
      const auto ball =
          std::make_shared<Solid<3>>(make_ball({0.3, 0.2, -0.1}, 4.3 * p.spacing, p.spacing, 6));
      EXPECT_NEAR(ball->volume() / (4 * M_PI / 3 * std::pow(4.3 * p.spacing, 3)), 1, 1e-13);
      put<3>(ball, p);
      check(make_lattice_packing(p), *ball, 10 * round_off(p));
    }
  RandomParameters<3> p;
  p.spacing = 0.01;
  const auto ball = std::make_shared<Solid<3>>(make_ball({0, 0, 0}, 4.3 * p.spacing, p.spacing, 6));
  put<3>(ball, p);
  check(make_random_packing(p).packing, *ball, 1e-11);
}

TEST(SolidPackings, ABoxAsSolidIsTheBox)
{
  auto p = specimen<2>(LatticeKind::hexagonal, 20);
  p.orientation[0] = 0.2;
  p.notches = {{p.lower, p.lower + Vector<2>(0.05, 0.043)}};
  const auto box = make_lattice_packing(p);
  p.solid = std::make_shared<Solid<2>>(
      make_solid({polygon(rectangle(p.lower, p.upper, {0, 1, 2, 3}), 1)}));
  const auto solid = make_lattice_packing(p);
  ASSERT_EQ(box.size(), solid.size());
  ASSERT_EQ(box.faces.size(), solid.faces.size());
  for (std::size_t f = 0; f < box.faces.size(); ++f)
    EXPECT_NEAR(box.faces[f].area, solid.faces[f].area, 1e-12 * p.thickness * p.spacing);
  for (const auto &[boundary, area] : surfaces(box))
    EXPECT_NEAR(surfaces(solid).at(boundary) / area, 1, 1e-12);
}

// All sides of the body lie on the box around it, and keep their numbers: also where round-off of
// places is more than that of a cell.
TEST(SolidPackings, SidesOnTheBoxKeepTheirNumbersFarFromTheOrigin)
{
  for (const double shift : {0., 40.}) // spacings are 0.01
    for (const auto &angle : orientations<2>()) {
      auto p = specimen<2>(LatticeKind::hexagonal, 20);
      p.orientation = angle;
      const Vector<2> off(shift, -0.7 * shift), lower = p.lower + off, upper = p.upper + off;
      put<2>(std::make_shared<Solid<2>>(
                 make_solid({polygon(rectangle(lower, upper, {11, 12, 13, 14}), 1)})),
             p);
      const auto found = surfaces(make_lattice_packing(p));
      const Vector<2> size = upper - lower;
      ASSERT_EQ(found.size(), 4u) << shift;
      double sum = 0;
      for (const auto &[boundary, area] : found) {
        EXPECT_GE(boundary, 11) << shift;
        sum += area;
        const double across = area / p.thickness;
        EXPECT_LT(std::min(std::abs(across / size[0] - 1), std::abs(across / size[1] - 1)), 1e-9)
            << boundary;
      }
      EXPECT_NEAR(sum / (2 * p.thickness * size.sum()), 1, 1e-9);
    }
}

/// Slots of round sizes, whose flanks and tips lie in the planes between particles: from all four
/// sides, so that the material lies behind such a plane and before it.
TEST(SolidPackings, FacetsBetweenParticles)
{
  const double d = 0.01;
  for (const double width : {2., 2.4, 3.})
    for (const double tip : {2., 2.5, -1.})
      for (int turn = 0; turn < 4; ++turn) {
        const double h = width / 2;
        Outline outline;
        for (const Vector<2> &x : std::vector<Vector<2>>{
                 {-10, -8}, {10, -8}, {10, -h}, {tip, -h}, {tip, h}, {10, h}, {10, 8}, {-10, 8}})
          outline.push_back({d * (Eigen::Rotation2Dd(turn * M_PI / 2).toRotationMatrix() * x)
                                     .unaryExpr([](double v) { return std::round(10 * v) / 10; }),
                             {},
                             false,
                             int(outline.size())});
        const std::vector<Polygon> polygons = {polygon(outline, 0.5)};
        auto p = specimen<2>(LatticeKind::square, 20);
        p.spacing = d;
        const auto solid = std::make_shared<Solid<2>>(make_solid(polygons));
        put<2>(solid, p);
        check(make_lattice_packing(p), *solid, 10 * round_off(p));
        for (const LatticeKind kind : {LatticeKind::simple_cubic, LatticeKind::fcc}) {
          auto q = specimen<3>(kind, 10);
          q.spacing = d;
          const auto prism =
              std::make_shared<Solid<3>>(extrude(polygons, -1.5 * d, 2 * d, {10, 11}));
          put<3>(prism, q);
          check(make_lattice_packing(q), *prism, 10 * round_off(q));
        }
      }
}

TEST(SolidPackings, SlitsThinnerThanParticlesAreRefusedWhereCellsWouldReachAcross)
{
  auto p = specimen<2>(LatticeKind::hexagonal, 20);
  const double d = p.spacing;
  // A wall of a third of a spacing between the side and a slot.
  const Vector<2> c = (p.lower + p.upper) / 2;
  Polygon slot =
      polygon(rectangle({p.lower[0] + d / 3, c[1] - 3 * d}, {c[0], c[1] + 3 * d}, {4, 4, 4, 4}), 1);
  std::reverse(slot.begin(), slot.end());
  p.solid = std::make_shared<Solid<2>>(
      make_solid({polygon(rectangle(p.lower, p.upper, {0, 1, 2, 3}), 1), slot}));
  EXPECT_THROW(make_lattice_packing(p), InputError);
}

TEST(Solid, DistanceAndContentsAgreeWithSamples)
{
  const Solid<2> flat = make_solid(odd_polygons(0.01));
  const Solid<3> prism = extrude(odd_polygons(0.01), -0.02, 0.03, {4, 5});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(-0.1, 1.1);
  int inside = 0;
  for (int k = 0; k < 20000; ++k) {
    Vector<3> x;
    for (int a = 0; a < 3; ++a)
      x[a] = prism.lower()[a] + share(random) * (prism.upper() - prism.lower())[a];
    const Vector<2> y = x.head<2>();
    double winding = 0, least = 1e300;
    for (const auto &facet : flat.facets()) {
      const Vector<2> a = flat.vertices()[facet.edges[0][0]] - y,
                      b = flat.vertices()[facet.edges[0][1]] - y;
      winding += std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b)) / (2 * M_PI);
      const double s = std::clamp(-a.dot(b - a) / (b - a).squaredNorm(), 0., 1.);
      keep_smallest(least, (a + s * (b - a)).norm());
    }
    const bool is_in = winding > 0.5;
    inside += is_in;
    EXPECT_EQ(flat.contains(y), is_in);
    EXPECT_NEAR(flat.distance(y, 1), is_in ? least : -least, 1e-15);
    const double end = std::min(x[2] + 0.02, 0.03 - x[2]);
    EXPECT_EQ(prism.contains(x), is_in && end > 0);
    if (is_in && end > 0) {
      EXPECT_NEAR(prism.distance(x, 1), std::min(least, end), 1e-15);
    }
    EXPECT_LE(std::abs(prism.distance(x, 0.01)), 0.01);
  }
  EXPECT_NEAR(inside / 20000., flat.volume() / (1.44 * (flat.upper() - flat.lower()).prod()), 0.02);
}

TEST(Outline, ArcsKeepTheirArea)
{
  for (const double side : {0.1, 0.4, 3.}) {
    const Polygon disc = polygon(circle({3, 4}, 2, 5), side);
    EXPECT_NEAR(signed_area(disc), 4 * M_PI, 1e-12);
    // A quarter of a disc, and what it leaves of a square.
    const Polygon quarter = polygon(
        {{{0, 0}, {}, false, 0}, {{2, 0}, {}, false, 0}, {{0, 2}, {{0, 0}}, false, 1}}, side);
    EXPECT_NEAR(signed_area(quarter), M_PI, 1e-12);
    const Polygon rest = polygon(
        {{{2, 2}, {}, false, 0}, {{0, 2}, {}, false, 0}, {{2, 0}, {{0, 0}}, true, 1}}, side);
    EXPECT_NEAR(signed_area(rest), 4 - M_PI, 1e-12);
  }
  EXPECT_THROW(
      polygon({{{0, 0}, {}, false, 0}, {{2, 0}, {}, false, 0}, {{0, 3}, {{0, 0}}, false, 1}}, 1),
      InputError);
}

TEST(Outline, CrossingsAndGapsAreFound)
{
  const auto loop = [](std::vector<Vector<2>> points) {
    Polygon p;
    for (const auto &x : points)
      p.push_back({x, 4});
    return p;
  };
  const Polygon square = loop({{0, 0}, {4, 0}, {4, 4}, {0, 4}});
  EXPECT_FALSE(crossing({square, loop({{1, 1}, {1, 2}, {2, 1}})}));
  EXPECT_TRUE(crossing({square, loop({{1, 1}, {1, 2}, {5, 1}})}));
  EXPECT_TRUE(crossing({loop({{0, 0}, {4, 4}, {4, 0}, {0, 4}})}));
  EXPECT_TRUE(crossing({loop({{0, 0}, {4, 0}, {4, 4}, {4, 1}, {2, 5}})})); // runs back
  EXPECT_TRUE(crossing({loop({{0, 0}, {4, 0}, {4, 4}, {2, 0}})}));         // touches
  using S = Solid<3>;
  const auto ball = make_ball({0, 0, 0}, 1, 0.5, 6);
  auto facets = ball.facets();
  facets.pop_back();
  EXPECT_THROW(S(ball.vertices(), facets), InputError);
  auto turned = ball.facets();
  for (auto &edge : turned[3].edges)
    std::swap(edge[0], edge[1]);
  EXPECT_THROW(S(ball.vertices(), turned), InputError);
}
/// Loads act on parts of sides by the corners of faces.
TEST(SolidPackings, FacesOnPlaneSidesHaveTheirCorners)
{
  auto p = specimen<3>(LatticeKind::simple_cubic, 10);
  const auto prism =
      std::make_shared<Solid<3>>(extrude(odd_polygons(p.spacing), 0.02, 0.075, {4, 5}));
  put<3>(prism, p);
  for (const auto &angle : orientations<3>()) {
    p.orientation = angle;
    const auto packing = make_lattice_packing(p);
    double with = 0, all = 0;
    for (const auto &face : packing.boundary_faces) {
      all += face.area;
      if (face.corners.empty())
        continue;
      with += face.area;
      EXPECT_NEAR(core::face_area<3>(face.corners) / face.area, 1, 1e-6);
      EXPECT_LT((core::face_centroid<3>(face.corners) - face.lever).norm(), 1e-6 * p.spacing);
    }
    EXPECT_GT(with, 0.95 * all);
  }
}

} // namespace
