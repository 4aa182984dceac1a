// Bodies in parts whose particles have strains of their own: ghosts flow by themselves, with the
// bits of their owners.
#include "tests/unit/ranks/body_in_parts.h"

namespace ligament::dem::testing
{
namespace
{
using Criterion = FractureLaw::Criterion;

/// One side is held, the opposite one drawn along and aside, a third one under a traction.
template <int dim>
std::vector<core::BoundaryLoad<dim>> drawn_and_pressed(int axis, double velocity)
{
  using LoadKind = typename core::BoundaryLoad<dim>::Kind;
  std::vector<core::BoundaryLoad<dim>> loads(3);
  loads[0].boundary = 2 * axis, loads[0].kind = LoadKind::displacement;
  for (auto &value : loads[0].value)
    value = 0;
  loads[1].boundary = 2 * axis + 1, loads[1].kind = LoadKind::velocity;
  loads[1].value[axis] = velocity, loads[1].value[(axis + 1) % dim] = -0.2 * velocity;
  loads[2].boundary = 2 * ((axis + 1) % dim), loads[2].kind = LoadKind::traction;
  loads[2].value[0] = 2e-4, loads[2].value[1] = -1e-4;
  return loads;
}

YieldCurve straight(double yield)
{
  YieldCurve curve;
  curve.initial = yield, curve.hardening = 0.1;
  return curve;
}
YieldCurve voce(double yield)
{
  YieldCurve curve;
  curve.initial = yield, curve.hardening = 0.05, curve.saturation = yield, curve.rate = 60;
  return curve;
}
YieldCurve table(double yield)
{
  YieldCurve curve;
  curve.strain = {0, 0.002, 0.01}, curve.stress = {yield, 1.5 * yield, 2 * yield};
  return curve;
}

/// Some particles flow, some come near it, some don't.
std::vector<Plasticity> laws(double yield)
{
  return {VonMisesFlow{straight(yield)}, VonMisesFlow{voce(yield)}, VonMisesFlow{table(yield)},
          DruckerPragerFlow{0.6 * yield, 0.1, 0.5, 0.3},
          DruckerPragerFlow{0.6 * yield, -0.05, 0.4, 0}};
}

/// Branches, a dashpot, both, in units of a time near the step.
std::vector<Viscosity> viscosities()
{
  return {{{{0.5, 0.03}, {0.3, 0.2}}, 0}, {{}, 1e-3}, {{{0.5, 0.03}}, 3e-4}};
}

template <typename C>
struct FlowInParts : ::testing::Test
{
};
TYPED_TEST_SUITE(FlowInParts, Cases);

/// With a hole or a notch, whose cells are open and loose here and there.
template <typename C>
Packing<C::dim> holed()
{
  constexpr int dim = C::dim;
  auto lattice = box<C>(dim == 2 ? 24 : 8);
  const double half = lattice.upper[0];
  if constexpr (dim == 2)
    lattice.holes = {{{0.3 * half, -0.2 * half}, 0.2 * half}};
  else
    lattice.notches = {
        {{-0.3 * half, -2 * half, -0.3 * half}, {0.3 * half, -0.4 * half, half / 8}}};
  return packings::make_lattice_packing(lattice);
}

TYPED_TEST(FlowInParts, FlowsLikeTheWholeLattice)
{
  constexpr int dim = TypeParam::dim;
  Scene<dim> scene;
  scene.packing = holed<TypeParam>();
  scene.random_velocity = 1e-2;
  unsigned cut = 0;
  for (const Plasticity &law : laws(0.006))
    for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress}) {
      if (dim == 3 && plane == PlaneMode::stress)
        continue;
      scene.material.plane = plane;
      scene.material.plasticity = law;
      scene.loads = drawn_and_pressed<dim>(cut % dim, 1e-2);
      const Outcome outcome =
          expect_parts_to_move_like_the_whole(scene, dim == 2 ? 60 : 20, cut++ % 4);
      EXPECT_GT(outcome.share_flowed, 0.1); // else the test would say nothing
      EXPECT_LT(outcome.share_flowed, 1);
      EXPECT_GT(outcome.plastic, 0);
    }
}

TYPED_TEST(FlowInParts, CreepsLikeTheWholeLattice)
{
  constexpr int dim = TypeParam::dim;
  Scene<dim> scene;
  scene.packing = holed<TypeParam>();
  scene.random_velocity = 1e-2;
  unsigned cut = 1;
  for (const Viscosity &viscosity : viscosities())
    for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress})
      for (const bool flows : {false, true}) {
        if (dim == 3 && plane == PlaneMode::stress)
          continue;
        scene.material.plane = plane;
        scene.material.viscosity = viscosity;
        scene.material.plasticity =
            flows ? Plasticity(VonMisesFlow{straight(0.006)}) : Plasticity();
        scene.loads = drawn_and_pressed<dim>(cut % dim, 1e-2);
        const Outcome outcome =
            expect_parts_to_move_like_the_whole(scene, dim == 2 ? 30 : 15, cut++ % 4);
        EXPECT_GT(outcome.viscous, 0);
        EXPECT_EQ(outcome.plastic > 0, flows);
      }
}

