// The stable step is that of the largest eigenvalue of the linearised body.
#include "tests/unit/dem/cases.h"

#include <Eigen/Eigenvalues>

namespace ligament::dem::testing
{
template <typename C>
struct StableStep : ::testing::Test
{
};
TYPED_TEST_SUITE(StableStep, Cases);

TYPED_TEST(StableStep, OnePercentBelowTheDenseEigenvalue)
{
  constexpr int dim = TypeParam::dim, dofs = n_particle_dofs<dim>;
  const auto packing = packings::make_lattice_packing<dim>(box<TypeParam>(dim == 2 ? 8 : 3));
  std::vector<core::BoundaryLoad<dim>> loads(1);
  loads[0].boundary = 2;
  loads[0].kind = core::BoundaryLoad<dim>::Kind::displacement;
  loads[0].value[1] = 5.; // the step doesn't depend on it
  DemMaterial material{7e10, 0.3, 2500, PlaneMode::strain, 0};
  ManyBodyForce<dim> force(packing, material, loads);
  Particles<dim> p;
  packings::fill_particles(packing, material.density, p);
  p.mass[3] = std::numeric_limits<double>::infinity(); // held
  const int n = dofs * p.size();
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n, n);
  force.add_tangent(p, [&](const particles::QuadraticTerm<dim> &term) {
    const Eigen::MatrixXd m = term.rows.transpose() * term.stiffness.asDiagonal() * term.rows;
    for (std::size_t a = 0; a < term.members.size(); ++a)
      for (std::size_t b = 0; b < term.members.size(); ++b)
        k.block<dofs, dofs>(dofs * term.members[a], dofs * term.members[b]) +=
            m.block<dofs, dofs>(dofs * a, dofs * b);
  });
  Eigen::VectorXd weight(n);
  for (int i = 0; i < p.size(); ++i)
    for (int c = 0; c < dofs; ++c)
      weight[dofs * i + c] = std::sqrt(c < dim ? p.inverse_mass(i) : p.inverse_inertia(i));
  const Eigen::MatrixXd scaled = weight.asDiagonal() * k * weight.asDiagonal();
  const double omega =
      std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly)
                    .eigenvalues()
                    .maxCoeff());
  EXPECT_NEAR(force.stable_step(p) * omega / 2, 1 / 1.01, 1e-4);
  EXPECT_EQ(force.stable_step(p), force.stable_step(p));
}

TEST(StableStep, HexagonalRule)
{
  // Rotation governs: the highest mode turns neighbours against each other; 0.354 d/c_s without
  // bending, a little less with it and with the smaller cells of the rim.
  using C = Case<2, Kind::hexagonal, false>;
  const auto lattice = box<C>(30);
  const auto packing = packings::make_lattice_packing<2>(lattice);
  DemMaterial material{7e10, 0.3, 2500, PlaneMode::strain, 0};
  ManyBodyForce<2> force(packing, material, {});
  Particles<2> p;
  packings::fill_particles(packing, material.density, p);
  const double rule = 0.354 * lattice.spacing / force.elastic_constants().wave_speed_s;
  EXPECT_LT(force.stable_step(p), 1.01 * rule);
  EXPECT_GT(force.stable_step(p), 0.8 * rule);
}
} // namespace ligament::dem::testing
