// Overlaps and transitions in which cells change their size.
#include "coupling/operators/gap_filter.h"
#include "tests/support/noise.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

namespace ligament
{
namespace
{
using namespace tests;

/// Cells double two or three cells behind the inner end of an overlap of four.
template <int dim>
CoupledBodiesParameters<dim> band()
{
  CoupledBodiesParameters<dim> p;
  p.material.poissons_ratio = 0.3;
  p.overlap_cells = 4;
  p.transition_cells = 3;
  p.levels = 1;
  p.fine_cells = 1;
  if constexpr (dim == 2) {
    p.size = {37, 140};
    p.zone_size = {100, 50};
    p.cell_size = 3.1;
  } else {
    p.size = {16.4, 15.8, 72};
    p.zone_size = {100, 100, 33};
    p.cell_size = 2.6;
  }
  return p;
}

template <int dim>
CoupledBodiesParameters<dim> ring()
{
  auto p = band<dim>();
  p.size = Vector<dim>::Constant(dim == 2 ? 120 : 66);
  p.zone_size = Vector<dim>::Constant(dim == 2 ? 47 : 33);
  p.zone_size[0] += 3;
  return p;
}

template <int dim>
CoupledBodiesParameters<dim> growing(CoupledBodiesParameters<dim> p)
{
  p.growth = 1.2;
  p.levels = 2;
  return p;
}

template <int dim>
void check_patch(const CoupledBodiesParameters<dim> &p)
{
  const auto body = make_coupled_bodies(p);
  const auto &report = body.split->report();
  EXPECT_LT(report.patch_residual, 1e-13);
  EXPECT_LT(report.patch_modulus, 0.02);
}

TEST(GradedMeshes, PatchFitWithHangingNodesInABand)
{
  for (const double nu : {0., 0.45})
    for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress}) {
      auto p = band<2>();
      p.material.poissons_ratio = nu;
      p.material.plane = plane;
      check_patch(p);
    }
}

TEST(GradedMeshes, PatchFitWithHangingNodesInARing)
{
  check_patch(ring<2>());
}

TEST(GradedMeshes, PatchFitWithHangingNodesIn3D)
{
  check_patch(band<3>());
}

TEST(GradedMeshes, PatchFitWithGrowingCells)
{
  check_patch(growing(band<2>()));
  check_patch(growing(ring<2>()));
}

/// Cells of layer 0 and of the transition whose corners hang.
template <int dim>
std::array<int, 2> hanging_cells(const coupling::Overlap<dim> &overlap)
{
  std::array<int, 2> n = {0, 0};
  for (const auto &cell : overlap.cells)
    n[cell.layer > 0] += cell.shape.hangs();
  return n;
}

// Interpolation of affine motion is exact: x = sum Phi x_I, and its gradient is 1.
template <int dim>
void check_interpolation(const CoupledBodiesParameters<dim> &p, bool in_transition)
{
  const auto body = make_coupled_bodies(p);
  const auto &overlap = *body.split->overlap();
  EXPECT_GT(hanging_cells(overlap)[in_transition], 0);
  const auto place = [&](int node) { return overlap.mesh.nodes[overlap.near_nodes[node]]; };
  for (const auto &m : overlap.members) {
    Vector<dim> x = -get(body.zone->state.reference, m.particle);
    Eigen::Matrix<double, dim, dim> gradient = -Eigen::Matrix<double, dim, dim>::Identity();
    for (int a = 0; a < fem::n_cell_nodes<dim>; ++a) {
      x += m.value[a] * place(m.nodes[a]);
      gradient += place(m.nodes[a]) * m.gradient.col(a).transpose();
    }
    EXPECT_LT(x.norm(), 1e-12);
    EXPECT_LT(gradient.norm(), 1e-12);
  }
  for (const auto &cell : overlap.cells)
    for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
      EXPECT_LT(
          (overlap.mesh.cell_lower[cell.cell] + cell.shape.place.col(a) - place(cell.nodes[a]))
              .norm(),
          1e-12);
}

TEST(GradedMeshes, InterpolationIsExactForAffineMotion)
{
  check_interpolation(ring<2>(), false);
  check_interpolation(band<3>(), false);
  auto later = ring<2>();
  later.fine_cells = 5;
  check_interpolation(later, true);
}

