#include "particles/lattice_packing.h"

#include "core/check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>

namespace
{
using namespace ligament;
using namespace ligament::particles;

template <int dim>
using Matrix = Eigen::Matrix<double, dim, dim>;

struct Lattice
{
  LatticeKind kind;
  int neighbours;
  double area, volume; // for d = 1: theory.md table of packings
};

const Lattice square{LatticeKind::square, 4, 1, 1};
const Lattice hexagonal{LatticeKind::hexagonal, 6, 1 / std::sqrt(3.), std::sqrt(3.) / 2};
const Lattice simple_cubic{LatticeKind::simple_cubic, 6, 1, 1};
const Lattice fcc{LatticeKind::fcc, 12, 1 / std::sqrt(8.), 1 / std::sqrt(2.)};

/// A specimen that fits the lattice in no direction, far from the origin.
template <int dim>
LatticeParameters<dim> specimen(LatticeKind kind, double size)
{
  LatticeParameters<dim> p;
  p.kind = kind;
  p.spacing = 0.01;
  p.thickness = 0.3;
  const std::array<double, 3> shape = {1, 0.83, 0.71};
  for (int a = 0; a < dim; ++a) {
    p.lower[a] = 0.7 - 0.4 * a;
    p.upper[a] = p.lower[a] + size * p.spacing * shape[a];
  }
  return p;
}

template <int dim>
double box_volume(const LatticeParameters<dim> &p)
{
  return (p.upper - p.lower).prod() * (dim == 2 ? p.thickness : 1);
}

/// Largest violation of (D2a) over S d^0 and of (D2b) over V, of the cells with `check[i]`; also
/// checks that q, levers, normals and order agree.
template <int dim>
double closure_error(const Packing<dim> &packing, const std::vector<char> &check = {})
{
  const int n = packing.size();
  std::vector<Vector<dim>> surface(n, Vector<dim>::Zero());
  std::vector<Matrix<dim>> moment(n, Matrix<dim>::Zero());
  const double d = packing.spacing;
  for (std::size_t f = 0; f < packing.faces.size(); ++f) {
    const auto &face = packing.faces[f];
    if (f > 0) {
      const auto &last = packing.faces[f - 1];
      EXPECT_TRUE(last.i < face.i || (last.i == face.i && last.j < face.j));
      EXPECT_TRUE(last.i < face.i || face.direction < 0 || last.direction < face.direction);
    }
    EXPECT_LT(face.i, face.j);
    EXPECT_GT(face.area, 0);
    const Vector<dim> r = get(packing.centre, face.j) - get(packing.centre, face.i);
    const double scale = get(packing.centre, face.i).norm();
    EXPECT_NEAR((r - (face.q_i + face.q_j) * face.normal).norm(), 0, 4e-16 * scale);
    EXPECT_NEAR((face.lever_i - face.lever_j - r).norm(), 0, 4e-16 * scale);
    if (face.area > 1e-6 * std::pow(d, dim - 1) * packing.thickness) {
      EXPECT_NEAR(face.lever_i.dot(face.normal), face.q_i, 1e-9 * d);
    }
    surface[face.i] += face.area * face.normal;
    surface[face.j] -= face.area * face.normal;
    moment[face.i] += face.area * face.lever_i * face.normal.transpose();
    moment[face.j] -= face.area * face.lever_j * face.normal.transpose();
  }
  for (const auto &face : packing.boundary_faces) {
    EXPECT_GT(face.area, 0);
    surface[face.i] += face.area * face.normal;
    moment[face.i] += face.area * face.lever * face.normal.transpose();
  }
  double error = 0;
  for (int i = 0; i < n; ++i)
    if (check.empty() || check[i]) {
      error = std::max(error, surface[i].norm() * d / packing.volume[i]);
      error = std::max(error, (moment[i] / packing.volume[i] - Matrix<dim>::Identity()).norm());
    }
  return error;
}

template <int dim>
double total_volume(const Packing<dim> &packing)
{
  double sum = 0;
  for (const double v : packing.volume)
    sum += v;
  return sum;
}

template <int dim>
std::vector<Spin<dim>> orientations()
{
  if constexpr (dim == 2)
    return {Spin<2>(0), Spin<2>(M_PI / 12), Spin<2>(M_PI / 2), Spin<2>(-0.7)};
  else
    return {Spin<3>(0, 0, 0), Spin<3>(0, 0, M_PI / 12), Spin<3>(0.3, -1.1, 0.7)};
}

/// What round-off allows: positions carry eps |x|, a cell that is clipped there errs by that over
/// d, times the number of faces and the size of slivers.
template <int dim>
double round_off(const LatticeParameters<dim> &p)
{
  return 100 * std::numeric_limits<double>::epsilon() * std::max(p.lower.norm(), p.upper.norm()) /
         p.spacing;
}

template <int dim>
void check_closed_box(const Lattice &lattice, double size)
{
  for (const auto &orientation : orientations<dim>()) {
    auto p = specimen<dim>(lattice.kind, size);
    p.orientation = orientation;
    const auto packing = make_lattice_packing(p);
    EXPECT_LT(closure_error(packing), round_off(p));
    EXPECT_NEAR(total_volume(packing) / box_volume(p), 1, 1e-12);
    // Each side of the box is covered once, and nothing else is a surface.
    for (int side = 0; side < 2 * dim; ++side) {
      double area = 0;
      for (const auto &face : packing.boundary_faces)
        if (face.boundary == side) {
          area += face.area;
          EXPECT_EQ(face.normal[side / 2], side % 2 ? 1 : -1);
          const double plane = side % 2 ? p.upper[side / 2] : p.lower[side / 2];
          EXPECT_NEAR(packing.centre[side / 2][face.i] + face.lever[side / 2], plane, 1e-14);
          EXPECT_GT(face.q, 0.249 * p.spacing);
        }
      const double length = p.upper[side / 2] - p.lower[side / 2];
      EXPECT_NEAR(area / (box_volume(p) / length), 1, 1e-12);
    }
  }
}

TEST(LatticePacking, CellsCloseInABox2D)
{
  check_closed_box<2>(square, 17);
  check_closed_box<2>(hexagonal, 17);
}

TEST(LatticePacking, CellsCloseInABox3D)
{
  check_closed_box<3>(simple_cubic, 9);
  check_closed_box<3>(fcc, 9);
}

template <int dim>
void check_table(const Lattice &lattice)
{
  auto p = specimen<dim>(lattice.kind, dim == 2 ? 15 : 9);
  p.orientation = orientations<dim>()[1];
  const auto packing = make_lattice_packing(p);
  const double d = p.spacing, t = dim == 2 ? p.thickness : 1;
  ASSERT_EQ(int(packing.directions.size()), lattice.neighbours / 2);
  std::vector<int> n_regular(packing.size());
  for (const auto &face : packing.faces)
    if (face.direction >= 0) {
      ++n_regular[face.i];
      ++n_regular[face.j];
      EXPECT_NEAR(face.area, lattice.area * std::pow(d, dim - 1) * t, 1e-15 * t);
      EXPECT_DOUBLE_EQ(face.q_i, d / 2);
      EXPECT_DOUBLE_EQ(face.q_j, d / 2);
      EXPECT_EQ((face.lever_i - face.q_i * face.normal).norm(), 0);
      EXPECT_EQ((face.lever_j + face.q_j * face.normal).norm(), 0);
      EXPECT_EQ((face.normal - packing.directions[face.direction].normal).norm(), 0);
      EXPECT_EQ(face.area, packing.directions[face.direction].area);
      for (const int i : {face.i, face.j})
        EXPECT_NEAR(packing.volume[i], lattice.volume * std::pow(d, dim) * t, 1e-15 * t * d);
    }
  int n_inner = 0;
  for (int i = 0; i < packing.size(); ++i)
    n_inner += n_regular[i] == lattice.neighbours;
  // All particles farther than 2.5 d from the surface have only whole neighbours.
  const double inner = (p.upper - p.lower - Vector<dim>::Constant(5 * d)).prod() /
                       (lattice.volume * std::pow(d, dim));
  EXPECT_GT(n_inner, 0.7 * inner);
}

TEST(LatticePacking, WholeCellsHaveTheTablesValues)
{
  check_table<2>(square);
  check_table<2>(hexagonal);
  check_table<3>(simple_cubic);
  check_table<3>(fcc);
}

TEST(LatticePacking, ThinSpecimensClose)
{
  // Two particles across: every cell sees opposite sides.
  auto p = specimen<2>(LatticeKind::hexagonal, 20);
  p.upper[1] = p.lower[1] + 2.05 * p.spacing;
  p.orientation[0] = 0.4;
  EXPECT_LT(closure_error(make_lattice_packing(p)), round_off(p));
  auto q = specimen<3>(LatticeKind::fcc, 8);
  q.upper[2] = q.lower[2] + 2.05 * q.spacing;
  q.orientation = {0.2, 0.5, -1};
  const auto packing = make_lattice_packing(q);
  EXPECT_LT(closure_error(packing), round_off(q));
  EXPECT_NEAR(total_volume(packing) / box_volume(q), 1, 1e-12);
}

TEST(LatticePacking, SurfacesThroughLatticePlanesClose)
{
  // Sides of the box coincide with faces and corners of lattice cells, up to round-off.
  for (const double n : {8., 8.5, 9.}) {
    for (const LatticeKind kind : {LatticeKind::square, LatticeKind::hexagonal}) {
      auto p = specimen<2>(kind, 1);
      p.upper =
          p.lower + n * p.spacing * Vector<2>(1, kind == LatticeKind::square ? 1 : std::sqrt(0.75));
      const auto packing = make_lattice_packing(p);
      EXPECT_LT(closure_error(packing), round_off(p));
      EXPECT_NEAR(total_volume(packing) / box_volume(p), 1, 1e-12);
    }
    for (const LatticeKind kind : {LatticeKind::simple_cubic, LatticeKind::fcc}) {
      auto p = specimen<3>(kind, 1);
      p.upper =
          p.lower + n * p.spacing * Vector<3>(1, 1, kind == LatticeKind::fcc ? std::sqrt(0.5) : 1);
      const auto packing = make_lattice_packing(p);
      EXPECT_LT(closure_error(packing), round_off(p));
      EXPECT_NEAR(total_volume(packing) / box_volume(p), 1, 1e-12);
    }
  }
}

TEST(LatticePacking, HolesKeepClosureAndVolume)
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

TEST(LatticePacking, OverlappingVoidsAreTakenOnce)
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
void check_notch(const Lattice &lattice, double size)
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
    const auto packing = make_lattice_packing(p);
    EXPECT_LT(closure_error(packing), round_off(p));
    const double t = dim == 2 ? p.thickness : 1;
    const double expected = box_volume(p) - (notch.upper - notch.lower).prod() * t;
    EXPECT_NEAR(total_volume(packing) / expected, 1, 1e-12);
  }
}

