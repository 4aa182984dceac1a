// Viscosity of particles: kernels against the oracle, with plastic flow and without; prescribed
// courses against closed forms; the leap-frog's balance; looks; turned bodies.
#include "core/extremes.h"
#include "tests/oracle/inelastic_oracle.h"
#include "tests/unit/dem/free_flight.h"
#include "tests/unit/dem/inelastic_bodies.h"

#include <fmt/format.h>

#include <numeric>

namespace ligament::dem::testing
{
template <typename D>
struct Viscous : ::testing::Test
{
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Viscous, Dimensions);

/// Times in units of `unit`: branches, a dashpot, both.
std::vector<Viscosity> viscosities(double unit)
{
  const std::vector<RelaxingBranch> branches = {{0.5, 3 * unit}, {0.3, 20 * unit}};
  return {{branches, 0}, {{}, 4 * unit}, {branches, 0.3 * unit}, {{{1, 5 * unit}}, 0}};
}

std::vector<Plasticity> plasticities(double scale = 1)
{
  YieldCurve linear;
  linear.initial = 0.004 * scale, linear.hardening = 0.3;
  return {{}, VonMisesFlow{linear}, DruckerPragerFlow{0.004 * scale, 0.1, 0.5, 0.3}};
}

/// Random states one after the other, each turned further, at unequal steps.
template <int dim>
void expect_like_oracle(const Packing<dim> &packing, const Plasticity &law,
                        const Viscosity &viscosity, PlaneMode plane, double nu)
{
  DemMaterial material{1., nu, 1., plane, 0};
  ManyBodyForce<dim> elastic(packing, material, {});
  material.plasticity = law, material.viscosity = viscosity;
  ManyBodyForce<dim> force(packing, material, {});
  oracle::InelasticOracle<dim> oracle(packing, material.youngs_modulus, nu, law, plane, viscosity);
  double largest = 0, error = 0, strain = 0, strain_error = 0;
  int step = 0;
  double before = 0;
  for (const double time : {0.5, 1.5, 4., 4.25}) {
    Particles<dim> p = at_rest(packing, material);
    disturb<dim>(p, packing.spacing, 0.02, Spin<dim>::Constant(0.2 * step), 3 + step);
    Particles<dim> q = p;
    force.compute(p, time);
    oracle.flow(p, step++ > 0 ? time - before : 0);
    before = time;
    elastic.compute(q, time); // bending and contacts
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
      const auto e = force.strains().tensor(i);
      for (int a = 0; a < dim; ++a)
        for (int b = a; b < dim; ++b)
          strain_error =
              std::max(strain_error, std::abs(e[tensor_place<dim>(a, b)] - oracle.strain[i](a, b)));
      if (dim == 2)
        keep_largest(strain_error, std::abs(e[2] - oracle.strain[i](2, 2)));
      keep_largest(strain, oracle.strain[i].norm());
    }
  }
  EXPECT_GT(strain, 1e-3);
  EXPECT_LT(strain_error, 1e-11 * std::max(strain, 1.));
  EXPECT_LT(error, 1e-11 * largest);
}

TYPED_TEST(Viscous, IsTheOracleOnLatticesAndRandomPackings)
{
  constexpr int dim = TypeParam::value;
  const auto lattice = lattice_body<dim>(), random = random_body<dim>();
  for (const Plasticity &law : plasticities())
    for (const Viscosity &viscosity : viscosities(1))
      for (const double nu : {0., 0.3, 0.45})
        for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress}) {
          if (dim == 3 && plane == PlaneMode::stress)
            continue;
          SCOPED_TRACE(fmt::format("law {} branches {} dashpot {} nu {} plane {}", law.index(),
                                   viscosity.branches.size(), viscosity.dashpot, nu, int(plane)));
          expect_like_oracle<dim>(lattice, law, viscosity, plane, nu);
          expect_like_oracle<dim>(random, law, viscosity, plane, nu);
        }
}

/// Strains along `direction` by `course` up to `end`: viscous strain of an inner particle.
template <int dim, typename Course>
typename InelasticStrains<dim>::Tensor
viscous_strain(const Packing<dim> &packing, const DemMaterial &material,
               const Eigen::Matrix<double, dim, dim> &direction, const Course &course, double end,
               int n_steps)
{
  ManyBodyForce<dim> force(packing, material, {});
  auto p = at_rest(packing, material);
  for (int s = 0; s <= n_steps; ++s) {
    const double time = end * s / n_steps;
    deform<dim>(p, course(time) * direction);
    force.compute(p, time);
  }
  return force.strains().viscous_strain(inner_particle(p));
}

