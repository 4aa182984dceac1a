// Strains of the particles' own: kernels against the oracle on every kind of body, forces are the
// gradient at frozen strains, affine ones cost nothing, one call flows once, the balance closes.
#include "core/extremes.h"
#include "tests/oracle/inelastic_oracle.h"
#include "tests/unit/dem/force_slope.h"
#include "tests/unit/dem/free_flight.h"
#include "tests/unit/dem/inelastic_bodies.h"

#include <fmt/format.h>

namespace ligament::dem::testing
{
template <typename D>
struct Inelastic : ::testing::Test
{
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Inelastic, Dimensions);

std::vector<Plasticity> laws()
{
  YieldCurve linear, voce, table;
  linear.initial = 0.004, linear.hardening = 0.3;
  voce.initial = 0.003, voce.hardening = 0.05, voce.saturation = 0.01, voce.rate = 60;
  table.strain = {0, 0.002, 0.01}, table.stress = {0.003, 0.006, 0.009};
  return {VonMisesFlow{linear}, VonMisesFlow{voce}, VonMisesFlow{table}, DruckerPragerFlow{0.004, 0.1, 0.5, 0.3},
          DruckerPragerFlow{0.003, 0, 0.8, 0}, DruckerPragerFlow{0.004, -0.1, 0.5, 0.3},
          DruckerPragerFlow{0.004, -0.2, 0.3, 0}};
}

/// Random states one after the other, each turned further.
template <int dim>
void expect_like_oracle(const Packing<dim> &packing, const Plasticity &law, PlaneMode plane,
                        double nu)
{
  DemMaterial material{1., nu, 1., plane, 0};
  material.plasticity = law;
  ManyBodyForce<dim> force(packing, material, {});
  material.plasticity = {};
  ManyBodyForce<dim> elastic(packing, material, {});
  oracle::InelasticOracle<dim> oracle(packing, material.youngs_modulus, nu, law, plane);
  int n_flowed = 0;
  double largest = 0, error = 0;
  for (int step = 1; step <= 4; ++step) {
    Particles<dim> p = at_rest(packing, material);
    disturb<dim>(p, packing.spacing, 0.02, Spin<dim>::Constant(0.2 * step), 3 + step);
    if (step == 3)
      continue; // a state that nobody looks at
    Particles<dim> q = p;
    force.compute(p, step);
    oracle.flow(p);
    // Bending and contacts are the elastic body's.
    elastic.compute(q, step);
    const auto expected = oracle.forces(p),
               bare = oracle::InelasticOracle<dim>(packing, 1., nu, {}, plane).forces(p);
    for (int i = 0; i < p.size(); ++i) {
      Eigen::VectorXd now(dim + n_spins<dim>), without(now.size());
      now << get(p.force, i), get(p.torque, i) / packing.spacing;
      without << get(q.force, i), get(q.torque, i) / packing.spacing;
      Eigen::VectorXd change = expected[i] - bare[i];
      change.tail(n_spins<dim>) /= packing.spacing;
      keep_largest(largest, now.norm());
      keep_largest(error, (now - without - change).norm());
      n_flowed += oracle.history[i] > 0;
      EXPECT_NEAR(force.strains().history(i), oracle.history[i], 1e-11);
      const auto e = force.strains().tensor(i);
      for (int a = 0; a < dim; ++a)
        for (int b = a; b < dim; ++b)
          EXPECT_NEAR(e[tensor_place<dim>(a, b)], oracle.strain[i](a, b), 1e-11);
      if (dim == 2) {
        EXPECT_NEAR(e[2], oracle.strain[i](2, 2), 1e-11);
      }
    }
  }
  EXPECT_LT(error, 1e-11 * largest);
  EXPECT_GT(n_flowed, packing.size()); // of three looks
}

TYPED_TEST(Inelastic, IsTheOracleOnLatticesAndRandomPackings)
{
  constexpr int dim = TypeParam::value;
  const auto lattice = lattice_body<dim>(), random = random_body<dim>();
  for (const Plasticity &law : laws())
    for (const double nu : {0., 0.3})
      for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress}) {
        if (dim == 3 && plane == PlaneMode::stress)
          continue;
        SCOPED_TRACE(fmt::format("law {} nu {} plane {}", law.index(), nu, int(plane)));
        expect_like_oracle<dim>(lattice, law, plane, nu);
        expect_like_oracle<dim>(random, law, plane, nu);
      }
}

/// Never flows, but has room for strains.
Plasticity far_away()
{
  YieldCurve curve;
  curve.initial = 1e9;
  return VonMisesFlow{curve};
}

TYPED_TEST(Inelastic, ForcesAreTheGradientAtFrozenStrains)
{
  constexpr int dim = TypeParam::value;
  for (const auto &packing : {ragged_lattice<dim>(4, 7), random_body<dim>()})
    for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress}) {
      DemMaterial material;
      material.poissons_ratio = 0.3, material.plane = plane;
      material.plasticity = far_away();
      ManyBodyForce<dim> force(packing, material, pull_and_press<dim>());
      set_random_strains(force, packing.size(), 0.1);
      auto p = at_rest(packing, material);
      disturb<dim>(p, packing.spacing, 0.02, Spin<dim>::Constant(0.3), 3);
      force.compute(p, 1.);
      const auto total = [&](const Particles<dim> &q) { // the tractions are dead loads
        double sum = force.potential_energy(q);
        for (const auto &face : packing.boundary_faces)
          if (face.boundary == 1) {
            const Vector<dim> lever =
                face.lever + force.strains().strain(face.i) * face.lever;
            sum -= face.area * (0.02 * Vector<dim>::Unit(0) - 0.01 * Vector<dim>::Unit(1))
                                   .dot(get(q.displacement, face.i) + lever +
                                        Turn<dim>::of(q, face.i).change(lever));
          }
        return sum;
      };
      expect_minus_slope<dim>(p, {1e-3 * packing.spacing, 1e-3}, 1e-9, packing.spacing,
                              1 + p.size() / 20, total);
    }
}

