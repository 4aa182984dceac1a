// Bodies that flow against the continuum: a strip in tension, its unloading; Drucker and Prager
// under confinement; a body that turns between its load steps.
#include "particles/particle_solver.h"
#include "tests/unit/dem/inelastic_bodies.h"

#include <fmt/format.h>

namespace ligament::dem::testing
{
using Stress = Eigen::Vector3d; // along, across, out of the plane: principal, Pa

/// Uniaxial tension with free sides of a material with linear hardening, in plane strain or stress:
/// von Mises' flow in small steps, the sides free by a fixed point.
double continuum_stress(const DemMaterial &material, const YieldCurve &law, double strain)
{
  const double nu = material.poissons_ratio, g = material.shear_modulus(),
               lambda = material.youngs_modulus * nu / ((1 + nu) * (1 - 2 * nu));
  const bool is_plane_strain = material.plane == PlaneMode::strain;
  Stress flow = Stress::Zero(), total = Stress::Zero(), stress;
  double history = 0;
  const auto find_stress = [&] {
    const Stress elastic = total - flow;
    stress = 2 * g * elastic + lambda * elastic.sum() * Stress::Ones();
  };
  const int steps = 4000;
  for (int s = 1; s <= steps; ++s) {
    total[0] = strain * s / steps;
    for (int k = 0; k < 60; ++k) {
      find_stress();
      total[1] -= stress[1] / (lambda + 2 * g);
      if (!is_plane_strain) {
        find_stress();
        total[2] -= stress[2] / (lambda + 2 * g);
      }
      find_stress();
      const Stress deviator = stress - stress.mean() * Stress::Ones();
      const double equivalent = std::sqrt(1.5) * deviator.norm(),
                   excess = equivalent - law.at(history);
      if (excess > 0) {
        const double increment = excess / (3 * g + law.hardening);
        flow += 1.5 * increment / equivalent * deviator;
        history += increment;
      }
    }
  }
  find_stress();
  return stress[0];
}

/// Mean stress of the pulled end over that of the continuum, less 1.
double strip_error(Kind kind, PlaneMode plane, double across, bool is_random = false)
{
  packings::LatticeParameters<2> lattice;
  lattice.kind = kind;
  lattice.spacing = 1;
  lattice.upper = {12, across};
  packings::RandomParameters<2> seeds;
  seeds.spacing = 1;
  seeds.upper = lattice.upper;
  const auto packing = is_random ? packings::make_random_packing<2>(seeds).packing
                                 : packings::make_lattice_packing<2>(lattice);
  DemMaterial material{1., 0.3, 1, plane, 0};
  YieldCurve curve;
  curve.initial = 2e-3, curve.hardening = 0.1;
  material.plasticity = VonMisesFlow{curve};
  const double strain = 0.01, duration = 2000;
  std::vector<core::BoundaryLoad<2>> loads(2);
  loads[0].boundary = 0, loads[0].value[0] = 0.;
  loads[1].boundary = 1, loads[1].value[0] = strain * 12;
  for (auto &load : loads)
    load.kind = core::BoundaryLoad<2>::Kind::displacement;
  loads[1].history = core::Ramp{duration};
  Particles<2> p;
  packings::fill_particles(packing, 1., p);
  auto f = std::make_unique<ManyBodyForce<2>>(packing, material, loads);
  auto &force = *f;
  particles::ParticleSolver<2> solver(std::move(p), std::move(f));
  const double dt = 0.9 * force.stable_step(solver.state);
  for (int i = 0; i < solver.state.size(); ++i)
    solver.state.velocity[0][i] = strain / duration * solver.state.reference[0][i];
  for (double time = 0; time < duration + 200; time += dt) {
    solver.compute_forces(time);
    solver.kick(dt);
    solver.scale_velocities(time < duration ? 0.999 : 0.98);
    solver.drift(dt);
  }
  const double stress = force.reaction(1)[0] / across;
  return stress / continuum_stress(material, curve, strain) - 1;
}

// Square cells fill the sides exactly: 0.1 % is asked of six across, in small steps. Hexagonal rows
// end in half cells, random cells are clipped: their errors fall with the number across.
TEST(InelasticStrip, TensionFollowsTheContinuum)
{
  EXPECT_NEAR(strip_error(Kind::square, PlaneMode::strain, 6), 0, 1e-3);
  EXPECT_NEAR(strip_error(Kind::square, PlaneMode::stress, 6), 0, 1e-3);
  EXPECT_NEAR(strip_error(Kind::square, PlaneMode::strain, 6, true), 0, 0.02);
  const double rows = 6 * std::sqrt(3.) / 2;
  for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress}) {
    const double six = strip_error(Kind::hexagonal, plane, rows),
                 twelve = strip_error(Kind::hexagonal, plane, 2 * rows);
    EXPECT_LT(std::abs(six), 5e-3);
    EXPECT_LT(std::abs(twelve), std::abs(six));
  }
}