// M_c has all the mass: what the far field's cells give its nodes, cells by 1 - a, particles by a.
TEST(GradedMeshes, MassIsKept)
{
  const auto body = make_coupled_bodies(ring<2>());
  const auto &overlap = *body.split->overlap();
  double mass = 0;
  for (const auto &m : overlap.members)
    mass += m.weight * body.zone->state.mass[m.particle];
  for (const int node : overlap.near_nodes)
    mass += body.far->lumped_mass()[node];
  for (const auto &cell : overlap.cells) {
    const Vector<2> &lower = overlap.mesh.cell_lower[cell.cell],
                    &size = overlap.mesh.cell_size[cell.cell];
    constexpr int points = 40; // midpoints: wrong by (1/40)^2/24 of the weight's curvature
    for (int q = 0; q < points * points; ++q) {
      const Vector<2> s((q % points + 0.5) / points, (q / points + 0.5) / points);
      const double share = cell.layer == 0 ? 1 - overlap.weight(lower + s.cwiseProduct(size)) : 1;
      mass += share * size.prod() / (points * points);
    }
  }
  EXPECT_NEAR(body.split->near_mass().sum(), mass, 1e-4 * mass);
}

// Cells double inside the transition: the mass is consistent up to the second cell beyond the last
// fine one, where that leaves half of the transition to pass to lumped; else nothing changes.
TEST(GradedMeshes, MassIsConsistentThroughAStepInTheTransition)
{
  auto p = band<2>();
  p.overlap_cells = 3;
  p.fine_cells = 5;
  p.size[1] = 240;
  const auto check = [&](int transition_cells, int carried) {
    p.transition_cells = transition_cells;
    const auto body = make_coupled_bodies(p);
    const auto &overlap = *body.split->overlap();
    int last_fine = 0;
    for (const auto &cell : overlap.cells) {
      if (overlap.mesh.cell_level[cell.cell] == 0)
        last_fine = std::max(last_fine, cell.layer);
      EXPECT_DOUBLE_EQ(cell.consistent_share,
                       cell.layer <= carried
                           ? 1
                           : 1 - (cell.layer - carried - 0.5) / (transition_cells - carried));
    }
    return last_fine;
  };
  const int last_fine = check(3, 0);
  ASSERT_GT(last_fine, 0);
  check(2 * (last_fine + 2), last_fine + 2);
  check(2 * (last_fine + 2) - 1, 0);
}

TEST(GradedMeshes, TurningIsFree)
{
  const auto body = make_coupled_bodies(ring<2>());
  const auto &overlap = *body.split->overlap();
  const int n = overlap.n_nodes();
  Eigen::VectorXd turned(2 * n);
  for (int i = 0; i < n; ++i) {
    const Vector<2> x = overlap.mesh.nodes[overlap.near_nodes[i]];
    turned[i] = -x[1];
    turned[n + i] = x[0];
  }
  const auto &k = body.split->near_stiffness();
  EXPECT_LT((k * turned).cwiseAbs().maxCoeff(),
            1e-13 * k.diagonal().maxCoeff() * turned.maxCoeff());
}

TEST(GradedMeshes, NoiseKeepsItsEnergy)
{
  auto p = band<2>();
  p.size = {25, 104};
  p.zone_size = {100, 38};
  EXPECT_LT(std::abs(drift_of_noise(p, 1e-9, 2000)), 1e-9);
  p.split.step_ratio = 3;
  EXPECT_LT(std::abs(drift_of_noise(p, 1e-9, 3000)), 1e-3);
}

TEST(GradedMeshes, NoiseKeepsItsEnergyWithHangingNodesInTheTransition)
{
  auto p = band<2>();
  p.size = {25, 104};
  p.zone_size = {100, 38};
  p.overlap_cells = 3;
  p.fine_cells = 5;
  EXPECT_LT(std::abs(drift_of_noise(p, 1e-9, 2000)), 1e-9);
}

// The filter takes nothing from linear motion, and less than all from any other.
TEST(GradedMeshes, GapFilter)
{
  for (const bool grows : {false, true}) {
    const auto p = grows ? growing(ring<2>()) : ring<2>();
    const auto body = make_coupled_bodies(p);
    const auto &overlap = *body.split->overlap();
    const auto operators = coupling::make_blended_operators(overlap, body.zone->state,
                                                            *body.zone->force, body.far->body());
    const Eigen::MatrixXd filter =
        coupling::make_gap_filter(overlap, 4, 1.2, body.dt, operators.mass_bound);
    Eigen::VectorXd linear(overlap.n_nodes());
    for (int i = 0; i < overlap.n_nodes(); ++i)
      linear[i] = overlap.mesh.nodes[overlap.near_nodes[i]].dot(Vector<2>(1, -2));
    EXPECT_LT((filter * linear).cwiseAbs().maxCoeff(),
              1e-13 * filter.maxCoeff() * linear.maxCoeff());
    EXPECT_GT(filter.diagonal().minCoeff(), -1e-15);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(
        filter, Eigen::MatrixXd(body.split->near_mass()), Eigen::EigenvaluesOnly);
    EXPECT_LT(modes.eigenvalues().maxCoeff(), 2);
    EXPECT_GT(modes.eigenvalues().maxCoeff(), 0.01);
    EXPECT_GT(modes.eigenvalues().minCoeff(), -1e-12);
  }
}
} // namespace
} // namespace ligament
