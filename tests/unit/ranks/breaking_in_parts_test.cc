// Bodies in parts that break: which bonds, when and in what order, and all that follows.
#include "tests/unit/ranks/body_in_parts.h"

namespace ligament::dem::testing
{
namespace
{
using Criterion = FractureLaw::Criterion;

/// Two opposite sides are drawn apart along an axis.
template <int dim>
std::vector<core::BoundaryLoad<dim>> draw_apart(int axis, double velocity)
{
  using Kind = typename core::BoundaryLoad<dim>::Kind;
  std::vector<core::BoundaryLoad<dim>> loads(2);
  for (int side = 0; side < 2; ++side) {
    loads[side].boundary = 2 * axis + side;
    loads[side].kind = Kind::velocity;
    loads[side].value[axis] = (side == 0 ? -1 : 1) * velocity;
  }
  return loads;
}

template <typename C>
struct BreakingInParts : ::testing::Test
{
};
TYPED_TEST_SUITE(BreakingInParts, Cases);

// Fast enough that the body breaks within some crossings of the waves, at many places.
TYPED_TEST(BreakingInParts, BreaksLikeTheWholeLattice)
{
  constexpr int dim = TypeParam::dim;
  Scene<dim> scene;
  scene.packing = packings::make_lattice_packing(box<TypeParam>(dim == 2 ? 24 : 8));
  int n_broken = 0, n_across = 0;
  for (const int axis : {0, dim - 1})
    for (const auto &criterion : {Criterion::maximum_tension, Criterion::face_tension}) {
      scene.law = {criterion, 0.02};
      scene.loads = draw_apart<dim>(axis, 0.03);
      const Outcome outcome = expect_parts_to_move_like_the_whole(scene, dim == 2 ? 150 : 60, axis);
      n_broken += outcome.n_broken;
      n_across += outcome.n_across;
    }
  EXPECT_GT(n_broken, 100); // else the test would say little
  EXPECT_EQ(n_across > 0, test::ranks().size() > 1);
}

// Everything flies apart and together again: contacts, friction, searches.
TYPED_TEST(BreakingInParts, CrushesLikeTheWholeLattice)
{
  constexpr int dim = TypeParam::dim;
  Scene<dim> scene;
  scene.packing = packings::make_lattice_packing(box<TypeParam>(dim == 2 ? 20 : 7));
  scene.material.friction = 0.4;
  scene.random_velocity = 0.05;
  scene.law = {Criterion::maximum_tension, 0.02};
  const Outcome outcome = expect_parts_to_move_like_the_whole(scene, dim == 2 ? 70 : 40, 1);
  EXPECT_GT(outcome.n_broken, 100);
  EXPECT_GT(outcome.friction, 0);
  EXPECT_EQ(outcome.n_across > 0, test::ranks().size() > 1);
}

/// A box with an initial crack through its middle, along an axis (the crack's normal is the other).
Packing<2> cracked(int along, bool turned)
{
  auto lattice = box<Case<2, Kind::hexagonal, false>>(24);
  if (turned)
    lattice.orientation[0] = 0.3;
  const double half = lattice.upper[0];
  Vector<2> from = Vector<2>::Zero(), to = from;
  from[along] = -0.6 * half, to[along] = 0.5 * half;
  lattice.cracks = {{from, to}};
  return packings::make_lattice_packing(lattice);
}

// Flanks are pressed together and slide while the crack grows, along the seams and across them.
TEST(BreakingInParts, CracksSlideAndGrowLikeThoseOfTheWhole)
{
  for (const int along : {0, 1})
    for (const bool turned : {false, true}) {
      Scene<2> scene;
      scene.packing = cracked(along, turned);
      scene.material.friction = 0.3;
      scene.law = {Criterion::maximum_tension, 0.02};
      scene.loads = draw_apart<2>(1 - along, -0.01); // presses
      for (auto &load : scene.loads)
        load.value[along] = 0.5 * *load.value[1 - along];
      const Outcome outcome = expect_parts_to_move_like_the_whole(scene, 250, 2);
      EXPECT_GT(outcome.n_broken, 0);
      EXPECT_GT(outcome.friction, 0);
    }
}

template <int dim>
Outcome break_random(double n, int steps)
{
  packings::RandomParameters<dim> random;
  random.spacing = 0.01;
  random.size_ratio = 1.5;
  for (int c = 0; c < dim; ++c)
    random.upper[c] = 0.01 * n;
  Scene<dim> scene;
  scene.packing = packings::make_random_packing(random).packing;
  scene.material.friction = 0.4;
  scene.random_velocity = 0.03;
  scene.law = {Criterion::maximum_tension, 0.02};
  scene.loads = draw_apart<dim>(1, 0.02);
  return expect_parts_to_move_like_the_whole(scene, steps, 1);
}

TEST(BreakingInParts, BreaksLikeTheWholeRandom2D)
{
  const Outcome outcome = break_random<2>(22, 80);
  EXPECT_GT(outcome.n_broken, 100);
  EXPECT_EQ(outcome.n_across > 0, test::ranks().size() > 1);
}
TEST(BreakingInParts, BreaksLikeTheWholeRandom3D)
{
  const Outcome outcome = break_random<3>(7.5, 40);
  EXPECT_GT(outcome.n_broken, 100);
  EXPECT_EQ(outcome.n_across > 0, test::ranks().size() > 1);
}

// Flanks of a notch are pressed onto each other: particles touch that were never near. Of an even
// number of ranks a seam lies between the flanks. With the last law nothing ever breaks.
TEST(BreakingInParts, MeetsStrangersLikeTheWhole)
{
  for (const FractureLaw &law : {FractureLaw{Criterion::maximum_tension, 0.02},
                                 FractureLaw{Criterion::face_tension, 0.02}, FractureLaw()})
  {
    Scene<2> scene;
    auto lattice = box<Case<2, Kind::hexagonal, false>>(16);
    const double half = lattice.upper[0];
    lattice.notches = {{{-0.9 * half, -0.2 * half}, {2 * half, 0.2 * half}}}; // open to the right
    scene.packing = packings::make_lattice_packing(lattice);
    scene.law = law;
    scene.material.friction = 0.3;
    scene.loads = draw_apart<2>(1, -0.08);
    scene.loads[0].value[0] = 0.03; // and along each other
    const Outcome outcome = expect_parts_to_move_like_the_whole(scene, 200, 0);
    EXPECT_GT(outcome.n_found, 0);
    const bool seam_is_between = test::ranks().size() % 2 == 0;
    EXPECT_TRUE(outcome.n_met > 0 || !seam_is_between);
  }
}

// Two halves slide along each other by five spacings, across all seams: joints go on from particle
// to particle, and from rank to rank.
TEST(BreakingInParts, JointsGoOnFromRankToRank)
{
  for (const bool turned : {false, true}) {
    Scene<2> scene;
    auto lattice = box<Case<2, Kind::hexagonal, false>>(20);
    if (turned)
      lattice.orientation[0] = 0.3;
    const double half = lattice.upper[0];
    lattice.cracks = {{{0.1 * half, -2 * half}, {0.1 * half, 2 * half}}};
    scene.packing = packings::make_lattice_packing(lattice);
    scene.material.friction = 0.2;
    scene.loads = draw_apart<2>(0, -2e-4);
    scene.loads[0].value[1] = -0.025;
    scene.loads[1].value[1] = 0.025;
    scene.law = {Criterion::face_tension, 1.}; // nothing breaks
    const Outcome outcome = expect_parts_to_move_like_the_whole(scene, 250, 1);
    EXPECT_GT(outcome.n_found, 5); // passed on
    EXPECT_GT(outcome.friction, 0);
    EXPECT_EQ(outcome.n_met > 0, test::ranks().size() > 1);
  }
}

// A corner far from all else is torn off and falls back, while the other end of the body rests.
TEST(BreakingInParts, RestsWhereNothingHasArrived)
{
  Scene<2> scene;
  auto lattice = box<Case<2, Kind::hexagonal, false>>(16);
  lattice.lower[1] *= 4;
  lattice.upper[1] *= 4;
  scene.packing = packings::make_lattice_packing(lattice);
  scene.may_rest = true;
  scene.material.friction = 0.3;
  scene.law = {Criterion::maximum_tension, 0.02};
  scene.loads = draw_apart<2>(1, 0.04);
  scene.loads.resize(1);
  for (const unsigned cut : {0u, 3u}) {
    const Outcome outcome = expect_parts_to_move_like_the_whole(scene, 70, cut);
    EXPECT_GT(outcome.n_broken, 10);
    EXPECT_TRUE(test::ranks().any(outcome.at_rest > 0)); // else the test would say nothing
  }
}
} // namespace
} // namespace ligament::dem::testing
