// Bodies in parts on ranks: forces, motion, energies, reactions and work have the bits of the
// whole.
#include "tests/unit/ranks/body_in_parts.h"

namespace ligament::dem::testing
{
namespace
{
/// One side is held, the opposite one drawn along and aside, a third one under a traction.
template <int dim>
std::vector<core::BoundaryLoad<dim>> draw_and_press(int axis)
{
  using Kind = typename core::BoundaryLoad<dim>::Kind;
  std::vector<core::BoundaryLoad<dim>> loads(3);
  loads[0].boundary = 2 * axis, loads[0].kind = Kind::displacement;
  for (auto &value : loads[0].value)
    value = 0;
  loads[1].boundary = 2 * axis + 1, loads[1].kind = Kind::velocity;
  loads[1].value[axis] = 1e-3, loads[1].value[(axis + 1) % dim] = -2e-4;
  loads[2].boundary = 2 * ((axis + 1) % dim), loads[2].kind = Kind::traction;
  loads[2].value[0] = 2e-4, loads[2].value[1] = -1e-4;
  return loads;
}

template <typename C>
struct BodyInParts : ::testing::Test
{
};
TYPED_TEST_SUITE(BodyInParts, Cases);

TYPED_TEST(BodyInParts, MovesLikeTheWholeLattice)
{
  constexpr int dim = TypeParam::dim;
  auto lattice = box<TypeParam>(dim == 2 ? 24 : 8);
  const double half = lattice.upper[0];
  if constexpr (dim == 2)
    lattice.holes = {{{0.3 * half, -0.2 * half}, 0.2 * half}};
  else
    lattice.notches = {
        {{-0.3 * half, -2 * half, -0.3 * half}, {0.3 * half, -0.4 * half, half / 8}}};
  Scene<dim> scene;
  scene.packing = packings::make_lattice_packing(lattice);
  scene.random_velocity = 1e-2;
  for (const int axis : {0, dim - 1}) {
    scene.loads = draw_and_press<dim>(axis);
    for (const unsigned cut : {0u, 1u, 2u})
      expect_parts_to_move_like_the_whole(scene, dim == 2 ? 200 : 60, cut);
  }
}

// What acts on all masses, lets waves out and turns with the surface.
TYPED_TEST(BodyInParts, FallsAndAbsorbsLikeTheWholeLattice)
{
  constexpr int dim = TypeParam::dim;
  Scene<dim> scene;
  const auto lattice = box<TypeParam>(dim == 2 ? 22 : 8);
  scene.packing = packings::make_lattice_packing(lattice);
  scene.random_velocity = 1e-2;
  for (const int axis : {0, dim - 1})
    for (const double layer : {0., 3 * lattice.spacing}) {
      scene.loads = fall_absorb_and_press<dim>(axis, layer, 0.2);
      expect_parts_to_move_like_the_whole(scene, dim == 2 ? 100 : 40, axis + 1);
    }
}

TYPED_TEST(BodyInParts, MovesLikeTheWholeWithoutDilatation)
{
  constexpr int dim = TypeParam::dim;
  Scene<dim> scene;
  scene.packing = packings::make_lattice_packing(box<TypeParam>(dim == 2 ? 20 : 7));
  scene.material.poissons_ratio = 0;
  scene.random_velocity = 1e-2;
  expect_parts_to_move_like_the_whole(scene, 60, 3);
}

template <int dim>
Scene<dim> random_scene(double n)
{
  packings::RandomParameters<dim> random;
  random.spacing = 0.01;
  random.size_ratio = 1.5;
  random.thickness = dim == 2 ? 0.3 : 1;
  for (int c = 0; c < dim; ++c)
    random.upper[c] = 0.01 * n;
  Scene<dim> scene;
  scene.packing = packings::make_random_packing(random).packing;
  scene.random_velocity = 1e-2;
  scene.loads = draw_and_press<dim>(1);
  return scene;
}

TEST(BodyInParts, MovesLikeTheWholeRandom2D)
{
  for (const unsigned cut : {0u, 1u, 2u})
    expect_parts_to_move_like_the_whole(random_scene<2>(25), 300, cut);
}
TEST(BodyInParts, MovesLikeTheWholeRandom3D)
{
  for (const unsigned cut : {0u, 1u})
    expect_parts_to_move_like_the_whole(random_scene<3>(8), 100, cut);
}
TEST(BodyInParts, FallsAndAbsorbsLikeTheWholeRandom)
{
  Scene<2> flat = random_scene<2>(25);
  flat.loads = fall_absorb_and_press<2>(1, 0.04, 0.2);
  expect_parts_to_move_like_the_whole(flat, 100, 1);
  Scene<3> solid = random_scene<3>(8);
  solid.loads = fall_absorb_and_press<3>(0, 0.02, 0.2);
  expect_parts_to_move_like_the_whole(solid, 40, 1);
}

// A side is pushed; the wave comes through the seams to particles that rest.
TYPED_TEST(BodyInParts, RestsUntilTheWaveOfAnotherRankArrives)
{
  constexpr int dim = TypeParam::dim;
  using Kind = typename core::BoundaryLoad<dim>::Kind;
  auto lattice = box<TypeParam>(dim == 2 ? 16 : 6);
  lattice.upper[dim - 1] *= 4;
  lattice.lower[dim - 1] *= 4;
  Scene<dim> scene;
  scene.packing = packings::make_lattice_packing(lattice);
  scene.may_rest = true;
  scene.loads.resize(1);
  scene.loads[0].boundary = 2 * (dim - 1);
  scene.loads[0].kind = Kind::velocity;
  scene.loads[0].value[dim - 1] = 1e-3;
  const Outcome outcome = expect_parts_to_move_like_the_whole(scene, dim == 2 ? 60 : 25, 1);
  const double least = test::ranks().any(outcome.at_rest > 0) ? 1 : 0;
  EXPECT_EQ(least, 1); // else the test would say nothing
}

// The force refuses on all ranks what it knows in one process only.
TEST(BodyInParts, RefusesWhatNeedsOneProcess)
{
  Scene<2> scene;
  scene.packing = packings::make_lattice_packing(box<Case<2, Kind::hexagonal, false>>(20));
  scene.law = {FractureLaw::Criterion::maximum_tension, 1e-3};
  scene.law.energy = 1e-6;
  YieldCurve curve;
  curve.initial = 1e-3;
  scene.material.plasticity = VonMisesFlow{curve};
  const auto partition = some_partition(scene.packing.size(), 0);
  const auto held = packings::part_of(scene.packing, partition, test::ranks().rank(), 3);
  if (test::ranks().is_one())
    EXPECT_NO_THROW(Solver<2>(scene, &held));
  else
    EXPECT_THROW(Solver<2>(scene, &held), core::InputError);
}
} // namespace
} // namespace ligament::dem::testing
