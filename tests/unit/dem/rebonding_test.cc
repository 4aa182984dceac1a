// Contacts that become bonds again: nothing jumps, forces are a gradient, energies add up over many
// cycles, adhesion ends at its strength, states go on to the bit, numbering changes nothing.
#include "tests/unit/dem/cases.h"
#include "tests/unit/dem/run.h"

#include <gtest/gtest.h>

namespace ligament::dem::testing
{
namespace
{
template <typename D>
struct Rebonded : ::testing::Test
{
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Rebonded, Dimensions);

/// A block a third of whose faces are cracked, pressed, sheared and turned.
template <int dim>
struct Pressed
{
  Packing<dim> packing = ragged_lattice<dim>(4, 7);
  DemMaterial material{1., 0.3, 1., PlaneMode::strain, 0.4};
  FractureLaw law;
  std::unique_ptr<ManyBodyForce<dim>> force;
  Particles<dim> p;

  explicit Pressed(bool flows, double poissons_ratio = 0.3)
  {
    material.poissons_ratio = poissons_ratio;
    if (flows)
      material.plasticity = VonMisesFlow{{10., 0., 0., 0., {}, {}}}; // never reached
    law.rebonding = {{1e-3, 0, 0.05}};
    int n = 0;
    for (auto &face : packing.faces)
      face.cracked = n++ % 3 == 0;
    force = make();
    p = at_rest(packing, material);
    if (flows)
      for (int i = 0; i < p.size(); ++i) {
        typename InelasticStrains<dim>::Tensor e;
        for (int c = 0; c < e.size(); ++c)
          e[c] = 2e-2 * std::sin(3. * i + c);
        force->strains().set_strain(i, e);
      }
    move(1);
  }
  std::unique_ptr<ManyBodyForce<dim>> make() const
  {
    return std::make_unique<ManyBodyForce<dim>>(packing, material,
                                                std::vector<core::BoundaryLoad<dim>>(), law);
  }
  /// Further and further from rest; at 1 pressed together.
  void move(double by)
  {
    for (int i = 0; i < p.size(); ++i) {
      const Vector<dim> x = get(p.reference, i);
      Vector<dim> u = -0.02 * x;
      u[0] += 4e-3 * packing.spacing * by * std::sin(7 * x[1] + 3 * x[0]);
      u[1] += 6e-3 * packing.spacing * by * std::cos(5 * x[0]);
      set(p.displacement, i, u);
      const double angle = 0.02 + 3e-3 * by * std::sin(3 * x[0] + 2 * x[1]);
      if constexpr (dim == 2)
        p.rotation[0][i] = angle;
      else {
        const Vector<3> axis = Vector<3>(std::sin(i), 1, 0.5).normalized();
        p.rotation[0][i] = std::cos(angle / 2);
        for (int c = 0; c < 3; ++c)
          p.rotation[c + 1][i] = std::sin(angle / 2) * axis[c];
      }
    }
  }
};

template <int dim>
double difference(const Particles<dim> &a, const Particles<dim> &b, double lever)
{
  double largest = 0, error = 0;
  for (int i = 0; i < a.size(); ++i) {
    largest = std::max(largest, get(a.force, i).norm());
    error = std::max({error, (get(a.force, i) - get(b.force, i)).norm(),
                      (get(a.torque, i) - get(b.torque, i)).norm() / lever});
  }
  return error / largest;
}

TYPED_TEST(Rebonded, NothingJumps)
{
  constexpr int dim = TypeParam::value;
  for (const bool flows : {false, true})
    for (const double nu : {0., 0.3, 0.45}) {
      Pressed<dim> body(flows, nu);
      auto &force = *body.force;
      force.compute(body.p, 1);
      const auto before = body.p;
      const double energy = force.potential_energy(body.p), friction = force.frictional_work();
      ASSERT_EQ(force.rebonded().n_bonds(), 0);
      ASSERT_GT(force.rebonded().all().size(), 4u);
      Components<n_strains<dim>> stress, stress_after;
      force.stresses(body.p, stress);
      force.compute(body.p, 2);
      ASSERT_EQ(force.rebonded().n_bonds(), int(force.rebonded().all().size()));
      EXPECT_LT(difference(before, body.p, body.packing.spacing), 1e-13) << flows << ' ' << nu;
      EXPECT_EQ(force.frictional_work(), friction);
      EXPECT_NE(force.rebonding_energy(), 0);
      EXPECT_NEAR(force.potential_energy(body.p) + force.rebonding_energy(), energy, 1e-13 * energy)
          << flows << ' ' << nu;
      force.stresses(body.p, stress_after);
      for (int c = 0; c < n_strains<dim>; ++c)
        for (int i = 0; i < body.p.size(); ++i)
          EXPECT_NEAR(stress[c][i], stress_after[c][i], 1e-12);
    }
}

TYPED_TEST(Rebonded, ForceIsMinusTheGradient)
{
  constexpr int dim = TypeParam::value;
  for (const bool flows : {false, true}) {
    Pressed<dim> body(flows);
    auto &force = *body.force;
    force.compute(body.p, 1);
    force.compute(body.p, 2);
    ASSERT_GT(force.rebonded().n_bonds(), 4);
    body.move(2.5);
    auto p = body.p;
    force.compute(p, 3);
    force.compute(p, 3);
    const double h = 1e-5;
    const auto derivative = [&](auto &&change) {
      double sum = 0;
      for (const auto &[step, weight] :
           {std::pair{-2., 1. / 12}, {-1., -8. / 12}, {1., 8. / 12}, {2., -1. / 12}})
      {
        auto q = p;
        change(q, step * h);
        sum += weight * force.potential_energy(q) / h;
      }
      return sum;
    };
    double scale = 0;
    Vector<dim> net = Vector<dim>::Zero();
    for (int i = 0; i < p.size(); ++i) {
      scale = std::max(scale, get(p.force, i).norm());
      net += get(p.force, i);
    }
    EXPECT_LT(net.norm(), 1e-13 * scale);
    for (int i = 0; i < p.size(); ++i) {
      for (int c = 0; c < dim; ++c)
        EXPECT_NEAR(p.force[c][i],
                    -derivative([&](auto &q, double s) { q.displacement[c][i] += s; }),
                    1e-8 * scale)
            << flows;
      for (int c = 0; c < n_spins<dim>; ++c)
        EXPECT_NEAR(p.torque[c][i], -derivative([&](auto &q, double s) {
                      turn_by<dim>(q, i, s * Spin<dim>::Unit(c));
                    }),
                    1e-8 * scale)
            << flows;
    }
  }
}
} // namespace
} // namespace ligament::dem::testing
