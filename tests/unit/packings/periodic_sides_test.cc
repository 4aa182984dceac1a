// Packings of boxes whose sides are joined: cells are closed across them, holes on the seam are
// whole, widths that do not fit are refused with those that do.
#include "packings/periodic_sides.h"
#include "packings/random_packing.h"

#include "core/check.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ligament::packings
{
namespace
{
/// theory.md eqs. (D2a), (D2b) for every cell, neighbours at the ends of the levers, and the
/// volume.
template <int dim>
void check_closed(const Packing<dim> &packing, double volume, double tolerance)
{
  using Matrix = Eigen::Matrix<double, dim, dim>;
  const double d = packing.spacing;
  std::vector<Vector<dim>> sum(packing.size(), Vector<dim>::Zero());
  std::vector<Matrix> moment(packing.size(), Matrix::Zero());
  const auto add = [&](int i, const Vector<dim> &area, const Vector<dim> &lever) {
    sum[i] += area;
    moment[i] += lever * area.transpose();
  };
  int n_images = 0;
  for (const auto &f : packing.faces) {
    add(f.i, f.area * f.normal, f.lever_i);
    add(f.j, -f.area * f.normal, f.lever_j);
    Vector<dim> gap = get(packing.centre, f.j) - get(packing.centre, f.i) - (f.lever_i - f.lever_j);
    for (int c = 0; c < dim; ++c) {
      gap[c] += f.image[c] * packing.period[c];
      n_images += f.image[c] != 0;
    }
    EXPECT_LT(gap.norm(), 1e-11 * d);
    EXPECT_LT(f.i, f.j);
  }
  EXPECT_GT(n_images, 0);
  for (const auto &f : packing.boundary_faces)
    add(f.i, f.area * f.normal, f.lever);
  double total = 0;
  for (int i = 0; i < packing.size(); ++i) {
    EXPECT_LT(sum[i].norm(), tolerance * std::pow(d, dim - 1) * packing.thickness);
    EXPECT_LT((moment[i] / packing.volume[i] - Matrix::Identity()).norm(), tolerance);
    total += packing.volume[i];
  }
  EXPECT_NEAR(total, volume, tolerance * volume);
}

template <int dim>
LatticeParameters<dim> lattice_of(LatticeKind kind, const Vector<dim> &size)
{
  LatticeParameters<dim> p;
  p.kind = kind;
  p.spacing = 0.5;
  p.upper = p.spacing / 2 * size;
  p.lower = -p.upper;
  return p;
}

TEST(PeriodicSides, LatticesCloseAcrossThem)
{
  const double s3 = std::sqrt(3.), s2 = std::sqrt(2.);
  for (const auto &axes : {std::array<bool, 2>{true, false}, {false, true}, {true, true}}) {
    auto square = lattice_of<2>(LatticeKind::square, {9, 7});
    auto hexagonal = lattice_of<2>(LatticeKind::hexagonal, {8, 5 * s3});
    for (auto *p : {&square, &hexagonal}) {
      p->periodic = axes;
      check_closed(make_lattice_packing(*p), (p->upper - p->lower).prod(), 1e-12);
    }
    // All cells whole, all neighbours there.
    if (axes[0] && axes[1]) {
      const auto packing = make_lattice_packing(hexagonal);
      EXPECT_EQ(packing.size(), 80);
      EXPECT_EQ(packing.faces.size(), 240u);
      EXPECT_TRUE(packing.boundary_faces.empty());
    }
  }
  // Turned by 30 degrees the hexagonal lattice repeats itself after sqrt(3) d along x.
  auto turned = lattice_of<2>(LatticeKind::hexagonal, {5 * s3, 8});
  turned.orientation[0] = M_PI / 6;
  turned.periodic = {true, true};
  EXPECT_EQ(make_lattice_packing(turned).faces.size(), 240u);
  for (const auto &axes :
       {std::array<bool, 3>{true, false, false}, {false, false, true}, {true, true, true}})
  {
    auto cubic = lattice_of<3>(LatticeKind::simple_cubic, {6, 7, 8});
    auto fcc = lattice_of<3>(LatticeKind::fcc, {6, 7, 5 * s2});
    for (auto *p : {&cubic, &fcc}) {
      p->periodic = axes;
      check_closed(make_lattice_packing(*p), (p->upper - p->lower).prod(), 1e-12);
    }
  }
}

TEST(PeriodicSides, HolesOnTheSeamAreWhole)
{
  auto p = lattice_of<2>(LatticeKind::hexagonal, {20, 12 * std::sqrt(3.)});
  p.periodic = {true, true};
  p.holes = {{p.upper, 2}}; // at the corner: a quarter of it at each
  auto inside = p;
  inside.holes[0].centre = {p.upper[0] - 10 * p.spacing, p.upper[1] - 6 * std::sqrt(3.) * 0.5};
  const auto on_seam = make_lattice_packing(p), whole = make_lattice_packing(inside);
  EXPECT_EQ(on_seam.size(), whole.size());
  EXPECT_EQ(on_seam.faces.size(), whole.faces.size());
  EXPECT_EQ(on_seam.boundary_faces.size(), whole.boundary_faces.size());
  double volume = 0;
  for (const double v : whole.volume)
    volume += v;
  check_closed(on_seam, volume, 1e-12);
}

TEST(PeriodicSides, RandomPackingsCloseAcrossThem)
{
  for (const double ratio : {1., 2.5}) {
    RandomParameters<2> p;
    p.spacing = 0.5;
    p.upper = {5, 6};
    p.periodic = {true, true};
    p.size_ratio = ratio;
    p.holes = {{{5, 2}, 1}};
    const auto random = make_random_packing(p);
    double volume = 30; // less the hole's polygon
    Void<2> hole = Void<2>::disc(p.holes[0], p.spacing / 2);
    const double n = double(hole.sides.size());
    const double apothem = hole.sides[0].offset - hole.sides[0].normal.dot(p.holes[0].centre);
    volume -= n * apothem * apothem * std::tan(M_PI / n);
    check_closed(random.packing, volume, 1e-10);
    // From its seeds the same again.
    const auto again = pack_seeds<2>(p, random.seeds);
    ASSERT_EQ(again.packing.size(), random.packing.size());
    for (int i = 0; i < again.packing.size(); ++i)
      EXPECT_NEAR(again.packing.volume[i], random.packing.volume[i], 1e-12);
  }
  RandomParameters<3> p;
  p.spacing = 0.5;
  p.upper = {3, 3.5, 4};
  p.periodic = {true, false, true};
  check_closed(make_random_packing(p).packing, 3 * 3.5 * 4, 1e-10);
}

TEST(PeriodicSides, WidthsThatDoNotFitAreRefused)
{
  const auto refusal = [](const LatticeParameters<2> &p) -> std::string {
    try {
      make_lattice_packing(p);
    } catch (const core::InputError &error) {
      return error.what();
    }
    return "no error";
  };
  auto p = lattice_of<2>(LatticeKind::hexagonal, {8.25, 9});
  p.periodic[0] = true;
  EXPECT_NE(refusal(p).find("give 4 m or 4.5 m"), std::string::npos) << refusal(p);
  p.orientation[0] = 0.3;
  EXPECT_THROW(make_lattice_packing(p), core::InputError);
  p = lattice_of<2>(LatticeKind::square, {9, 9});
  p.orientation[0] = std::atan2(5, 12); // repeats itself after 13 d: no whole number fits below
  p.periodic[0] = true;
  EXPECT_NE(refusal(p).find("width of 4.5 m: give 6.5 m"), std::string::npos) << refusal(p);
  p = lattice_of<2>(LatticeKind::square, {5, 9}); // too narrow
  p.periodic[0] = true;
  EXPECT_THROW(make_lattice_packing(p), core::InputError);
  p = lattice_of<2>(LatticeKind::square, {12, 12}); // a crack through the seam
  p.periodic[0] = true;
  p.cracks = {{{2, 0}, {4, 0.01}}};
  EXPECT_THROW(make_lattice_packing(p), core::InputError);
  p.cracks.clear();
  p.zone_lower = {-1, -9}; // reaches one of the two
  EXPECT_THROW(make_lattice_packing(p), core::InputError);
}
} // namespace
} // namespace ligament::packings