/// A shear and, across it, a strain without change of volume: in plane strain and in 3D the
/// deviator is all.
template <int dim>
Eigen::Matrix<double, dim, dim> isochoric()
{
  Eigen::Matrix<double, dim, dim> m = Eigen::Matrix<double, dim, dim>::Zero();
  m(0, 0) = 0.5, m(1, 1) = -0.5, m(0, 1) = m(1, 0) = 1;
  return m;
}

/// An integral over the past of a harmonic course: what is left in a branch.
double branch_strain(double time, double omega, double relaxation)
{
  const double x = omega * relaxation;
  return x * (std::cos(omega * time) + x * std::sin(omega * time) - std::exp(-time / relaxation)) /
         (1 + x * x);
}

TYPED_TEST(Viscous, RelaxationFollowsTheClosedFormToSecondOrder)
{
  constexpr int dim = TypeParam::value;
  const double omega = 1.3, end = 2, amplitude = 1e-6;
  const auto course = [&](double t) { return amplitude * std::sin(omega * t); };
  DemMaterial material{1., 0.3, 1., PlaneMode::strain, 0};
  material.viscosity.branches = {{0.5, 0.4}, {0.3, 3}};
  double expected = 0.8 * course(end);
  for (const auto &[share, time] : material.viscosity.branches)
    expected -= amplitude * share * branch_strain(end, omega, time);
  for (const auto &packing : {lattice_body<dim>(0), random_body<dim>(0)}) {
    const auto error = [&](int n) {
      const auto e = viscous_strain<dim>(packing, material, isochoric<dim>(), course, end, n);
      EXPECT_NEAR(e[0], 0.5 * e[dim == 2 ? 3 : 5], 1e-9 * amplitude);
      return e[dim == 2 ? 3 : 5] / expected - 1;
    };
    const double coarse = error(40), fine = error(80);
    EXPECT_LT(std::abs(coarse), 1e-3);
    EXPECT_NEAR(coarse / fine, 4, 0.1);
  }
}

// Out of the plane the strain is what the stress leaves: second order there, too.
TEST(ViscousPlaneStress, SecondOrder)
{
  const auto course = [&](double t) { return 1e-6 * std::sin(1.3 * t); };
  DemMaterial material{1., 0.3, 1., PlaneMode::stress, 0};
  material.viscosity.branches = {{0.5, 0.4}, {0.3, 3}};
  const Eigen::Matrix2d pull = Eigen::Vector2d(1, 0.2).asDiagonal();
  const auto packing = lattice_body<2>(0);
  std::array<double, 3> zz;
  for (int k = 0; k < 3; ++k)
    zz[k] = viscous_strain<2>(packing, material, pull, course, 2., 40 << k)[2];
  EXPECT_NEAR((zz[0] - zz[1]) / (zz[1] - zz[2]), 4, 0.1);
}

// The course of the strain that creep under a constant stress has asks for that stress.
TYPED_TEST(Viscous, CreepOfADashpotBesideTheSpring)
{
  constexpr int dim = TypeParam::value;
  const double amplitude = 1e-6, tau = 2;
  const auto course = [&](double t) { return -amplitude * std::expm1(-t / tau); };
  DemMaterial material{1., 0.3, 1., PlaneMode::strain, 0};
  material.viscosity.dashpot = tau * material.shear_modulus();
  for (const auto &packing : {lattice_body<dim>(0), random_body<dim>(0)})
    for (const double end : {0.5, 3.}) {
      const int n = int(end / tau * 1000);
      const auto e = viscous_strain<dim>(packing, material, isochoric<dim>(), course, end, n);
      EXPECT_NEAR((course(end) - e[dim == 2 ? 3 : 5]) / amplitude, 1, 1e-3);
    }
}

