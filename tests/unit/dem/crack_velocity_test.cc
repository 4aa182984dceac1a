// Faces that let go in time: the force over it, work, gradient, balance, states, numbering, and how
// fast a crack runs.
#include "core/extremes.h"
#include "tests/unit/dem/cases.h"
#include "tests/unit/dem/force_slope.h"
#include "tests/unit/dem/run.h"
#include "tests/unit/dem/softening_bodies.h"

#include <gtest/gtest.h>

#include <set>

namespace ligament::dem::testing
{
namespace
{
template <typename D>
struct Falling : ::testing::Test
{
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Falling, Dimensions);

using Criterion = FractureLaw::Criterion;

constexpr double youngs_modulus = 3e10, strength = 3e6, density = 2500;

/// The force that a face bears over time is the straight line from where it began.
TYPED_TEST(Falling, ForceFallsInTimeAndNothingIsLeft)
{
  constexpr int dim = TypeParam::value;
  const auto packing = column<dim>();
  const double d = packing.spacing, area = packing.faces[0].area, velocity = 5;
  const double whole_time = d / velocity; // sqrt(S) and S/b
  for (const double nu : {0., 0.3}) {
    const DemMaterial material{youngs_modulus, nu, density, PlaneMode::strain, 0};
    FractureLaw law{Criterion::maximum_tension, strength};
    law.crack_velocities = {velocity};
    std::vector<core::BoundaryLoad<dim>> loads(2);
    for (int end = 0; end < 2; ++end) {
      loads[end].boundary = 2 + end;
      loads[end].value[1] = (end ? 0.5 : -0.5) * 0.01;
      loads[end].history = core::Ramp{10 * d / 3000};
    }
    Run<dim> run(packing, material, loads, law);
    double begun = -1, first = 0, residual = 0, off = 0;
    while (run.force->broken_bonds().empty() && run.time < 1) {
      run.step(1000. * 3);
      keep_largest(residual, std::abs(run.residual()));
      for (const auto &[name, face] : run.force->cohesive().all()) {
        if (begun < 0)
          begun = run.time, first = face.force.norm();
        const double wanted = first * (1 - (run.time - begun) / whole_time);
        keep_largest(off, std::abs(face.force.norm() - std::max(wanted, 0.)));
      }
    }
    const double whole = strength * strength / youngs_modulus * area * d;
    ASSERT_EQ(run.force->broken_bonds().size(), 1u);
    EXPECT_NEAR(run.time - begun, whole_time, 1.01 * run.dt);
    EXPECT_NEAR(first, strength * area, 0.02 * strength * area); // one step's load above it
    // Pressures that it shares follow in the next step.
    EXPECT_LT(off, (nu == 0 ? 1e-9 : 2 * run.dt / whole_time) * first) << nu;
    EXPECT_LT(std::abs(run.force->fracture_energy()), 1e-6 * whole);
    EXPECT_GT(run.force->cohesive_work(), 0.4 * whole);
    EXPECT_LT(residual, 1e-3 * whole); // the strain
  }
}

/// Stretched, waved and turned by hand, so that faces begin to fall, open and shut.
template <int dim>
struct Opened
{
  Packing<dim> packing;
  DemMaterial material{1., 0.3, 1., PlaneMode::strain, 0.4};
  FractureLaw law{Criterion::maximum_tension, 0.02};
  std::unique_ptr<ManyBodyForce<dim>> force;
  Particles<dim> p;