template <typename D>
struct InelasticBody : ::testing::Test
{
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(InelasticBody, Dimensions);

// Prescribed strains of an inner cell of any packing: stress and volume follow the closed form of
// the cone, on its flank and at its apex.
TYPED_TEST(InelasticBody, DruckerPragerKeepsToItsConeAndDilates)
{
  constexpr int dim = TypeParam::value;
  DemMaterial material{1., 0.25, 1., PlaneMode::strain, 0};
  const DruckerPragerFlow law{1e-3, 0, 0.6, 0.35};
  material.plasticity = law;
  const double g = material.shear_modulus(), k = 1 / (3 * (1 - 2 * material.poissons_ratio));
  packings::RandomParameters<dim> seeds;
  seeds.spacing = 1;
  seeds.upper.setConstant(dim == 2 ? 8 : 5);
  for (const auto &packing :
       {packings::make_lattice_packing<dim>(
            box<Case<dim, dim == 2 ? Kind::hexagonal : Kind::fcc, true>>(dim == 2 ? 9 : 5)),
        packings::make_random_packing<dim>(seeds).packing})
  {
    ManyBodyForce<dim> force(packing, material, {});
    auto p = at_rest(packing, material);
    const int inner = inner_particle(p);
    const double volume = -2e-3, shear = 8e-3; // pressed, then sheared
    Eigen::Matrix<double, dim, dim> pressed = Eigen::Matrix<double, dim, dim>::Identity(),
                                    sheared = Eigen::Matrix<double, dim, dim>::Zero();
    pressed *= volume / dim;
    sheared(0, 1) = sheared(1, 0) = shear / 2;
    const int steps = 40;
    for (int s = 1; s <= steps; ++s) {
      deform<dim>(p, pressed + double(s) / steps * sheared, Spin<dim>::Zero());
      force.compute(p, s);
    }
    const auto e = force.strains().tensor(inner);
    const double gamma = force.strains().history(inner);
    // Shear strain that flow took, and how much it swelled: dilatancy times that.
    EXPECT_GT(gamma, 0.2 * shear);
    EXPECT_NEAR(e.template head<3>().sum(), law.dilatancy * gamma, 1e-12);
    // f = 0 with the stress of what is left.
    const double zz = dim == 2 ? 0. : pressed(dim - 1, dim - 1);
    const Eigen::Vector3d elastic(pressed(0, 0) - e[0], pressed(1, 1) - e[1], zz - e[2]);
    const double mean = k * elastic.sum();
    const Eigen::Vector3d deviator = elastic - elastic.mean() * Eigen::Vector3d::Ones();
    const double xy = shear / 2 - e[dim == 2 ? 3 : 5];
    const double tau = g * std::sqrt(2 * deviator.squaredNorm() + 4 * xy * xy);
    EXPECT_NEAR(law.friction * mean + tau, law.cohesion, 1e-9);

    ManyBodyForce<dim> pulled(packing, material, {});
    deform<dim>(p, 5e-3 * Eigen::Matrix<double, dim, dim>::Identity(), Spin<dim>::Zero());
    for (int s = 1; s <= 3; ++s) // in the plane, sigma_zz differs: the flank first
      pulled.compute(p, s);
    const auto a = pulled.strains().tensor(inner);
    Eigen::Vector3d left = 5e-3 * Eigen::Vector3d::Ones() - Eigen::Vector3d(a[0], a[1], a[2]);
    if (dim == 2)
      left[2] = -a[2];
    EXPECT_NEAR(k * left.sum(), law.cohesion / law.friction, 1e-9);
    EXPECT_LT((left - left.mean() * Eigen::Vector3d::Ones()).norm(), 1e-9);
  }
}

// In plane stress a step returns to the cone at once, too, whatever nu, however much the material
// swells or softens, pulled, pressed or sheared: what is left of f is a small part of what the step
// brought, and no step goes past the cone.
TEST(InelasticStrip, DilatingFlowInPlaneStressKeepsToItsCone)
{
  packings::LatticeParameters<2> lattice;
  lattice.kind = Kind::hexagonal;
  lattice.spacing = 1;
  lattice.upper = {8, 8};
  const auto packing = packings::make_lattice_packing<2>(lattice);
  const double strain = 8e-3;
  const std::vector<Eigen::Vector2d> ways = {{1, 0},   {1, 1},    {1, -1},    {-1, 0},
                                             {-1, -1}, {-1, 0.4}, {-1, -0.4}, {0.2, -1}};
  for (const double nu : {0.2, 0.45, 0.49})
    for (const DruckerPragerFlow &law :
         {DruckerPragerFlow{1e-3, 0, 0.8, 0.8}, DruckerPragerFlow{1e-3, 0, 0.5, 0.5},
          DruckerPragerFlow{1e-3, 0.1, 0.5, 0.1}, DruckerPragerFlow{1e-3, -0.02, 0.5, 0.2}})
      for (const Eigen::Vector2d &way : ways)
        for (const int steps : {2, 20, 400}) {
          DemMaterial material{1., nu, 1., PlaneMode::stress, 0};
          material.plasticity = law;
          ManyBodyForce<2> force(packing, material, {});
          auto p = at_rest(packing, material);
          const int inner = inner_particle(p);
          const double brought = strain / steps / (1 - nu);
          for (int s = 1; s <= steps; ++s) {
            deform<2>(p, strain * s / steps * Eigen::Matrix2d(way.asDiagonal()), Spin<2>::Zero());
            force.compute(p, s);
            const auto e = force.strains().tensor(inner);
            const double history = force.strains().history(inner);
            const Eigen::Vector2d elastic = strain * s / steps * way - e.template head<2>();
            const Eigen::Vector3d stress(elastic[0] + nu * elastic[1], elastic[1] + nu * elastic[0],
                                         0);
            const Eigen::Vector3d of_plane = stress / (1 - nu * nu);
            const double mean = of_plane.mean(),
                         tau = (of_plane - mean * Eigen::Vector3d::Ones()).norm() / std::sqrt(2.),
                         yield = std::max(law.cohesion + law.hardening * history, 0.),
                         excess = law.friction * mean + tau - yield;
            const std::string place =
                fmt::format("nu {}, b {}, H {}, way ({}, {}), step {} of {}", nu, law.friction,
                            law.hardening, way[0], way[1], s, steps);
            EXPECT_LT(excess, (steps == 400 ? 0.05 : steps == 20 ? 0.5 : 1) * brought) << place;
            if (history > 0 && e.norm() > 1e-6) {
              EXPECT_GT(excess, -1e-9 * strain) << place;
            }
          }
        }
}

// The area under the yield curve above its first stress, cell by cell; none without hardening.
TYPED_TEST(InelasticBody, HardeningStoresItsPartOfTheWork)
{
  constexpr int dim = TypeParam::value;
  YieldCurve level, straight, voce, table;
  level.initial = straight.initial = voce.initial = 1e-3;
  straight.hardening = voce.hardening = 0.2;
  voce.saturation = 1e-3, voce.rate = 150;
  table.strain = {0, 2e-3, 5e-3}, table.stress = {1e-3, 1.5e-3, 1.8e-3};
  const auto packing = packings::make_lattice_packing<dim>(
      box<Case<dim, dim == 2 ? Kind::hexagonal : Kind::fcc, true>>(dim == 2 ? 9 : 5));
  for (const YieldCurve &curve : {level, straight, voce, table}) {
    DemMaterial material{1., 0.3, 1., PlaneMode::strain, 0};
    material.plasticity = VonMisesFlow{curve};
    ManyBodyForce<dim> force(packing, material, {});
    auto p = at_rest(packing, material);
    Eigen::Matrix<double, dim, dim> strain = Eigen::Matrix<double, dim, dim>::Zero();
    for (int s = 1; s <= 20; ++s) {
      strain(0, 0) = 1e-2 * s / 20;
      deform<dim>(p, strain, Spin<dim>::Zero());
      force.compute(p, s);
    }
    double stored = 0;
    for (int i = 0; i < packing.size(); ++i) {
      constexpr int n = 4000; // midpoints
      const double history = force.strains().history(i);
      for (int k = 0; k < n; ++k)
        stored += packing.volume[i] * history / n * (curve.at(history * (k + 0.5) / n) - 1e-3);
    }
    const auto losses = force.losses();
    EXPECT_NEAR(losses.hardening, stored, 1e-5 * stored);
    EXPECT_GT(losses.plastic, losses.hardening);
    EXPECT_EQ(losses.hardening > 0, curve.at(1) > 1e-3);
  }
}

// Load, turn by 90 degrees, load on: the same stresses and strains in the particles' axes.
TYPED_TEST(InelasticBody, TurnsWithItsStrains)
{
  constexpr int dim = TypeParam::value;
  DemMaterial material{1., 0.3, 1., PlaneMode::strain, 0};
  YieldCurve curve;
  curve.initial = 1e-3, curve.hardening = 0.2;
  material.plasticity = VonMisesFlow{curve};
  const auto packing = packings::make_lattice_packing<dim>(
      box<Case<dim, dim == 2 ? Kind::hexagonal : Kind::fcc, true>>(dim == 2 ? 9 : 5));
  Eigen::Matrix<double, dim, dim> strain = Eigen::Matrix<double, dim, dim>::Zero();
  strain(0, 0) = 1e-2, strain(1, 1) = -4e-3, strain(0, 1) = strain(1, 0) = 3e-3;
  const auto run = [&](double angle) {
    auto force = std::make_unique<ManyBodyForce<dim>>(packing, material,
                                                      std::vector<core::BoundaryLoad<dim>>());
    auto p = at_rest(packing, material);
    for (int s = 1; s <= 4; ++s) {
      deform<dim>(p, s / 4. * strain,
                  angle * (s - 1) / 3. * Spin<dim>::Ones() / std::sqrt(double(n_spins<dim>)));
      force->compute(p, s);
    }
    return force;
  };
  const auto fixed = run(0), turned = run(M_PI / 2);
  ASSERT_GT(fixed->plastic_dissipation(), 0);
  EXPECT_NEAR(turned->plastic_dissipation() / fixed->plastic_dissipation(), 1, 1e-12);
  for (int i = 0; i < packing.size(); ++i)
    EXPECT_LT((turned->strains().tensor(i) - fixed->strains().tensor(i)).norm(), 1e-14);
}
} // namespace ligament::dem::testing