// Affine motion of a body of whole cells: no force on what lies inside, whatever it has relaxed.
TYPED_TEST(Viscous, PatchOfUniformStrain)
{
  constexpr int dim = TypeParam::value;
  for (const Viscosity &viscosity : viscosities(1))
    for (const auto &packing : {lattice_body<dim>(0), random_body<dim>(0)}) {
      DemMaterial material{1., 0.3, 1., PlaneMode::strain, 0};
      material.viscosity = viscosity;
      std::vector<char> depth(packing.size(), 2); // from the surface
      for (const auto &face : packing.boundary_faces)
        depth[face.i] = 0;
      for (const auto &face : packing.faces)
        for (const auto &[i, j] : {std::pair(face.i, face.j), {face.j, face.i}})
          if (depth[i] == 0)
            depth[j] = std::min(depth[j], char(1));
      ManyBodyForce<dim> force(packing, material, {});
      auto p = at_rest(packing, material);
      Eigen::Matrix<double, dim, dim> strain = isochoric<dim>();
      strain(0, 0) += 0.4;
      double viscous = 0;
      for (int s = 0; s <= 3; ++s) {
        deform<dim>(p, 0.01 * s * strain);
        force.compute(p, s);
      }
      const double unit = 0.03 * std::pow(packing.spacing, dim - 1);
      for (int i = 0; i < p.size(); ++i) {
        if (depth[i] < 2)
          continue;
        viscous = std::max(viscous, force.strains().viscous_strain(i).norm());
        EXPECT_LT(get(p.force, i).norm(), 1e-12 * unit * std::max(1., viscous / 0.03));
      }
      EXPECT_GT(viscous, 1e-3);
    }
}

// Exact for forces that are linear in the motion: what is left is of the order of the strain.
TYPED_TEST(Viscous, DissipationClosesTheBalance)
{
  constexpr int dim = TypeParam::value;
  for (const auto &packing : {lattice_body<dim>(), random_body<dim>()})
    for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress})
      for (const Viscosity &viscosity : viscosities(0.01))
        for (const double scale : {1e-6, 1e-4}) {
          if (dim == 3 && plane == PlaneMode::stress)
            continue;
          for (const Plasticity &law : plasticities(1500 * scale)) {
            DemMaterial material{1., 0.3, 1, plane, 0};
            material.plasticity = law, material.viscosity = viscosity;
            const auto [start, missing, losses] = fly<dim>(packing, material, scale, 100);
            EXPECT_GT(losses.viscous, 0.002 * start);
            EXPECT_LT(losses.viscous, start);
            EXPECT_NEAR(missing / start, 0, 30 * scale) << law.index();
          }
        }
}

// Faces that break take their part of what the dashpots and branches keep along.
TYPED_TEST(Viscous, FacesBreakInBalance)
{
  constexpr int dim = TypeParam::value;
  constexpr double scale = 1e-6;
  for (const auto &packing : {lattice_body<dim>(), random_body<dim>()})
    for (const Viscosity &viscosity : viscosities(0.01)) {
      DemMaterial material{1., 0.3, 1, PlaneMode::strain, 0};
      material.viscosity = viscosity;
      const FractureLaw law = {FractureLaw::Criterion::face_tension, 2 * scale};
      const auto [start, missing, losses] = fly<dim>(packing, material, scale, 60, 0.8, law);
      EXPECT_TRUE(losses.viscous > 0 || viscosity.dashpot > 0); // whose rate is late, also behind a break
      EXPECT_NEAR(missing / start, 0, 1e-3);
    }
}

// A body that stands still while faces break: what they took from the strain is no rate.
TYPED_TEST(Viscous, ABreakIsNoRate)
{
  constexpr int dim = TypeParam::value;
  for (const auto &packing : {lattice_body<dim>(), random_body<dim>()})
    for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress}) {
      if (dim == 3 && plane == PlaneMode::stress)
        continue;
      DemMaterial material{1., 0.3, 1., plane, 0};
      material.viscosity.dashpot = 10;
      ManyBodyForce<dim> force(packing, material, {});
      auto p = at_rest(packing, material);
      disturb<dim>(p, packing.spacing, 0.02, Spin<dim>::Zero(), 3);
      std::vector<int> all(packing.size());
      std::iota(all.begin(), all.end(), 0);
      force.compute(p, 1);
      force.compute(p, 2);
      force.set_strength(0.5 * force.max_tension(p, all));
      for (int time = 3; time < 8; ++time) {
        force.compute(p, time);
        for (const int i : all)
          EXPECT_LT(force.strains().viscous_strain(i).norm(), 1e-11);
      }
      EXPECT_GT(force.broken_bonds().size(), 1u);
    }
}

