#include "tests/unit/packings/packing_checks.h"

#include <algorithm>

namespace
{
using namespace ligament;
using namespace ligament::packings;
using namespace ligament::packings::test;

TEST(SpecimenShape, HolesKeepClosureAndVolume)
{
  for (const LatticeKind kind : {LatticeKind::square, LatticeKind::hexagonal})
    for (const double angle : {0., M_PI / 12}) {
      auto p = specimen<2>(kind, 40);
      p.orientation[0] = angle;
      const Vector<2> centre = (p.lower + p.upper) / 2;
      const double d = p.spacing;
      p.holes = {{centre, 8.3 * d}, {centre + Vector<2>(15 * d, 2 * d), 1.2 * d}};
      const auto packing = make_lattice_packing(p);
      EXPECT_LT(closure_error(packing), round_off(p));
      double holes = 0, surface = 0;
      for (const auto &hole : p.holes)
        holes += M_PI * hole.radius * hole.radius * p.thickness;
      EXPECT_NEAR(total_volume(packing) / (box_volume(p) - holes), 1, 1e-12);
      for (const auto &face : packing.boundary_faces)
        if (face.boundary == inner_surface<2>)
          surface += face.area;
      // n sides of about d/2 on radius R: the polygon of equal area is longer by (pi/n)^2/6 <
      // 0.002.
      const double perimeter = 2 * M_PI * (8.3 + 1.2) * d * p.thickness;
      EXPECT_NEAR(surface / perimeter, 1, 0.002);
    }
}

TEST(SpecimenShape, OverlappingVoidsAreTakenOnce)
{
  // A slot that ends in a hole.
  auto p = specimen<2>(LatticeKind::hexagonal, 40);
  const double d = p.spacing;
  const Vector<2> centre = (p.lower + p.upper) / 2;
  p.holes = {{centre, 5 * d}};
  p.notches = {{{p.lower[0], centre[1] - 2.2 * d}, {centre[0], centre[1] + 2.2 * d}}};
  const auto packing = make_lattice_packing(p);
  EXPECT_LT(closure_error(packing), round_off(p));
  // Slot outside of the disc: length to the chord at x = -sqrt(R^2 - h^2), minus the circle
  // segment.
  const double r = 5 * d, h = 2.2 * d;
  const double common =
      h * std::sqrt(r * r - h * h) + r * r * std::asin(h / r); // half disc, |y| < h
  const double slot = 2 * h * (centre[0] - p.lower[0]) - common;
  const double expected = box_volume(p) - (M_PI * r * r + slot) * p.thickness;
  // The polygon's sides of d/2 err by at most their sag (d/2)^2/(8 R) along the common arc.
  EXPECT_NEAR(total_volume(packing), expected, d * d / 32 / r * 2 * h * p.thickness);
  for (const auto &face : packing.boundary_faces)
    EXPECT_FALSE(face.boundary == 0 &&
                 std::abs(packing.centre[1][face.i] + face.lever[1] - centre[1]) < h - 1e-9);
}

template <int dim>
void check_notch(const LatticeValues &lattice, double size)
{
  for (const auto &orientation : orientations<dim>()) {
    auto p = specimen<dim>(lattice.kind, size);
    p.orientation = orientation;
    BoxNotch<dim> notch{p.lower, p.upper};
    notch.upper[0] = p.lower[0] + 0.43 * (p.upper[0] - p.lower[0]);
    const double middle = (p.lower[1] + p.upper[1]) / 2;
    notch.lower[1] = middle - 0.75 * p.spacing;
    notch.upper[1] = middle + 0.75 * p.spacing;
    if (dim == 3)
      notch.lower[dim - 1] = p.lower[dim - 1] + 0.4 * (p.upper - p.lower)[dim - 1];
    p.notches = {notch};
    // The mouth lies on the surface, but for round-off in the input.
    p.notches[0].lower[0] += 1e-10 * p.spacing;
    const auto packing = make_lattice_packing(p);
    EXPECT_LT(closure_error(packing), round_off(p));
    const double t = dim == 2 ? p.thickness : 1;
    const double expected = box_volume(p) - (notch.upper - notch.lower).prod() * t;
    EXPECT_NEAR(total_volume(packing) / expected, 1, 1e-12);
    const auto side_area = [&](const Vector<dim> &lower, const Vector<dim> &upper) {
      return (upper - lower).prod() / (upper[0] - lower[0]) * t;
    };
    double left = 0, inner = 0;
    for (const auto &face : packing.boundary_faces) {
      left += face.boundary == 0 ? face.area : 0;
      inner += face.boundary == inner_surface<dim> ? face.area : 0;
    }
    EXPECT_NEAR(left / (side_area(p.lower, p.upper) - side_area(notch.lower, notch.upper)), 1,
                1e-12);
    // The end of the notch, its two flanks, in 3D its bottom (it is open at the top).
    const Vector<dim> size = notch.upper - notch.lower;
    double walls = side_area(notch.lower, notch.upper) + 2 * size.prod() / size[1] * t;
    if (dim == 3)
      walls += size[0] * size[1];
    EXPECT_NEAR(inner / walls, 1, 1e-12);
  }
}

TEST(SpecimenShape, NotchesKeepClosureAndVolume)
{
  check_notch<2>(square, 18);
  check_notch<2>(hexagonal, 18);
  check_notch<3>(simple_cubic, 9);
  check_notch<3>(fcc, 9);
}

TEST(SpecimenShape, CracksRunBetweenRows)
{
  auto p = specimen<2>(LatticeKind::hexagonal, 40);
  const Vector<2> centre = (p.lower + p.upper) / 2;
  const double d = p.spacing;
  for (const int n : {0, 1, 7}) {
    // Bonds across the middle plane meet it at the centre and every d/2 from there: the crack cuts
    // those strictly inside and those on its tips.
    p.cracks = {
        {centre - Vector<2>((n + 0.25) * d / 2, 0), centre + Vector<2>((n + 0.25) * d / 2, 0)}};
    const auto count = [&] {
      int cracked = 0;
      for (const auto &face : make_lattice_packing(p).faces)
        cracked += face.cracked;
      return cracked;
    };
    EXPECT_EQ(count(), 2 * n + 1);
    p.cracks = {{centre - Vector<2>((n + 1) * d / 2, 0), centre + Vector<2>((n + 1) * d / 2, 0)}};
    EXPECT_EQ(count(), 2 * n + 3);
  }
  // A crack through the centres of a row: they count as above it, so it cuts two bonds a particle.
  const double row = centre[1] + std::sqrt(0.75) / 2 * d;
  p.cracks = {{Vector<2>(centre[0] - 4.1 * d, row), Vector<2>(centre[0] + 4.1 * d, row)}};
  int cracked = 0;
  const auto packing = make_lattice_packing(p);
  for (const auto &face : packing.faces)
    if (face.cracked) {
      EXPECT_LT(packing.centre[1][face.i], row - 0.5 * d);
      EXPECT_NEAR(packing.centre[1][face.j], row, 1e-9 * d);
      ++cracked;
    }
  // Eight centres at (1/4 + n) d lie within 4.1 d of the middle; two bonds each come from below.
  EXPECT_EQ(cracked, 2 * 8);
}

TEST(SpecimenShape, CracksIn3D)
{
  auto p = specimen<3>(LatticeKind::simple_cubic, 10);
  const Vector<3> c = (p.lower + p.upper) / 2;
  const double d = p.spacing;
  // A square of 3 x 5 bonds in the middle plane, bonds at half-integer places.
  const double a = 1.7 * d, b = 2.2 * d;
  p.cracks = {{c + Vector<3>(-a, -b, 0), c + Vector<3>(a, -b, 0), c + Vector<3>(a, b, 0),
               c + Vector<3>(-a, b, 0)}};
  int cracked = 0;
  for (const auto &face : make_lattice_packing(p).faces)
    cracked += face.cracked;
  EXPECT_EQ(cracked, 4 * 4);
  // FCC: four bonds of each particle cross a layer boundary.
  auto q = specimen<3>(LatticeKind::fcc, 12);
  const Vector<3> far(q.upper[0] - q.lower[0], q.upper[1] - q.lower[1], 0);
  const Vector<3> m = (q.lower + q.upper) / 2;
  q.cracks = {{m + Vector<3>(-far[0], -far[1], 0), m + Vector<3>(far[0], -far[1], 0),
               m + Vector<3>(far[0], far[1], 0), m + Vector<3>(-far[0], far[1], 0)}};
  const auto packing = make_lattice_packing(q);
  std::vector<int> n_cracked(packing.size());
  for (const auto &face : packing.faces) {
    const double zi = packing.centre[2][face.i] - m[2], zj = packing.centre[2][face.j] - m[2];
    EXPECT_EQ(face.cracked, (zi > 0) != (zj > 0));
    if (face.direction >= 0 && face.cracked)
      ++n_cracked[face.i];
  }
  EXPECT_EQ(*std::max_element(n_cracked.begin(), n_cracked.end()), 4);
}
} // namespace