  explicit Opened(const Packing<dim> &of, Criterion criterion = Criterion::maximum_tension)
      : packing(of)
  {
    law.criterion = criterion;
    law.strength.compressive = 3;
    law.strength.cohesion = 1;
    law.strength.friction_angle = 0.4;
    law.crack_velocities = {0.04};
    force = make();
    p = at_rest(packing, material);
    p.global_id = packing.global_id.empty() ? p.global_id : particles::GlobalIds(packing.global_id);
  }
  std::unique_ptr<ManyBodyForce<dim>> make() const
  {
    return std::make_unique<ManyBodyForce<dim>>(packing, material,
                                                std::vector<core::BoundaryLoad<dim>>(), law);
  }
  void take(int step) { take(step, *force, p); }
  void take(int step, ManyBodyForce<dim> &of, Particles<dim> &q) const
  {
    const double opened = step < 14 ? step : 28 - step;
    for (int i = 0; i < q.size(); ++i) {
      const Vector<dim> x = get(q.reference, i);
      Vector<dim> u = Vector<dim>::Zero();
      u[1] =
          0.006 * opened * x[1] + 2e-3 * packing.spacing * opened * std::sin(7 * x[0] + 5 * x[1]);
      u[0] = 1e-3 * packing.spacing * step * std::cos(4 * x[1]);
      set(q.displacement, i, u);
      const double angle = 1e-3 * step * std::sin(3 * x[0]);
      if constexpr (dim == 2)
        q.rotation[0][i] = angle;
      else {
        q.rotation[0][i] = std::cos(angle / 2);
        q.rotation[2][i] = std::sin(angle / 2);
      }
    }
    of.compute(q, step);
  }
};

TYPED_TEST(Falling, ForceIsMinusTheGradientAtFrozenOpenings)
{
  constexpr int dim = TypeParam::value;
  Opened<dim> body(ragged_lattice<dim>(4, 7));
  for (int step = 0; step < 12; ++step)
    body.take(step);
  auto &force = *body.force;
  ASSERT_GT(force.cohesive().all().size(), 2u);
  auto p = body.p;
  force.compute(p, 11);
  expect_minus_slope<dim>(p, {1e-4, 1e-4}, 1e-8, 1, 2,
                          [&](const auto &q) { return force.potential_energy(q); });
}

TYPED_TEST(Falling, GoesOnFromItsStateToTheBitUnderAllCriteria)
{
  constexpr int dim = TypeParam::value;
  for (const Criterion criterion :
       {Criterion(Criterion::maximum_tension), Criterion(Criterion::face_tension),
        Criterion(Criterion::principal_stress), Criterion(Criterion::von_mises),
        Criterion(Criterion::drucker_prager), Criterion(Criterion::mohr_coulomb),
        Criterion(Criterion::energy)})
  {
    Opened<dim> body(ragged_lattice<dim>(4, 7), criterion);
    for (int step = 0; step < 9; ++step)
      body.take(step);
    ASSERT_GT(body.force->cohesive().all().size(), 0u);
    const core::Names names(body.p.global_id.list());
    core::State state;
    body.p.save(state, names);
    body.force->save(state, names, body.p);
    const auto other = body.make();
    auto q = body.p;
    other->load(state, names, q);
    for (int step = 9; step < 40; ++step) {
      body.take(step);
      body.take(step, *other, q);
      for (int i = 0; i < q.size(); ++i)
        for (int c = 0; c < dim; ++c)
          ASSERT_EQ(body.p.force[c][i], q.force[c][i]);
      ASSERT_EQ(body.force->cohesive_work(), other->cohesive_work());
      ASSERT_EQ(body.force->fracture_energy(), other->fracture_energy());
    }
    EXPECT_GT(body.force->broken_bonds().size(), 0u);
  }
}

/// A strip between grips whose lower half is cut at one end; drawn apart far beyond what it needs.
struct Strip
{
  packings::Packing<2> packing;
  DemMaterial material{youngs_modulus, 0.2, density, PlaneMode::strain, 0};
  double spacing = 0.01;