TEST(LatticePacking, NotchesKeepClosureAndVolume)
{
  check_notch<2>(square, 18);
  check_notch<2>(hexagonal, 18);
  check_notch<3>(simple_cubic, 9);
  check_notch<3>(fcc, 9);
}

TEST(LatticePacking, CracksRunBetweenRows)
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

TEST(LatticePacking, CracksIn3D)
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

template <int dim>
void check_zone(const Lattice &lattice, double size, bool band)
{
  for (const auto &orientation : orientations<dim>()) {
    auto p = specimen<dim>(lattice.kind, size);
    p.orientation = orientation;
    const auto twin = make_lattice_packing(p);
    const Vector<dim> l = p.upper - p.lower;
    p.zone_lower = p.lower + 0.21 * l;
    p.zone_upper = p.upper - 0.26 * l;
    if (band) // reaches through the specimen, and out of it, along x
    {
      p.zone_lower[0] = p.lower[0];
      p.zone_upper[0] = p.upper[0] + 1;
    }
    const auto zone = make_lattice_packing(p);

    std::unordered_map<std::int64_t, int> number;
    for (int i = 0; i < twin.size(); ++i)
      EXPECT_TRUE(number.emplace(twin.global_id[i], i).second);
    std::vector<int> in_twin(zone.size());
    std::vector<char> in_zone(twin.size());
    for (int i = 0; i < zone.size(); ++i) {
      ASSERT_TRUE(number.count(zone.global_id[i]));
      const int j = in_twin[i] = number[zone.global_id[i]];
      in_zone[j] = true;
      EXPECT_EQ((get(zone.centre, i) - get(twin.centre, j)).norm(), 0);
      EXPECT_EQ(zone.volume[i], twin.volume[j]);
    }
    // The zone has just the faces of the twin between its particles, and their surface faces.
    std::vector<const Face<dim> *> expected;
    for (const auto &face : twin.faces)
      if (in_zone[face.i] && in_zone[face.j])
        expected.push_back(&face);
    ASSERT_EQ(zone.faces.size(), expected.size());
    for (std::size_t f = 0; f < expected.size(); ++f) {
      const auto &a = zone.faces[f];
      const auto &b = *expected[f];
      EXPECT_EQ(in_twin[a.i], b.i);
      EXPECT_EQ(in_twin[a.j], b.j);
      EXPECT_EQ(a.area, b.area);
      EXPECT_EQ((a.lever_i - b.lever_i).norm() + (a.lever_j - b.lever_j).norm(), 0);
      EXPECT_EQ(a.direction, b.direction);
    }
    std::size_t n_boundary = 0;
    for (const auto &face : twin.boundary_faces)
      n_boundary += in_zone[face.i];
    EXPECT_EQ(zone.boundary_faces.size(), n_boundary);
    if (!band) {
      EXPECT_EQ(n_boundary, 0u);
    }

    // Particles well inside are there, and none whose cell reaches across.
    const double d = p.spacing;
    for (int i = 0; i < twin.size(); ++i) {
      double depth = 1e300;
      for (int a = 0; a < dim; ++a) {
        if (p.zone_lower[a] > p.lower[a])
          depth = std::min(depth, twin.centre[a][i] - p.zone_lower[a]);
        if (p.zone_upper[a] < p.upper[a])
          depth = std::min(depth, p.zone_upper[a] - twin.centre[a][i]);
      }
      // No cell reaches less than 0.49 d or, clipped ones included, more than 1.5 d.
      EXPECT_FALSE(depth < 0.49 * d && in_zone[i]);
      EXPECT_FALSE(depth > 1.5 * d && !in_zone[i]);
    }
    // Only cells with neighbours left out are open.
    std::vector<char> closed(zone.size());
    std::vector<char> open_in_twin(twin.size());
    for (const auto &face : twin.faces)
      if (in_zone[face.i] != in_zone[face.j])
        open_in_twin[face.i] = open_in_twin[face.j] = true;
    for (int i = 0; i < zone.size(); ++i)
      closed[i] = !open_in_twin[in_twin[i]];
    EXPECT_LT(closure_error(zone, closed), round_off(p));
    EXPECT_GT(closure_error(zone), 0.1);
  }
}

