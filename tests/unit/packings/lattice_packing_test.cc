#include "tests/unit/packings/packing_checks.h"

#include "core/check.h"

#include <limits>
#include <map>
#include <unordered_map>

namespace
{
using namespace ligament;
using namespace ligament::packings;
using namespace ligament::packings::test;

template <int dim>
void check_closed_box(const LatticeValues &lattice, double size)
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
void check_table(const LatticeValues &lattice)
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

TEST(LatticePacking, OrientationTurnsTheLattice)
{
  // Angles between directions and axes, from the description of the lattices.
  auto p = specimen<2>(LatticeKind::hexagonal, 20);
  p.orientation[0] = 0.2;
  const auto plane = make_lattice_packing(p);
  for (int m = 0; m < 3; ++m) {
    const double angle = 0.2 + std::array<double, 3>{0, 2 * M_PI / 3, M_PI / 3}[m];
    const Vector<2> expected(std::cos(angle), std::sin(angle));
    EXPECT_NEAR((plane.directions[m].normal - expected).norm(), 0, 1e-15);
  }
  auto q = specimen<3>(LatticeKind::fcc, 8);
  const auto straight = make_lattice_packing(q);
  EXPECT_EQ(straight.directions[0].normal, Vector<3>(1, 0, 0));
  EXPECT_EQ(straight.directions[1].normal, Vector<3>(0, 1, 0));
  EXPECT_NEAR((straight.directions[5].normal - Vector<3>(0.5, 0.5, std::sqrt(0.5))).norm(), 0,
              1e-15);
  // A third of a turn about (1, 1, 1) takes x to y, y to z and z to x.
  q.orientation = Vector<3>::Constant(2 * M_PI / 3 / std::sqrt(3.));
  const auto turned = make_lattice_packing(q);
  for (int m = 0; m < 6; ++m) {
    const Vector<3> n = straight.directions[m].normal;
    EXPECT_NEAR((turned.directions[m].normal - Vector<3>(n[2], n[0], n[1])).norm(), 0, 1e-15);
  }
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

template <int dim>
void check_zone(const LatticeValues &lattice, double size, bool band)
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
    for (int i = 0; i < twin.size(); ++i) {
      EXPECT_TRUE(number.emplace(twin.global_id[i], i).second);
      // Tables keep numbers as doubles: ids must come back.
      EXPECT_LT(twin.global_id[i], std::int64_t(1) << 53);
    }
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

/// The same particles and faces in another order: names, places and cells to the last bit; and
/// what kernels want of the order. Returns the largest offset between neighbours in both.
template <int dim>
std::pair<int, int> check_order(LatticeKind kind, const Vector<dim> &size, bool turned = false)
{
  auto p = specimen<dim>(kind, 10);
  p.upper = p.lower + p.spacing * size;
  if (turned)
    p.orientation = orientations<dim>()[1];
  p.small_layer = std::numeric_limits<long>::max();
  const auto own = make_lattice_packing(p);
  p.small_layer = 0;
  const auto other = make_lattice_packing(p);
  EXPECT_LT(closure_error(other), round_off(p));
  std::unordered_map<std::int64_t, int> in_own;
  for (int i = 0; i < own.size(); ++i)
    in_own[own.global_id[i]] = i;
  EXPECT_EQ(own.size(), other.size());
  for (int i = 0; i < other.size(); ++i) {
    const int j = in_own.at(other.global_id[i]);
    EXPECT_EQ(get(other.centre, i), get(own.centre, j));
    EXPECT_EQ(other.volume[i], own.volume[j]);
  }
  std::map<std::pair<int, int>, const Face<dim> *> faces;
  int reach = 0, other_reach = 0;
  for (const auto &face : own.faces) {
    faces[{face.i, face.j}] = &face;
    reach = std::max(reach, face.j - face.i);
  }
  EXPECT_EQ(own.faces.size(), other.faces.size());
  for (const auto &face : other.faces) {
    other_reach = std::max(other_reach, face.j - face.i);
    const int i = in_own.at(other.global_id[face.i]), j = in_own.at(other.global_id[face.j]);
    const double sign = i < j ? 1 : -1;
    const auto found = faces.find({std::min(i, j), std::max(i, j)});
    if (found == faces.end()) {
      ADD_FAILURE() << "no face between " << i << " and " << j;
      return {0, 0};
    }
    EXPECT_EQ(Vector<dim>(sign * face.normal), found->second->normal);
    EXPECT_EQ(face.direction < 0, found->second->direction < 0);
    EXPECT_NEAR(face.area, found->second->area, 1e-12 * own.faces[0].area);
  }
  return {reach, other_reach};
}

TEST(LatticePacking, LayersLieAcrossTheLongestSide)
{
  // Rows along the longest side become layers across it.
  const auto strip = check_order<2>(hexagonal.kind, {90.3, 7.2});
  EXPECT_GT(strip.first, 80);
  EXPECT_LT(strip.second, 15);
  EXPECT_LT(check_order<2>(square.kind, {90.3, 7.2}).second, 10);
  EXPECT_LT(check_order<2>(hexagonal.kind, {60.3, 7.2}, true).second, 15);
  for (const auto &kind : {simple_cubic.kind, fcc.kind})
    for (int axis = 0; axis < 3; ++axis) {
      Vector<3> bar = {4.2, 4.2, 4.2}, plate = {16.3, 15.3, 16.3};
      bar[axis] = 30.3;
      plate[axis] = 4.2;
      // A layer of a bar has about 4 x 4 to 4 x 6 particles, one of a plate 4 x 16 to 6 x 16.
      EXPECT_LT(check_order<3>(kind, bar).second, 50) << axis;
      EXPECT_LT(check_order<3>(kind, plate).second, 150) << axis;
    }
  check_order<3>(fcc.kind, {20.3, 5.2, 6.2}, true);
  check_order<3>(simple_cubic.kind, {20.3, 5.2, 6.2}, true);
}

TEST(LatticePacking, FillsParticles)
{
  const auto packing = make_lattice_packing(specimen<3>(LatticeKind::fcc, 6));
  particles::Particles<3> particles;
  fill_particles(packing, 2450., particles);
  ASSERT_EQ(particles.size(), packing.size());
  for (int i = 0; i < packing.size(); ++i) {
    const double m = 2450 * packing.volume[i];
    EXPECT_DOUBLE_EQ(particles.mass[i], m);
    EXPECT_DOUBLE_EQ(particles.inertia(i), m * 0.01 * 0.01 / 10);
    EXPECT_DOUBLE_EQ(particles.inverse_mass(i) * particles.mass[i], 1);
    EXPECT_DOUBLE_EQ(particles.inverse_inertia(i) * particles.inertia(i), 1);
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
  p = good; // a wall of 0.4 d behind a notch has no particles of its own
  p.notches = {{p.lower + Vector<2>(0.05, 0.004), p.lower + Vector<2>(0.1, 0.05)}};
  refused(p);
  p.notches = {{p.lower + Vector<2>(0.05, 0.004), p.lower + Vector<2>(0.1, 0.015)}};
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