  Strip()
  {
    packings::LatticeParameters<2> lattice;
    lattice.kind = packings::LatticeKind::hexagonal;
    lattice.spacing = spacing;
    lattice.lower = {-20 * spacing, -6.3 * spacing};
    lattice.upper = -lattice.lower;
    const double row = 0.05 * spacing;
    lattice.cracks = {{{2 * lattice.lower[0], row}, {-14 * spacing, row}}};
    packing = packings::make_lattice_packing<2>(lattice);
  }
  struct Ran
  {
    double speed, residual;
    std::vector<particles::BrokenBond<2>> broken;
    std::map<std::array<std::int64_t, 2>, CohesiveFace<2>> fell; // as they began
  };
  /// At so many times the opening that breaks it at all, in crack velocities of m/s (0: any).
  Ran run(double strain, double velocity) const
  {
    FractureLaw law{Criterion::maximum_tension, strength};
    law.crack_velocities = {velocity};
    std::vector<core::BoundaryLoad<2>> loads(2);
    const double height = 12.6 * spacing;
    for (int end = 0; end < 2; ++end) {
      loads[end].boundary = 2 + end;
      loads[end].kind = core::BoundaryLoad<2>::Kind::displacement;
      loads[end].value[1] = (end ? 0.5 : -0.5) * strain * height;
      loads[end].history = core::Ramp{30 * height / 3000};
    }
    Run<2> run(packing, material, loads, law);
    Ran ran{0, 0, {}, {}};
    while (run.time < 0.02) {
      run.step(300);
      keep_largest(ran.residual, std::abs(run.residual()));
      for (const auto &[name, face] : run.force->cohesive().all())
        ran.fell.emplace(name, face);
      double front = -1;
      for (const auto &b : run.force->broken_bonds())
        front = std::max(front, b.position[0]);
      if (front > 12 * spacing)
        break;
    }
    ran.broken = run.force->broken_bonds();
    double first = 1, last = 0;
    for (const auto &b : ran.broken) {
      if (b.position[0] > -8 * spacing)
        first = std::min(first, b.time);
      if (b.position[0] > 8 * spacing)
        last = last == 0 ? b.time : std::min(last, b.time);
    }
    ran.speed = 16 * spacing / (last - first);
    return ran;
  }
};

// The front waits, also where many faces exceed their strength in one step.
TEST(Falling, OneFaceOfAParticleAtATime)
{
  const auto packing = packings::make_lattice_packing(box<Case<2, Kind::hexagonal, false>>(12));
  for (const CriterionRef &criterion : {Criterion::face_tension, Criterion::maximum_tension}) {
    FractureLaw law{criterion, strength};
    law.crack_velocities = {5};
    const DemMaterial material{youngs_modulus, 0.2, density, PlaneMode::strain, 0};
    ManyBodyForce<2> force(packing, material, {}, law);
    auto p = at_rest(packing, material);
    for (int step = 1; step <= 5; ++step) {
      for (int i = 0; i < p.size(); ++i)
        p.displacement[1][i] = 5e-5 * step * p.reference[1][i];
      force.compute(p, 1e-9 * step);
    }
    std::set<std::int64_t> taken;
    for (const auto &[name, face] : force.cohesive().all())
      for (const std::int64_t of : {name[0], name[1]})
        EXPECT_TRUE(taken.insert(of).second) << of;
    EXPECT_GT(taken.size(), 5u);
  }
}

TEST(Falling, CracksRunNoFaster)
{
  const Strip strip;
  const double strain = 0.6 * strength / youngs_modulus;
  const auto free = strip.run(strain, 0);
  for (const double velocity : {100., 400.}) {
    const auto ran = strip.run(strain, velocity);
    EXPECT_GT(free.speed, 1.5 * velocity);
    EXPECT_LT(ran.speed, velocity) << "without limit " << free.speed;
    // Two faces of a row follow each other over a spacing, less what waiting for steps takes.
    EXPECT_NEAR(ran.speed, std::sqrt(3.) / 2 * velocity, 0.1 * velocity);
    const double whole = strength * strength / youngs_modulus * strip.packing.thickness;
    EXPECT_LT(ran.residual, 1e-4 * whole * strip.spacing * strip.spacing);
    ASSERT_GT(ran.fell.size(), 20u);
    for (const auto &[name, one] : ran.fell)
      for (const auto &[next, other] : ran.fell) {
        const bool meet =
            name[0] == next[0] || name[0] == next[1] || name[1] == next[0] || name[1] == next[1];
        const FallInTime &first = one.fall, &second = other.fall;
        if (name == next || !meet || first.begin > second.begin)
          continue;
        const double length = one.bond.area / strip.packing.thickness;
        EXPECT_NEAR(first.duration, length / velocity, 1e-12 * first.duration);
        EXPECT_GE(second.begin, first.begin + first.duration);
      }
  }
}
} // namespace
} // namespace ligament::dem::testing
