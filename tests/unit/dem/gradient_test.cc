// The force is minus the gradient of the energy, walls and tractions included.
#include "packings/random_packing.h"
#include "tests/unit/dem/body.h"
#include "tests/unit/dem/force_slope.h"

#include <gtest/gtest.h>

namespace ligament::dem::testing
{
template <typename D>
struct Gradient : ::testing::Test
{
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Gradient, Dimensions);

template <int dim>
Spin<dim> some_turn(double angle)
{
  if constexpr (dim == 2)
    return Spin<2>(angle);
  else
    return angle * Vector<3>(0.3, -0.5, 0.8).normalized();
}

template <int dim>
std::vector<core::BoundaryLoad<dim>> some_loads()
{
  using Load = core::BoundaryLoad<dim>;
  Load pull, hold, press;
  pull.boundary = 3, pull.kind = Load::Kind::displacement, pull.value[1] = 0.03;
  hold.boundary = 2, hold.kind = Load::Kind::displacement;
  for (int c = 0; c < dim; ++c)
    hold.value[c] = 0.01 * c;
  press.boundary = 1, press.kind = Load::Kind::traction, press.value[0] = 0.02;
  press.value[1] = -0.01;
  return {pull, hold, press};
}

/// Moduli from 0.3 to 2 and three Poisson's ratios, one of them 0, in turns.
Materials grains(const DemMaterial &material, int n)
{
  std::vector<DemMaterial> all(3, material);
  all[1].youngs_modulus = 0.3, all[1].poissons_ratio = 0;
  all[2].youngs_modulus = 2, all[2].poissons_ratio = 0.45;
  std::vector<int> of_particle(n);
  for (int i = 0; i < n; ++i)
    of_particle[i] = (i / 2) % 3;
  return {all, of_particle};
}

/// Radii from 1 to 3, hardly relaxed.
template <int dim>
Packing<dim> small_random_packing()
{
  packings::RandomParameters<dim> p;
  p.spacing = 0.5;
  p.thickness = dim == 2 ? 0.7 : 1;
  p.size_ratio = 3;
  p.relaxation_sweeps = 2;
  p.upper.setConstant(dim == 2 ? 2.4 : 1.4);
  return packings::make_random_packing<dim>(p).packing;
}

TYPED_TEST(Gradient, ForceAndTorqueAreMinusTheGradientOfTheEnergy)
{
  constexpr int dim = TypeParam::value;
  const auto ragged = ragged_lattice<dim>(4, 7), random = small_random_packing<dim>();
  struct Setting
  {
    const Packing<dim> &packing;
    PlaneMode plane;
    bool grains; // of three materials, in every particle another one
  };
  for (const Setting &setting : {Setting{ragged, PlaneMode::strain, false},
                                 {ragged, PlaneMode::stress, false},
                                 {random, PlaneMode::stress, false},
                                 {ragged, PlaneMode::strain, true},
                                 {random, PlaneMode::stress, true}})
  {
    const auto &packing = setting.packing;
    DemMaterial material;
    material.poissons_ratio = 0.3, material.plane = setting.plane;
    ManyBodyForce<dim> force(packing, setting.grains ? grains(material, packing.size()) : material,
                             some_loads<dim>());
    auto p = at_rest(packing, material);
    // The walls don't turn with the body: a moderate turn keeps them in play.
    disturb<dim>(p, packing.spacing, 0.1, some_turn<dim>(0.4), 3);
    force.compute(p, 1.);
    // The tractions are dead loads: their potential is -S t . (u + a).
    const auto total = [&](const Particles<dim> &q) {
      double sum = force.potential_energy(q);
      for (const auto &face : packing.boundary_faces)
        if (face.boundary == 1) {
          Vector<dim> t = Vector<dim>::Zero();
          t[0] = 0.02, t[1] = -0.01;
          sum -= face.area *
                 t.dot(get(q.displacement, face.i) + Turn<dim>::of(q, face.i).change(face.lever));
        }
      return sum;
    };
    // Error h^4 E''''' plus round-off 1e-16 E / h, E of order 1.
    expect_minus_slope<dim>(p, {1e-3, 1e-3}, 1e-9, 1, 3, total);
  }
}

TYPED_TEST(Gradient, IsolatedBodyHasNoNetForceOrTorque)
{
  constexpr int dim = TypeParam::value;
  const auto packing = ragged_lattice<dim>(5, 11);
  DemMaterial material;
  material.poissons_ratio = 0.35;
  ManyBodyForce<dim> force(packing, material, {});
  auto p = at_rest(packing, material);
  disturb<dim>(p, packing.spacing, 0.1, some_turn<dim>(2.), 5);
  force.compute(p, 0.);
  Vector<dim> net = Vector<dim>::Zero();
  Spin<dim> moment = Spin<dim>::Zero();
  double scale = 0;
  for (int i = 0; i < p.size(); ++i) {
    const Vector<dim> x = get(p.reference, i) + get(p.displacement, i), f = get(p.force, i);
    net += f;
    moment += cross(x, f) + get(p.torque, i);
    scale += f.norm();
  }
  EXPECT_LT(net.norm(), 1e-15 * scale);
  EXPECT_LT(moment.norm(), 1e-14 * scale);
}

TYPED_TEST(Gradient, RigidTurnBy90DegreesGivesNoForce)
{
  constexpr int dim = TypeParam::value;
  const auto packing = ragged_lattice<dim>(5, 13);
  DemMaterial material;
  material.poissons_ratio = 0.3;
  ManyBodyForce<dim> force(packing, material, {});
  auto p = at_rest(packing, material);
  disturb<dim>(p, packing.spacing, 0., some_turn<dim>(M_PI / 2), 5);
  force.compute(p, 0.);
  // Displacements are of the size of the body, 2.5: round-off of Du is 1e-15.
  for (int i = 0; i < p.size(); ++i) {
    EXPECT_LT(get(p.force, i).norm(), 1e-14);
    EXPECT_LT(get(p.torque, i).norm(), 1e-14);
  }
  EXPECT_LT(force.potential_energy(p), 1e-26);
}

TYPED_TEST(Gradient, TangentIsTheDerivativeOfTheForce)
{
  constexpr int dim = TypeParam::value;
  constexpr int dofs = n_particle_dofs<dim>;
  const auto packing = ragged_lattice<dim>(4, 17);
  DemMaterial material;
  material.poissons_ratio = 0.3;
  auto loads = some_loads<dim>();
  for (auto &load : loads) // supports that stand still
    for (auto &v : load.value)
      if (v)
        v = 0.;
  ManyBodyForce<dim> force(packing, material, loads);
  auto p = at_rest(packing, material);
  // Motions far below everything: the force is linear to round-off.
  disturb<dim>(p, packing.spacing, 1e-12, Spin<dim>::Zero(), 5);
  Eigen::VectorXd q(dofs * p.size()), f = Eigen::VectorXd::Zero(q.size());
  for (int i = 0; i < p.size(); ++i) {
    q.segment<dim>(dofs * i) = get(p.displacement, i);
    for (int c = 0; c < n_spins<dim>; ++c)
      q[dofs * i + dim + c] = dim == 2 ? p.rotation[0][i] : 2 * p.rotation[dim == 2 ? 0 : c + 1][i];
  }
  force.add_tangent(p, [&](const particles::QuadraticTerm<dim> &term) {
    Eigen::VectorXd local(term.rows.cols());
    for (std::size_t m = 0; m < term.members.size(); ++m)
      local.segment<dofs>(dofs * m) = q.segment<dofs>(dofs * term.members[m]);
    const Eigen::VectorXd g =
        term.rows.transpose() * (term.stiffness.cwiseProduct(term.rows * local));
    for (std::size_t m = 0; m < term.members.size(); ++m)
      f.segment<dofs>(dofs * term.members[m]) -= g.segment<dofs>(dofs * m);
  });
  force.compute(p, 0.);
  const double scale = f.lpNorm<Eigen::Infinity>();
  for (int i = 0; i < p.size(); ++i) {
    EXPECT_LT((get(p.force, i) - f.segment<dim>(dofs * i)).norm(), 1e-11 * scale);
    EXPECT_LT((get(p.torque, i) - f.segment<n_spins<dim>>(dofs * i + dim)).norm(), 1e-11 * scale);
  }
}
} // namespace ligament::dem::testing