TYPED_TEST(Viscous, BalanceOfManyStepsNearTheCriticalOne)
{
  constexpr int dim = TypeParam::value;
  const auto packing =
      dim == 2 ? torn(packings::make_lattice_packing<dim>(
                          box<Case<dim, dim == 2 ? Kind::hexagonal : Kind::fcc, true>>(9)),
                      5)
               : lattice_body<dim>();
  for (const Viscosity &viscosity : viscosities(0.01)) {
    DemMaterial material{1., 0.3, 1, PlaneMode::strain, 0};
    material.viscosity = viscosity;
    const auto [start, missing, losses] =
        fly<dim>(packing, material, 1e-10, dim == 2 ? 10000 : 2000, 0.9);
    EXPECT_GT(losses.viscous, 0.1 * start);
    EXPECT_LT(losses.viscous, 1.0001 * start);
    EXPECT_NEAR(missing / start, 0, 1e-8);
  }
}

// However often a time is looked at, particles creep once, and looks leave nothing behind.
TYPED_TEST(Viscous, LooksChangeNoBit)
{
  constexpr int dim = TypeParam::value;
  for (const auto &packing : {lattice_body<dim>(), random_body<dim>()})
    for (const Viscosity &viscosity : viscosities(1)) {
      DemMaterial material{1., 0.3, 1., PlaneMode::strain, 0};
      material.viscosity = viscosity;
      ManyBodyForce<dim> force(packing, material, {});
      auto p = at_rest(packing, material);
      for (const double time : {1., 2., 3.}) {
        disturb<dim>(p, packing.spacing, 0.02, Spin<dim>::Zero(), int(time));
        force.compute(p, time);
        const auto first = p;
        const double taken = force.viscous_dissipation(), energy = force.potential_energy(p);
        ASSERT_EQ(taken > 0, time > 1);
        Components<n_strains<dim>> stress;
        force.stresses(p, stress);
        force.compute(p, time);
        EXPECT_EQ(p.force, first.force);
        EXPECT_EQ(p.torque, first.torque);
        EXPECT_EQ(force.viscous_dissipation(), taken);
        EXPECT_EQ(force.potential_energy(p), energy);
      }
    }
}

// Load, turn by 90 degrees while it goes on: the same strains in the particles' axes.
TYPED_TEST(Viscous, TurnsWithItsStrains)
{
  constexpr int dim = TypeParam::value;
  for (const Viscosity &viscosity : viscosities(1)) {
    DemMaterial material{1., 0.3, 1., PlaneMode::strain, 0};
    material.viscosity = viscosity;
    const auto packing = lattice_body<dim>(0);
    const auto run = [&](double angle) {
      auto force = std::make_unique<ManyBodyForce<dim>>(packing, material,
                                                        std::vector<core::BoundaryLoad<dim>>());
      auto p = at_rest(packing, material);
      for (int s = 0; s <= 4; ++s) {
        deform<dim>(p, 2.5e-3 * s * isochoric<dim>(),
                    angle * s / 4. * Spin<dim>::Ones() / std::sqrt(double(n_spins<dim>)));
        force->compute(p, s);
      }
      return force;
    };
    const auto fixed = run(0), turned = run(M_PI / 2);
    ASSERT_GT(fixed->viscous_dissipation(), 0);
    EXPECT_NEAR(turned->viscous_dissipation() / fixed->viscous_dissipation(), 1, 1e-11);
    for (int i = 0; i < packing.size(); ++i)
      EXPECT_LT((turned->strains().tensor(i) - fixed->strains().tensor(i)).norm(), 1e-13);
  }
}

// Free flight far above and below the damping of the highest modes: at the step that is said to be
// stable nothing grows.
TEST(ViscousStep, IsStableUnderAnyDamping)
{
  const auto packing = random_body<2>();
  DemMaterial material{1., 0.3, 1., PlaneMode::strain, 0};
  Particles<2> p;
  packings::fill_particles(packing, 1., p);
  const double elastic = ManyBodyForce<2>(packing, material, {}).stable_step(p);
  for (const double damping : {0.1, 1., 10.}) { // eta / G over the elastic step
    material.viscosity.dashpot = damping * elastic * material.shear_modulus();
    const double step = ManyBodyForce<2>(packing, material, {}).stable_step(p);
    EXPECT_NEAR(step / elastic, std::sqrt(1 + damping * damping) - damping, 1e-12);
    const auto [start, missing, losses] = fly<2>(packing, material, 1e-8, 400, 1);
    EXPECT_NEAR(missing / start, 0, 1e-6);
    EXPECT_LT(losses.viscous, start);
  }
}
} // namespace ligament::dem::testing
