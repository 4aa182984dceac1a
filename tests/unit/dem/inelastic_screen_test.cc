// The screen of whole cells: long lattices, whose inner blocks have no open cell, keep their state
// from half of the limit on, whatever the direction of their strain.
#include "packings/lattice_packing.h"
#include "tests/unit/dem/inelastic_bodies.h"

#include <random>

namespace ligament::dem::testing
{
template <int dim>
Packing<dim> long_bar()
{
  packings::LatticeParameters<dim> lattice;
  lattice.kind = dim == 2 ? packings::LatticeKind::hexagonal : packings::LatticeKind::fcc;
  lattice.spacing = 1;
  lattice.lower = -3 * Vector<dim>::Ones();
  lattice.upper = 3 * Vector<dim>::Ones();
  lattice.upper[0] += 800; // rows longer than two blocks
  return packings::make_lattice_packing<dim>(lattice);
}

/// Of an isotropic material of E = 1 in plane strain.
template <int dim>
double share_of(const Plasticity &law, const Eigen::Matrix<double, dim, dim> &strain, double nu)
{
  const double shear = 0.5 / (1 + nu), pressure = nu / ((1 + nu) * (1 - 2 * nu)) * strain.trace();
  Strain<dim> stress;
  for (int a = 0; a < dim; ++a)
    for (int b = a; b < dim; ++b)
      stress[in_plane_place<dim>(a, b)] = 2 * shear * strain(a, b) + (a == b ? pressure : 0);
  return flow_share<dim>(law, stress, pressure);
}

template <int dim>
void expect_state_from_half_of_the_limit_on()
{
  using Matrix = Eigen::Matrix<double, dim, dim>;
  const auto packing = long_bar<dim>();
  constexpr double nu = 0.3;
  YieldCurve curve;
  curve.initial = 1e-4;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Matrix> directions = {Matrix::Identity()}; // a cone is nearest so
  for (int k = 0; k < 3; ++k) {
    const Matrix m = Matrix::NullaryExpr([&] { return uniform(random); });
    directions.push_back(m + m.transpose());
  }
  for (const Plasticity &law :
       {Plasticity(VonMisesFlow{curve}), Plasticity(DruckerPragerFlow{1e-4, 0, 0.8, 0.2})})
    for (const Matrix &direction : directions)
      for (const double share : {0.52, 1.1}) {
        const double now = share_of<dim>(law, direction, nu);
        if (now < 1e-3 * direction.norm())
          continue; // towards the axis of the surface
        DemMaterial material{1., nu, 1., PlaneMode::strain, 0};
        material.plasticity = law;
        ManyBodyForce<dim> force(packing, material, {});
        auto p = at_rest(packing, material);
        for (int i = 0; i < p.size(); ++i) {
          const Vector<dim> u = share / now * direction * get(p.reference, i);
          for (int c = 0; c < dim; ++c)
            p.displacement[c][i] = u[c];
        }
        force.compute(p, 1.);
        int n_inner = 0;
        for (int i = 0; i < p.size(); ++i) {
          const Vector<dim> x = get(packing.centre, i);
          if (x.tail(dim - 1).cwiseAbs().maxCoeff() > 1.5 || x[0] < 10 || x[0] > 790)
            continue; // near the sides
          ASSERT_TRUE(force.strains().is_strained(i)) << law.index() << ' ' << share;
          if (share > 1) {
            ASSERT_GT(force.strains().history(i), 0) << law.index();
          }
          ++n_inner;
        }
        EXPECT_GT(n_inner, 1000);
      }
}

TEST(InelasticScreen, KeepsStateFromHalfOfTheLimitOn2d)
{
  expect_state_from_half_of_the_limit_on<2>();
}
TEST(InelasticScreen, KeepsStateFromHalfOfTheLimitOn3d)
{
  expect_state_from_half_of_the_limit_on<3>();
}
} // namespace ligament::dem::testing
