// The static solve: what it finds is at rest under the forces of the law.
#include "packings/lattice_packing.h"
#include "particles/linear_equilibrium.h"
#include "tests/unit/dem/body.h"

#include <gtest/gtest.h>

namespace ligament::dem::testing
{
namespace
{
template <int dim>
struct Block
{
  static constexpr int dofs = n_particle_dofs<dim>;

  Packing<dim> packing;
  DemMaterial material{3, 0.3, 1, PlaneMode::strain, 0};
  Particles<dim> state;
  std::unique_ptr<ManyBodyForce<dim>> force;
  std::vector<char> is_free;
  Eigen::VectorXd motion;

  /// A cube with edges of 2 half; held are the particles that `is_held` accepts.
  template <typename IsHeld>
  Block(double half, IsHeld &&is_held)
  {
    packings::LatticeParameters<dim> lattice;
    lattice.kind = dim == 2 ? packings::LatticeKind::hexagonal : packings::LatticeKind::fcc;
    lattice.spacing = 1;
    lattice.upper.setConstant(half);
    lattice.lower = -lattice.upper;
    packing = packings::make_lattice_packing<dim>(lattice);
    packings::fill_particles(packing, material.density, state);
    force = std::make_unique<ManyBodyForce<dim>>(packing, material,
                                                 std::vector<core::BoundaryLoad<dim>>());
    for (int i = 0; i < packing.size(); ++i)
      is_free.push_back(!is_held(get(packing.centre, i)));
    motion.setZero(dofs * packing.size());
  }

  /// Largest force or torque on a free particle that moves so, less `load`.
  double unbalanced(const Eigen::VectorXd &load)
  {
    for (int i = 0; i < packing.size(); ++i) {
      set(state.displacement, i, Vector<dim>(motion.segment<dim>(dofs * i)));
      turn_by<dim>(state, i, Spin<dim>(motion.segment<n_spins<dim>>(dofs * i + dim)));
    }
    force->compute(state, 0);
    double worst = 0;
    for (int i = 0; i < packing.size(); ++i)
      if (is_free[i])
        worst =
            std::max({worst, (get(state.force, i) + load.segment<dim>(dofs * i)).norm(),
                      (get(state.torque, i) + load.segment<n_spins<dim>>(dofs * i + dim)).norm()});
    return worst;
  }
};

// Around a frame that follows an affine motion the rest follows it, too, cut cells at the surface
// are in the frame.
template <int dim>
void test_affine()
{
  using B = Block<dim>;
  const double half = dim == 2 ? 8 : 4.6;
  B block(half, [&](const Vector<dim> &x) { return x.cwiseAbs().maxCoeff() > half - 2.5; });
  Eigen::Matrix<double, dim, dim> gradient;
  for (int i = 0; i < dim * dim; ++i)
    gradient(i) = std::sin(3. * i + 1);
  Eigen::VectorXd affine = block.motion;
  int n_free = 0;
  for (int i = 0; i < block.packing.size(); ++i) {
    affine.segment<dim>(B::dofs * i) = gradient * get(block.packing.centre, i);
    if constexpr (dim == 2)
      affine[B::dofs * i + 2] = (gradient(1, 0) - gradient(0, 1)) / 2;
    else
      affine.segment<3>(B::dofs * i + 3) << (gradient(2, 1) - gradient(1, 2)) / 2,
          (gradient(0, 2) - gradient(2, 0)) / 2, (gradient(1, 0) - gradient(0, 1)) / 2;
    if (block.is_free[i])
      ++n_free;
    else
      block.motion.template segment<B::dofs>(B::dofs * i) = affine.segment<B::dofs>(B::dofs * i);
  }
  EXPECT_GT(n_free, 20);
  particles::solve_equilibrium<dim>(block.state, *block.force, block.is_free, block.motion);
  // Round-off times the condition, which is that of a block of some ten particles across.
  EXPECT_LT((block.motion - affine).cwiseAbs().maxCoeff(), 1e-12);
}

// Loads so small that what the law is not linear in, their square, is below round-off.
template <int dim>
void test_load()
{
  using B = Block<dim>;
  const double half = dim == 2 ? 8 : 2.6;
  B block(half, [&](const Vector<dim> &x) { return x[dim - 1] < -half + 1; });
  Eigen::VectorXd load = block.motion;
  constexpr double size = 1e-9;
  int pulled = 0;
  for (int i = 0; i < block.packing.size(); ++i)
    if (get(block.packing.centre, i)[dim - 1] > half - 1) {
      load.segment<B::dofs>(B::dofs * i).setLinSpaced(-size, size); // forces and torques
      ++pulled;
    }
  ASSERT_GT(pulled, 5);
  particles::solve_equilibrium<dim>(block.state, *block.force, block.is_free, block.motion, load);
  EXPECT_GT(block.motion.cwiseAbs().maxCoeff(), size / 3);
  const double largest = block.motion.cwiseAbs().maxCoeff(), stiffness = 30; // of a particle
  EXPECT_LT(block.unbalanced(load), stiffness * (largest * largest + 1e-14 * largest));
}

TEST(Equilibrium, FollowsAnAffineFrame)
{
  test_affine<2>();
  test_affine<3>();
}

TEST(Equilibrium, BalancesLoads)
{
  test_load<2>();
  test_load<3>();
}
} // namespace
} // namespace ligament::dem::testing