// Faces that break change the strains of both particles: on all that hold them, in one order. The
// criteria see tractions, or the stresses of both.
TYPED_TEST(FlowInParts, BreaksAndFlowsLikeTheWholeLattice)
{
  constexpr int dim = TypeParam::dim;
  Scene<dim> scene;
  scene.packing = packings::make_lattice_packing(box<TypeParam>(dim == 2 ? 20 : 7));
  scene.material.friction = 0.4;
  scene.random_velocity = 0.03;
  int n_broken = 0, n_across = 0;
  unsigned cut = 0;
  for (const auto &criterion : {Criterion::maximum_tension, Criterion::principal_stress})
    for (const bool viscous : {false, true}) {
      scene.law = {criterion, 0.02};
      scene.material.plasticity = cut % 2 ? laws(0.02)[1] : laws(0.02)[3];
      scene.material.viscosity = viscous ? viscosities()[cut % 3] : Viscosity();
      scene.loads = drawn_and_pressed<dim>(cut % dim, 0.03);
      const Outcome outcome = expect_parts_to_move_like_the_whole(scene, dim == 2 ? 60 : 30, cut++);
      n_broken += outcome.n_broken;
      n_across += outcome.n_across;
      EXPECT_GT(outcome.share_flowed, 0.005);
    }
  EXPECT_GT(n_broken, 50); // else the test would say little
  EXPECT_EQ(n_across > 0, test::ranks().size() > 1);
}

template <int dim>
Scene<dim> random_scene(double n)
{
  packings::RandomParameters<dim> random;
  random.spacing = 0.01;
  random.size_ratio = 1.5;
  for (int c = 0; c < dim; ++c)
    random.upper[c] = 0.01 * n;
  Scene<dim> scene;
  scene.packing = packings::make_random_packing(random).packing;
  scene.material.friction = 0.4;
  scene.loads = drawn_and_pressed<dim>(1, 0.02);
  return scene;
}

template <int dim>
void expect_random_bodies_to_flow_like_the_whole(double n, int steps)
{
  Scene<dim> scene = random_scene<dim>(n);
  unsigned cut = 0;
  for (const bool breaks : {false, true})
    for (const bool viscous : {false, true}) {
      scene.random_velocity = breaks ? 0.03 : 0.01;
      const double yield = breaks ? 0.02 : 0.006;
      scene.material.plasticity = cut % 2 ? laws(yield)[1] : laws(yield)[3];
      scene.material.viscosity = viscous ? viscosities()[2] : Viscosity();
      scene.law = breaks ? FractureLaw{Criterion::maximum_tension, 0.02} : FractureLaw();
      const Outcome outcome = expect_parts_to_move_like_the_whole(scene, steps, cut++);
      EXPECT_GT(outcome.share_flowed, 0.005);
      EXPECT_EQ(outcome.n_broken > 20, breaks);
      EXPECT_EQ(outcome.n_across > 0, breaks && test::ranks().size() > 1);
    }
}

TEST(FlowInParts, FlowsLikeTheWholeRandom2D)
{
  expect_random_bodies_to_flow_like_the_whole<2>(22, 70);
}
TEST(FlowInParts, FlowsLikeTheWholeRandom3D)
{
  expect_random_bodies_to_flow_like_the_whole<3>(7.5, 30);
}

// A wave that makes the body flow comes through the seams to particles that rest.
TEST(FlowInParts, RestsUntilTheWaveOfAnotherRankArrives)
{
  Scene<2> scene;
  auto lattice = box<Case<2, Kind::hexagonal, false>>(16);
  lattice.lower[1] *= 4;
  lattice.upper[1] *= 4;
  scene.packing = packings::make_lattice_packing(lattice);
  scene.may_rest = true;
  scene.material.plasticity = VonMisesFlow{voce(0.004)};
  scene.loads.resize(1);
  scene.loads[0].boundary = 2;
  scene.loads[0].kind = core::BoundaryLoad<2>::Kind::velocity;
  scene.loads[0].value[1] = 1e-2;
  const Outcome outcome = expect_parts_to_move_like_the_whole(scene, 60, 1);
  EXPECT_TRUE(test::ranks().any(outcome.at_rest > 0)); // else the test would say nothing
  EXPECT_GT(outcome.share_flowed, 0.05);
}
} // namespace
} // namespace ligament::dem::testing