TEST(LatticePacking, AZoneIsAPartOfItsTwin)
{
  for (const bool band : {false, true}) {
    check_zone<2>(square, 24, band);
    check_zone<2>(hexagonal, 24, band);
    check_zone<3>(simple_cubic, 10, band);
    check_zone<3>(fcc, 10, band);
  }
}

TEST(LatticePacking, NeighboursOfARunLieAtConstantOffsets)
{
  auto p = specimen<2>(LatticeKind::hexagonal, 40);
  p.holes = {{(p.lower + p.upper) / 2, 6 * p.spacing}};
  const auto packing = make_lattice_packing(p);
  ASSERT_EQ(packing.row_begin.front(), 0);
  ASSERT_EQ(packing.row_begin.back(), packing.size());
  std::vector<int> run_of(packing.size());
  for (std::size_t r = 0; r + 1 < packing.row_begin.size(); ++r)
    for (int i = packing.row_begin[r]; i < packing.row_begin[r + 1]; ++i) {
      run_of[i] = int(r);
      if (i > packing.row_begin[r]) {
        const Vector<2> step = get(packing.centre, i) - get(packing.centre, i - 1);
        EXPECT_NEAR((step - Vector<2>(p.spacing, 0)).norm(), 0, 1e-15);
      }
    }
  // A run of i meets a run of j at one offset.
  std::map<std::array<int, 3>, int> offset;
  for (const auto &face : packing.faces)
    if (face.direction >= 0) {
      const auto entry = offset.emplace(
          std::array<int, 3>{run_of[face.i], run_of[face.j], face.direction}, face.j - face.i);
      EXPECT_EQ(entry.first->second, face.j - face.i);
    }
}

