// Regions at rest: left out or not, every particle goes the same way to the last bit.
#include "packings/absorbing_sides.h"
#include "packings/random_packing.h"
#include "particles/particle_solver.h"
#include "tests/unit/dem/cases.h"

namespace ligament::dem::testing
{
namespace
{
constexpr double spacing = 0.01;

template <int dim>
using Loads = std::vector<core::BoundaryLoad<dim>>;

/// Sides: one is pushed along its normal from `start` on, after a ramp of some steps; the opposite
/// one is held, or lets waves out.
template <int dim>
Loads<dim> impact(int side, bool absorbing)
{
  using Kind = typename core::BoundaryLoad<dim>::Kind;
  core::BoundaryLoad<dim> push, other;
  push.boundary = side;
  push.kind = Kind::velocity;
  push.value[side / 2] = 1e-3;
  push.history = core::Ramp{0.05};
  other.boundary = side ^ 1;
  other.kind = absorbing ? Kind::traction : Kind::displacement;
  other.absorbing = absorbing;
  if (!absorbing)
    for (auto &value : other.value)
      value = 0;
  return {push, other};
}

template <int dim>
struct Motion
{
  Packing<dim> packing;
  Loads<dim> loads;
  double poissons_ratio = 0.3, friction = 0, strength = 0;
  int steps = 80;
  std::function<void(Particles<dim> &)> start = [](Particles<dim> &) {};

  particles::ParticleSolver<dim> solver() const
  {
    DemMaterial material;
    material.youngs_modulus = 1;
    material.poissons_ratio = poissons_ratio;
    material.friction = friction;
    FractureLaw fracture;
    if (strength > 0)
      fracture = {FractureLaw::Criterion::maximum_tension, strength};
    Particles<dim> state;
    packings::fill_particles(packing, 1., state);
    const auto constants = material.elastic_constants<dim>();
    auto dashpots = packings::absorbing_dashpots<dim>(
        packing, state, loads,
        {{1., packings::isotropic_speeds<dim>(constants.wave_speed_p, constants.wave_speed_s)}});
    particles::ParticleSolver<dim> solver(
        std::move(state), std::make_unique<ManyBodyForce<dim>>(packing, material, loads, fracture));
    solver.dashpots = std::move(dashpots);
    start(solver.state);
    return solver;
  }

