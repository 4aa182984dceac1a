// Packings that repeat themselves sideways: every cell is closed, neighbours across the sides
// included.
#include "packings/periodic_lattice.h"
#include "packings/periodic_random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ligament::packings
{
namespace
{
template <int dim>
void test_lattice(LatticeKind kind)
{
  const Across<dim> across(4);
  constexpr int layers = 5;
  const auto packing = make_periodic_packing<dim>(kind, across, layers, true);
  ASSERT_EQ(packing.size(), across.columns() * layers);
  // theory.md eqs. (D2a), (D2b)
  using Matrix = Eigen::Matrix<double, dim, dim>;
  std::vector<Vector<dim>> sum(packing.size(), Vector<dim>::Zero());
  std::vector<Matrix> moment(packing.size(), Matrix::Zero());
  const auto add = [&](int i, const Vector<dim> &area, const Vector<dim> &lever) {
    sum[i] += area;
    moment[i] += lever * area.transpose();
  };
  for (const auto &f : packing.faces) {
    add(f.i, f.area * f.normal, f.lever_i);
    add(f.j, -f.area * f.normal, f.lever_j);
    // The partner or one of its images lies at the other end of both levers.
    Vector<dim> gap = get(packing.centre, f.j) - get(packing.centre, f.i) - (f.lever_i - f.lever_j);
    for (int c = 0; c < dim - 1; ++c)
      gap[c] -= across[c] * std::round(gap[c] / across[c]);
    EXPECT_LT(gap.norm(), 1e-13);
  }
  for (const auto &f : packing.boundary_faces)
    add(f.i, f.area * f.normal, f.lever);
  for (int i = 0; i < packing.size(); ++i) {
    EXPECT_LT(sum[i].norm(), 1e-14);
    EXPECT_LT((moment[i] / packing.volume[i] - Matrix::Identity()).norm(), 1e-14);
  }
  // Open at the far end: the faces there are missing, nothing else.
  const auto open = make_periodic_packing<dim>(kind, across, layers, false);
  EXPECT_EQ(open.faces.size(), packing.faces.size());
  EXPECT_EQ(2 * open.boundary_faces.size(), packing.boundary_faces.size());
}

TEST(PeriodicLattice, CellsAreClosed)
{
  test_lattice<2>(LatticeKind::square);
  test_lattice<2>(LatticeKind::hexagonal);
  test_lattice<3>(LatticeKind::simple_cubic);
  test_lattice<3>(LatticeKind::fcc);
}

template <int dim>
void test_random_bar()
{
  constexpr double width = dim == 2 ? 12 : 5, length = dim == 2 ? 40 : 16, edge = length / 2;
  const auto seeds = make_periodic_seeds<dim>(width, length, 1);
  const auto bar = pack_periodic<dim>(seeds, width, length, 2 * length);
  const auto zone = pack_periodic<dim>(seeds, width, length, edge);
  const auto other = pack_periodic<dim>(make_other_end<dim>(seeds, width, length, edge + 2, 2),
                                        width, length, 2 * length);
  // Cells fill the bar, and each is closed by faces across the sides, too.
  double volume = 0;
  for (const double v : bar.volume)
    volume += v;
  EXPECT_NEAR(volume, std::pow(width, dim - 1) * length, 1e-10 * volume);
  std::vector<Vector<dim>> sum(bar.size(), Vector<dim>::Zero());
  for (const auto &face : bar.faces) {
    sum[face.i] += face.area * face.normal;
    sum[face.j] -= face.area * face.normal;
    EXPECT_LT((face.lever_i - face.lever_j).norm(),
              4); // neighbours are near, whatever their places
  }
  for (const auto &face : bar.boundary_faces)
    sum[face.i] += face.area * face.normal;
  for (const auto &s : sum)
    EXPECT_LT(s.norm(), 1e-11);
  // The zone is the same in all, and what lies behind it is not.
  ASSERT_LT(zone.size(), bar.size());
  int n_moved = 0;
  for (int i = 0; i < std::min(bar.size(), other.size()); ++i) {
    const Vector<dim> x = get(bar.centre, i), y = get(other.centre, i);
    if (i < zone.size()) {
      const int k = int(zone.global_id[i]);
      EXPECT_EQ(get(zone.centre, i), get(bar.centre, k));
      EXPECT_EQ(get(other.centre, k), get(bar.centre, k));
      EXPECT_NEAR(other.volume[k], bar.volume[k], 1e-12);
      EXPECT_NEAR(zone.volume[i], bar.volume[k], 1e-12);
    }
    n_moved += (x - y).norm() > 0.1;
  }
  EXPECT_GT(n_moved, bar.size() / 4);
}

TEST(RandomBar, RepeatsItselfSideways)
{
  test_random_bar<2>();
  test_random_bar<3>();
}

} // namespace
} // namespace ligament::packings