TEST(LatticePacking, FillsParticles)
{
  const auto packing = make_lattice_packing(specimen<3>(LatticeKind::fcc, 6));
  Particles<3> particles;
  fill_particles(packing, 2450., particles);
  ASSERT_EQ(particles.n_owned, packing.size());
  for (int i = 0; i < packing.size(); ++i) {
    const double m = 2450 * packing.volume[i];
    EXPECT_DOUBLE_EQ(particles.mass[i], m);
    EXPECT_DOUBLE_EQ(particles.inertia[i], m * 0.01 * 0.01 / 10);
    EXPECT_DOUBLE_EQ(particles.inverse_mass[i] * particles.mass[i], 1);
    EXPECT_DOUBLE_EQ(particles.inverse_inertia[i] * particles.inertia[i], 1);
    EXPECT_EQ(particles.rotation[0][i], 1);
    EXPECT_EQ((get(particles.reference, i) - get(packing.centre, i)).norm(), 0);
  }
  EXPECT_THROW(fill_particles(packing, 0., particles), core::InputError);
}

TEST(LatticePacking, RefusesImpossibleParameters)
{
  const auto good = specimen<2>(LatticeKind::hexagonal, 20);
  const auto refused = [](auto p) { EXPECT_THROW(make_lattice_packing(p), core::InputError); };
  auto p = good;
  p.spacing = 0;
  refused(p);
  p = good;
  p.kind = LatticeKind::fcc;
  refused(p);
  p = good;
  p.upper[1] = p.lower[1] + p.spacing;
  refused(p);
  p = good;
  p.zone_lower = p.upper + Vector<2>(1, 1);
  p.zone_upper = p.upper + Vector<2>(2, 2);
  refused(p);
  p = good;
  p.holes = {{p.lower, p.spacing / 2}};
  refused(p);
  p = good;
  p.notches = {{p.lower, p.lower + Vector<2>(0.1, 0.5 * p.spacing)}};
  refused(p);
  p = good;
  p.cracks = {{p.lower, p.lower}};
  refused(p);
  auto q = specimen<3>(LatticeKind::fcc, 8);
  q.holes = {{q.lower, 3 * q.spacing}};
  refused(q);
  q = specimen<3>(LatticeKind::fcc, 8);
  q.cracks = {{q.lower, q.upper}};
  refused(q);
  EXPECT_THROW(lattice_kind("hexogonal"), core::InputError);
  EXPECT_EQ(lattice_kind("fcc"), LatticeKind::fcc);
}
} // namespace