  /// The state after the last step of a run that rests where it can, and of one that doesn't.
  void compare(double least_rest) const
  {
    auto plain = solver(), resting = solver();
    const double dt = 0.9 * plain.force->stable_step(plain.state);
    plain.compute_forces(0);
    resting.compute_forces(0);
    resting.let_rest();
    for (int step = 1; step <= steps; ++step)
      for (auto *body : {&plain, &resting}) {
        body->kick(dt);
        body->drift(dt);
        body->compute_forces(step * dt);
      }
    const auto &a = plain.state, &b = resting.state;
    EXPECT_EQ(a.displacement, b.displacement);
    EXPECT_EQ(a.rotation, b.rotation);
    EXPECT_EQ(a.velocity, b.velocity);
    EXPECT_EQ(a.spin, b.spin);
    EXPECT_EQ(a.force, b.force);
    EXPECT_EQ(a.torque, b.torque);
    EXPECT_EQ(plain.dashpots.energy(), resting.dashpots.energy());
    EXPECT_EQ(plain.potential_energy(), resting.potential_energy());
    const auto &first = dynamic_cast<const ManyBodyForce<dim> &>(*plain.force),
               &second = dynamic_cast<const ManyBodyForce<dim> &>(*resting.force);
    EXPECT_EQ(first.external_work(), second.external_work());
    EXPECT_EQ(first.broken_bonds().size(), second.broken_bonds().size());
    EXPECT_EQ(first.broken_bonds().size() > 0, strength > 0);
    EXPECT_GT(resting.rest()->share_at_rest(), least_rest);
    EXPECT_LT(resting.rest()->share_at_rest(), 1);
  }
};

template <int dim>
packings::LatticeParameters<dim> block(Kind kind, const Vector<dim> &size)
{
  packings::LatticeParameters<dim> lattice;
  lattice.kind = kind;
  lattice.spacing = spacing;
  lattice.upper = spacing * size;
  return lattice;
}
} // namespace

// The front runs two bonds per step: of a bar of 800 it has 160 behind it after 80 steps.
TEST(Rest, HexagonalAlongTheRows)
{
  const auto packing = packings::make_lattice_packing<2>(block<2>(Kind::hexagonal, {800.3, 7.2}));
  Motion<2>{packing, impact<2>(0, false)}.compare(0.5);
  Motion<2>{packing, impact<2>(1, true)}.compare(0.5);
  Motion<2>{packing, impact<2>(0, true), 0.}.compare(0.5); // without dilatation
}

// Rows of more than a block, and of less, across the way of the wave.
TEST(Rest, HexagonalAcrossTheRows)
{
  for (const double width : {5.1, 150.3})
    Motion<2>{packings::make_lattice_packing<2>(block<2>(Kind::hexagonal, {width, 300.2})),
              impact<2>(2, width > 100)}
        .compare(0.4);
}

TEST(Rest, SimpleCubicAndFaceCentredCubic)
{
  for (const Kind kind : {Kind::simple_cubic, Kind::fcc}) {
    Motion<3>{packings::make_lattice_packing<3>(block<3>(kind, {420.3, 4.2, 3.4})),
              impact<3>(0, true),
              0.3,
              0,
              0,
              50}
        .compare(0.4);
    Motion<3>{packings::make_lattice_packing<3>(block<3>(kind, {5.3, 4.2, 160.4})),
              impact<3>(5, false),
              0.3,
              0,
              0,
              30}
        .compare(0.3);
  }
}

TEST(Rest, RandomPackings)
{
  packings::RandomParameters<2> flat;
  flat.spacing = spacing;
  flat.relaxation_sweeps = 2;
  flat.upper = {3.0, 0.08};
  Motion<2>{packings::make_random_packing<2>(flat).packing, impact<2>(0, true), 0.3, 0, 0, 40}
      .compare(0.3);
  packings::RandomParameters<3> solid;
  solid.spacing = spacing;
  solid.relaxation_sweeps = 1;
  solid.upper = {1.2, 0.04, 0.05};
  Motion<3>{packings::make_random_packing<3>(solid).packing, impact<3>(0, false), 0.3, 0, 0, 20}
      .compare(0.2);
}

// Notch and hole cut rows; the faces of a crack touch, with friction, and grind on each other.
TEST(Rest, NotchHoleAndCrack)
{
  auto lattice = block<2>(Kind::hexagonal, {90.4, 300.2});
  lattice.notches = {{{0.3, 0.3}, {0.5, 0.5}}};
  lattice.holes = {{{0.6, 0.7}, 0.06}};
  lattice.cracks = {{{-0.1, 0.183}, {0.35, 0.25}}, {{0.2, 2.}, {0.7, 2.1}}};
  Motion<2> run{packings::make_lattice_packing<2>(lattice), impact<2>(2, false), 0.3, 0.5};
  run.compare(0.2);
}

// A pull that breaks bonds at once; broken halves meet others.
TEST(Rest, BreakingBonds)
{
  Motion<2> run{packings::make_lattice_packing<2>(block<2>(Kind::hexagonal, {400.3, 12.2})),
                impact<2>(0, false), 0.3, 0.3, 0.02};
  run.loads[0].value[0] = -0.1;
  run.compare(0.3);
}

// A body that already moves somewhere, and a load that begins after the wave has left.
TEST(Rest, InitialMotionAndTraction)
{
  Motion<2> run{packings::make_lattice_packing<2>(block<2>(Kind::hexagonal, {900.3, 7.2})),
                impact<2>(1, true)};
  run.start = [](Particles<2> &p) {
    for (int i = 0; i < p.size(); ++i)
      if (std::abs(p.reference[0][i] - 3) < 0.05) {
        p.velocity[1][i] = 1e-3;
        p.rotation[0][i] = -1e-4;
      }
  };
  using Kind = core::BoundaryLoad<2>::Kind;
  run.loads[1].kind = Kind::traction;
  run.loads[1].value[1] = 1e-5;
  run.compare(0.1);
}

// With limits above zero a block sleeps until the wave is felt; what it does to energy is nothing:
// held particles do no work.
TEST(Rest, LimitsKeepTheInvariant)
{
  Motion<2> run{packings::make_lattice_packing<2>(block<2>(Kind::hexagonal, {600.3, 7.2})),
                impact<2>(0, false)};
  run.steps = 300;
  auto plain = run.solver(), resting = run.solver();
  const double dt = 0.9 * plain.force->stable_step(plain.state);
  const auto drive = [&](particles::ParticleSolver<2> &body, double threshold) {
    body.compute_forces(0);
    body.let_rest(particles::RestLimits::of_strain(threshold, spacing, 1.));
    for (int step = 1; step <= run.steps; ++step) {
      body.kick(dt);
      body.drift(dt);
      body.compute_forces(step * dt);
    }
    const double energy = body.kinetic_energy(dt) + body.potential_energy();
    const double work = dynamic_cast<ManyBodyForce<2> &>(*body.force).external_work();
    EXPECT_NEAR(energy, work, 1e-5 * work); // the law's own drift: strains of 1e-3, (E1)
    return work;
  };
  const double exact = drive(plain, 0), work = drive(resting, 1e-8);
  EXPECT_NEAR(work, exact, 1e-6 * exact);
  EXPECT_GT(resting.rest()->share_at_rest(), plain.rest()->share_at_rest() + 0.05);
}
} // namespace ligament::dem::testing