// A body that has taken a uniform strain of its own is free of forces in the shape that this gives
// it, in any orientation.
TYPED_TEST(Inelastic, UniformStrainsCostNothing)
{
  constexpr int dim = TypeParam::value;
  for (const auto &packing : {lattice_body<dim>(0), random_body<dim>(0)}) {
    DemMaterial material{1., 0.3, 1., PlaneMode::strain, 0};
    material.plasticity = far_away();
    ManyBodyForce<dim> force(packing, material, {});
    auto p = at_rest(packing, material);
    typename InelasticStrains<dim>::Tensor e;
    for (int c = 0; c < e.size(); ++c)
      e[c] = 0.01 * (c + 1) * (c % 2 ? -1 : 1);
    if (dim == 2)
      e[2] = 0;
    for (int i = 0; i < p.size(); ++i) {
      force.strains().set_strain(i, e);
      turn_by<dim>(p, i, Spin<dim>::Constant(0.7));
      const Vector<dim> x = get(p.reference, i), y = x + force.strains().strain(i) * x;
      set(p.displacement, i, Vector<dim>(y + Turn<dim>::of(p, i).change(y) - x));
    }
    force.compute(p, 1.);
    const double unit = 0.05 * std::pow(packing.spacing, dim - 1);
    std::vector<char> is_outer(p.size(), 0);
    for (const auto &face : packing.boundary_faces)
      is_outer[face.i] = 1;
    for (int i = 0; i < p.size(); ++i) {
      EXPECT_LT(get(p.force, i).norm(), 1e-12 * unit);
      // Open cells with levers off the normal: second order in the strain.
      const double least = is_outer[i] ? 0.05 : 1e-12;
      EXPECT_LT(get(p.torque, i).norm(), least * unit * packing.spacing);
    }
    EXPECT_LT(std::abs(force.potential_energy(p)),
              1e-12 * unit * packing.spacing * p.size());
  }
}

// However often a time is looked at, particles flow once, and looks leave nothing behind.
TYPED_TEST(Inelastic, LooksChangeNoBit)
{
  constexpr int dim = TypeParam::value;
  for (const auto &packing : {lattice_body<dim>(), random_body<dim>()})
    for (const Plasticity &law : laws()) {
      DemMaterial material{1., 0.3, 1., PlaneMode::strain, 0};
      material.plasticity = law;
      ManyBodyForce<dim> force(packing, material, {});
      auto p = at_rest(packing, material);
      disturb<dim>(p, packing.spacing, 0.02, Spin<dim>::Zero(), 3);
      for (const double time : {1., 2.}) {
        force.compute(p, time);
        ASSERT_GT(force.plastic_dissipation(), 0);
        const auto first = p;
        std::vector<double> history;
        const double taken = force.plastic_dissipation();
        for (int i = 0; i < p.size(); ++i)
          history.push_back(force.strains().history(i));
        force.potential_energy(p);
        Components<n_strains<dim>> stress;
        force.stresses(p, stress);
        force.compute(p, time);
        EXPECT_EQ(p.force, first.force);
        EXPECT_EQ(p.torque, first.torque);
        EXPECT_EQ(force.plastic_dissipation(), taken);
        for (int i = 0; i < p.size(); ++i)
          EXPECT_EQ(force.strains().history(i), history[i]);
      }
    }
}

Plasticity scaled(Plasticity law, double scale)
{
  if (auto *mises = std::get_if<VonMisesFlow>(&law)) {
    mises->yield.initial *= scale, mises->yield.saturation *= scale;
    for (double &s : mises->yield.stress)
      s *= scale;
  }
  if (auto *prager = std::get_if<DruckerPragerFlow>(&law))
    prager->cohesion *= scale;
  return law;
}

TYPED_TEST(Inelastic, DissipationClosesTheBalance)
{
  constexpr int dim = TypeParam::value;
  const auto lattice = lattice_body<dim>(), random = random_body<dim>();
  // Exact for forces that are linear in the motion: what is left is of the order of the strain.
  for (const auto &packing : {lattice, random})
    for (const Plasticity &law : laws())
      for (const double scale : {1e-6, 1e-4}) {
        DemMaterial material{1., 0.3, 1, PlaneMode::strain, 0};
        material.plasticity = scaled(law, 1500 * scale);
        const auto [start, missing, losses] = fly<dim>(packing, material, scale, 150);
        EXPECT_GT(losses.plastic, 0.002 * start);
        EXPECT_LT(losses.plastic, start);
        EXPECT_NEAR(missing / start, 0, 30 * scale) << law.index() << " " << scale;
      }
}
} // namespace ligament::dem::testing
