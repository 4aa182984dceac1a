// The State of a body in parts is that of the whole one, and goes on in any number of parts.
#include "core/ranks_state.h"
#include "tests/unit/ranks/body_in_parts.h"

namespace ligament::dem::testing
{
namespace
{
using Criterion = FractureLaw::Criterion;

TEST(RanksState, MergesRowsAndSums)
{
  const core::Ranks &ranks = test::ranks();
  const int r = ranks.rank(), n = ranks.size();
  core::State part;
  core::Table own({20 - r}), shared({1, 2, 3}), // against the order of the ranks
      some(r == n - 1 ? std::vector<std::int64_t>{7} : std::vector<std::int64_t>{});
  own.add("x", std::vector<double>{r + 0.5});
  shared.add("y", std::vector<std::int64_t>{4, 5, 6});
  if (r == n - 1) // where there are no rows, there may be no columns
    some.add("z", std::vector<double>{0.25});
  part["own"] = own;
  part["shared"] = shared;
  part["some"] = some;
  core::ExactSum sum;
  sum.add(std::ldexp(1., 3 * r));
  core::save_sum(part, "sum", sum);
  const core::State whole = core::merged(part, ranks);
  EXPECT_EQ(int(whole.at("own").n_rows()), n);
  for (int k = 0; k < n; ++k)
    EXPECT_EQ(whole.at("own").reals("x")[k], n - 1 - k + 0.5);
  EXPECT_TRUE(whole.at("shared") == shared);
  EXPECT_EQ(whole.at("some").reals("z"), std::vector<double>{0.25});
  double expected = 0;
  for (int k = 0; k < n; ++k)
    expected += std::ldexp(1., 3 * k);
  EXPECT_EQ(core::load_sum(whole, "sum").value(), expected);
  // Shared out and merged again it is the same.
  const core::State again = core::merged(core::share_of(whole, ranks), ranks);
  EXPECT_TRUE(again == whole);
  EXPECT_TRUE(core::merged_at_first(part, ranks) == (ranks.is_first() ? whole : core::State()));
}

TEST(RanksState, RefusesRanksThatHaveComeApart)
{
  const core::Ranks &ranks = test::ranks();
  if (ranks.is_one())
    return;
  const bool odd = ranks.rank() == ranks.size() - 1;
  core::State values, columns, tables;
  core::save_value(values, "a", "x", odd ? 1. : 2.);
  EXPECT_THROW(core::merged(values, ranks), core::InputError);
  core::save_value(columns, "a", odd ? "x" : "y", 1.);
  EXPECT_THROW(core::merged(columns, ranks), core::InputError);
  core::save_value(tables, odd ? "a" : "b", "x", 1.);
  EXPECT_THROW(core::merged(tables, ranks), core::InputError);
}

template <int dim>
core::State state_of(const Solver<dim> &s)
{
  core::State state;
  s.solver->save(state);
  return core::merged(state, s.solver->ranks());
}

std::string different_tables(const core::State &a, const core::State &b)
{
  std::string names;
  for (const auto &[name, table] : a)
    if (!b.count(name) || !(b.at(name) == table))
      names += " " + name;
  for (const auto &[name, table] : b)
    if (!a.count(name))
      names += " " + name;
  return names;
}

/// In mid-fracture the body is built anew, in other parts on another number of ranks, from the
/// state of the parts, which is that of the whole one, and steps on beside it.
template <int dim>
core::State expect_the_state_to_go_on(const Scene<dim> &scene, int steps, int n_states,
                                      std::size_t least_broken = 51)
{
  Solver<dim> whole(scene, nullptr);
  const double dt = scene.step_share * whole.force->stable_step(whole.solver->state);
  whole.solver->compute_forces(0);
  const auto part_number = [&](unsigned cut, int n_busy) {
    return packings::part_of(scene.packing, some_partition(scene.packing.size(), cut, n_busy),
                             test::ranks().rank(), ManyBodyForce<dim>::n_rings(scene.law));
  };
  auto held = part_number(0, 0);
  int n_states_so_far = 0;
  auto part = std::make_unique<Solver<dim>>(scene, &held);
  part->solver->compute_forces(0);
  std::size_t n_soft = 0; // where a state was taken
  std::string differs;
  for (int s = 1; s <= steps && !test::ranks().any(!differs.empty()); ++s) {
    for (Solver<dim> *of : {&whole, part.get()}) {
      of->solver->kick(dt);
      of->solver->drift(dt);
      of->solver->update_ghosts();
    }
    if (s % (steps / n_states) == 0) {
      const core::State of_whole = state_of(whole), of_parts = state_of(*part);
      differs = different_tables(of_parts, of_whole);
      n_soft += whole.force->cohesive().all().size();
      EXPECT_EQ(differs, "") << "step " << s;
      held = part_number(unsigned(s), 1 + n_states_so_far++ % test::ranks().size());
      Scene<dim> still = scene;
      still.random_velocity = 0; // the state has it
      part = std::make_unique<Solver<dim>>(still, &held);
      part->solver->load(of_parts);
    }
    for (Solver<dim> *of : {&whole, part.get()})
      of->solver->compute_forces(s * dt);
    Comparison<dim> comparison(*part, whole, held.place);
    if (!(comparison.is_same(dt) & comparison.reactions_are_same(int(scene.loads.size())) &
          comparison.broken_bonds_are_same()))
      differs = comparison.differs();
    EXPECT_EQ(differs, "") << "step " << s;
  }
  EXPECT_GE(whole.force->broken_bonds().size(), least_broken); // else the test would say little
  EXPECT_EQ(n_soft > 20, scene.law.faces_open());
  if (flows(scene.material.plasticity)) {
    EXPECT_GT(whole.force->plastic_dissipation(), 0);
  }
  if (is_viscous(scene.material.viscosity)) {
    EXPECT_GT(whole.force->viscous_dissipation(), 0);
  }
  return state_of(whole);
}

TEST(StateInParts, GoesOnInOtherParts2D)
{
  Scene<2> scene;
  auto lattice = box<Case<2, Kind::hexagonal, true>>(20);
  const double half = lattice.upper[0];
  lattice.cracks = {{{-0.5 * half, 0.1 * half}, {0.4 * half, -0.1 * half}}};
  scene.packing = packings::make_lattice_packing(lattice);
  scene.material.friction = 0.4;
  scene.random_velocity = 0.04;
  scene.law = {Criterion::maximum_tension, 0.02};
  scene.loads.resize(1);
  scene.loads[0].boundary = 3;
  scene.loads[0].kind = core::BoundaryLoad<2>::Kind::velocity;
  scene.loads[0].value[1] = 0.02;
  expect_the_state_to_go_on(scene, 80, 10);
}

TEST(StateInParts, GoesOnInOtherParts3D)
{
  Scene<3> scene;
  scene.packing = packings::make_lattice_packing(box<Case<3, Kind::fcc, false>>(7));
  scene.material.friction = 0.4;
  scene.random_velocity = 0.05;
  scene.law = {Criterion::maximum_tension, 0.02};
  expect_the_state_to_go_on(scene, 40, 8);
}

DemMaterial flowing_material(double yield)
{
  DemMaterial material{1, 0.3, 1, PlaneMode::strain, 0.4};
  YieldCurve curve;
  curve.initial = yield, curve.hardening = 0.05, curve.saturation = yield, curve.rate = 60;
  material.plasticity = VonMisesFlow{curve};
  return material;
}

// While bonds break some particles flow, some have had half of what makes them flow, some nothing.
TEST(StateInParts, GoesOnWhileItFlows2D)
{
  for (const bool viscous : {false, true}) {
    Scene<2> scene;
    auto lattice = box<Case<2, Kind::hexagonal, true>>(20);
    const double half = lattice.upper[0];
    lattice.cracks = {{{-0.5 * half, 0.1 * half}, {0.4 * half, -0.1 * half}}};
    scene.packing = packings::make_lattice_packing(lattice);
    scene.material = flowing_material(0.015);
    if (viscous)
      scene.material.viscosity = {{{0.4, 0.1}, {0.2, 0.02}}, 1e-4};
    scene.random_velocity = 0.025;
    scene.law = {Criterion::maximum_tension, 0.02};
    scene.loads.resize(1);
    scene.loads[0].boundary = 3;
    scene.loads[0].kind = core::BoundaryLoad<2>::Kind::velocity;
    scene.loads[0].value[1] = 0.03;
    expect_the_state_to_go_on(scene, 80, 10, 10);
  }
}

// A wave comes from one end, behind it all flows: which blocks keep a state differs between parts,
// what they save does not. A blow lets the first particles flow that had less than half of it.
TEST(StateInParts, GoesOnWhereAWaveFlows)
{
  Scene<2> scene;
  auto lattice = box<Case<2, Kind::hexagonal, false>>(16);
  lattice.upper[1] *= 4;
  lattice.lower[1] *= 4;
  scene.packing = packings::make_lattice_packing(lattice);
  scene.material = flowing_material(0.004);
  scene.material.friction = 0;
  scene.loads.resize(1);
  scene.loads[0].boundary = 2;
  scene.loads[0].kind = core::BoundaryLoad<2>::Kind::velocity;
  scene.loads[0].value[1] = 0.04;
  expect_the_state_to_go_on(scene, 40, 10, 0);
}

TEST(StateInParts, GoesOnWhileItFlows3D)
{
  Scene<3> scene;
  scene.packing = packings::make_lattice_packing(box<Case<3, Kind::fcc, false>>(7));
  scene.material = flowing_material(0.02);
  scene.material.plasticity = DruckerPragerFlow{0.015, -0.05, 0.4, 0.2};
  scene.random_velocity = 0.04;
  scene.law = {Criterion::principal_stress, 0.02};
  expect_the_state_to_go_on(scene, 40, 8, 10);
}

// Flanks of a crack slide along each other by some spacings, and strangers meet.
TEST(StateInParts, GoesOnWhereJointsWentOn)
{
  Scene<2> scene;
  auto lattice = box<Case<2, Kind::hexagonal, false>>(20);
  const double half = lattice.upper[0];
  lattice.cracks = {{{0.1 * half, -2 * half}, {0.1 * half, 2 * half}}};
  scene.packing = packings::make_lattice_packing(lattice);
  scene.material.friction = 0.4;
  scene.law = {Criterion::maximum_tension, 0.015};
  scene.random_velocity = 0.02;
  scene.loads.resize(2);
  for (int side = 0; side < 2; ++side) {
    scene.loads[side].boundary = side;
    scene.loads[side].kind = core::BoundaryLoad<2>::Kind::velocity;
    scene.loads[side].value[1] = side == 0 ? -0.025 : 0.025;
  }
  expect_the_state_to_go_on(scene, 240, 12);
}

// Everything flies apart: particles of a cut turn and leave its flanks, which all ranks remember.
TEST(StateInParts, GoesOnWherePiecesLeaveACut)
{
  Scene<2> scene;
  auto lattice = box<Case<2, Kind::hexagonal, false>>(14);
  const double half = lattice.upper[0];
  lattice.cracks = {{{0.1 * half, -2 * half}, {0.1 * half, 2 * half}}};
  scene.packing = packings::make_lattice_packing(lattice);
  scene.material.friction = 0.6;
  scene.law = {Criterion::maximum_tension, 0.015};
  scene.random_velocity = 0.05;
  const core::State state = expect_the_state_to_go_on(scene, 240, 12);
  const core::Table &left = core::table(state, "left_flanks");
  EXPECT_GT(left.n_rows(), 0u);
  EXPECT_LT(left.n_rows(), std::size_t(scene.packing.size()) / 2);
}

/// Drawn apart along y, its faces soften; parts with none of them, too.
template <int dim>
Scene<dim> softens(const Packing<dim> &packing, double velocity)
{
  Scene<dim> scene;
  scene.packing = packing;
  scene.material.friction = 0.4;
  scene.law = {Criterion::maximum_tension, 0.02};
  scene.law.energy = 3 * 0.01 * 0.02 * 0.02;
  scene.loads.resize(1);
  scene.loads[0].boundary = 3;
  scene.loads[0].kind = core::BoundaryLoad<dim>::Kind::velocity;
  scene.loads[0].value[1] = velocity;
  return scene;
}

TEST(StateInParts, GoesOnWhereFacesSoften2D)
{
  auto lattice = box<Case<2, Kind::hexagonal, true>>(20);
  const double half = lattice.upper[0];
  lattice.cracks = {{{-0.5 * half, 0.1 * half}, {0.4 * half, -0.1 * half}}};
  auto scene = softens<2>(packings::make_lattice_packing(lattice), 0.04);
  scene.random_velocity = 0.01;
  expect_the_state_to_go_on(scene, 160, 20, 10);
}

TEST(StateInParts, GoesOnWhereFacesSoften3D)
{
  const auto packing = packings::make_lattice_packing(box<Case<3, Kind::fcc, false>>(5.5));
  expect_the_state_to_go_on(softens<3>(packing, 0.06), 60, 10, 5);
}

TEST(StateInParts, GoesOnWhereFacesFall)
{
  const auto packing = packings::make_lattice_packing(box<Case<2, Kind::square, false>>(20));
  auto scene = softens<2>(packing, 0.04);
  scene.law.energy = 0;
  scene.law.crack_velocities = {0.2};
  expect_the_state_to_go_on(scene, 120, 15, 10);
}

// With what dashpots remember, and what the work of accelerations and pressures is booked against.
TEST(StateInParts, GoesOnWhereSidesAbsorbAndPressuresFollow)
{
  Scene<2> flat;
  flat.packing = packings::make_lattice_packing(box<Case<2, Kind::hexagonal, true>>(20));
  flat.random_velocity = 0.04;
  flat.law = {Criterion::maximum_tension, 0.02};
  flat.loads = fall_absorb_and_press<2>(1, 0.03, 0.3);
  expect_the_state_to_go_on(flat, 80, 10);
  Scene<3> solid;
  solid.packing = packings::make_lattice_packing(box<Case<3, Kind::fcc, false>>(7));
  solid.random_velocity = 0.05;
  solid.law = flat.law;
  solid.loads = fall_absorb_and_press<3>(0, 0.02, 0.1);
  expect_the_state_to_go_on(solid, 30, 6);
}

// A part goes on from a state in which blocks rested.
TEST(StateInParts, GoesOnWhereBlocksRested)
{
  Scene<2> scene;
  auto lattice = box<Case<2, Kind::hexagonal, false>>(16);
  lattice.upper[1] *= 4;
  lattice.lower[1] *= 4;
  scene.packing = packings::make_lattice_packing(lattice);
  scene.loads.resize(1);
  scene.loads[0].boundary = 2;
  scene.loads[0].kind = core::BoundaryLoad<2>::Kind::velocity;
  scene.loads[0].value[1] = 1e-3;
  Solver<2> whole(scene, nullptr);
  const double dt = scene.step_share * whole.force->stable_step(whole.solver->state);
  whole.solver->compute_forces(0);
  whole.solver->let_rest();
  for (int s = 1; s < 20; ++s)
    whole.step(dt, s * dt);
  whole.solver->kick(dt);
  whole.solver->drift(dt);
  core::State state;
  whole.solver->save(state);
  const auto held = packings::part_of(scene.packing, some_partition(scene.packing.size(), 1),
                                      test::ranks().rank(), 2);
  Solver<2> part(scene, &held);
  part.solver->let_rest();
  part.solver->load(state);
  whole.solver->compute_forces(20 * dt);
  part.solver->compute_forces(20 * dt);
  for (int s = 21; s < 60; ++s) {
    whole.step(dt, s * dt);
    part.step(dt, s * dt);
  }
  Comparison<2> comparison(part, whole, held.place);
  EXPECT_TRUE(comparison.is_same(dt)) << comparison.differs();
}
} // namespace
} // namespace ligament::dem::testing
