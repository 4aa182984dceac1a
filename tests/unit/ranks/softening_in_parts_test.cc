// Bodies in parts whose faces soften or fall: which open, how far, what that takes, and when they
// are torn.
#include "tests/unit/ranks/body_in_parts.h"

namespace ligament::dem::testing
{
namespace
{
using Criterion = FractureLaw::Criterion;

constexpr double strength = 0.02;

/// Over so many spacings of 0.01 m, of E = 1.
FractureLaw softening(double lengths, const Softening &shape = {})
{
  FractureLaw law{Criterion::maximum_tension, strength};
  law.energy = lengths * 0.01 * strength * strength;
  law.softening = shape;
  return law;
}

/// Two opposite sides move apart along an axis.
template <int dim>
std::vector<core::BoundaryLoad<dim>> draw_apart(int axis, double velocity)
{
  std::vector<core::BoundaryLoad<dim>> loads(2);
  for (int side = 0; side < 2; ++side) {
    loads[side].boundary = 2 * axis + side;
    loads[side].kind = core::BoundaryLoad<dim>::Kind::velocity;
    loads[side].value[axis] = (side == 0 ? -1 : 1) * velocity;
  }
  return loads;
}

template <typename C>
struct SofteningInParts : ::testing::Test
{
};
TYPED_TEST_SUITE(SofteningInParts, Cases);

// At many places at once: one cluster of faces through all ranks.
TYPED_TEST(SofteningInParts, OpensAndTearsLikeTheWholeLattice)
{
  constexpr int dim = TypeParam::dim;
  Scene<dim> scene;
  scene.packing = packings::make_lattice_packing(box<TypeParam>(dim == 2 ? 16 : 6));
  scene.material.friction = 0.4;
  int n_torn = 0, n_soft = 0, n_told = 0;
  for (const int axis : {0, dim - 1}) {
    scene.law = softening(3, axis == 0 ? Softening{} : Softening{1 / 3., 0.8});
    scene.loads = draw_apart<dim>(axis, 0.03);
    const Outcome outcome = expect_parts_to_move_like_the_whole(scene, dim == 2 ? 100 : 40, axis);
    n_torn += outcome.n_broken;
    n_soft += outcome.n_soft;
    n_told += outcome.n_told;
  }
  EXPECT_GT(n_torn, 10); // else the test would say little
  EXPECT_GT(n_soft, 50);
  EXPECT_EQ(n_told > 0, test::ranks().size() > 1);
}

/// A box with a notch and a crack that goes on from its end, along an axis or at an angle.
Packing<2> cracked(const Vector<2> &way, bool turned)
{
  auto lattice = box<Case<2, Kind::hexagonal, false>>(15);
  if (turned)
    lattice.orientation[0] = 0.3;
  const double half = lattice.upper[0];
  lattice.cracks = {{Vector<2>(-0.7 * half * way), Vector<2>(0.2 * half * way)}};
  return packings::make_lattice_packing(lattice);
}

// A crack grows along the seams, across and at an angle to them; the loads go there and back: faces
// unload, shut, and open further.
TEST(SofteningInParts, CracksOpenAndShutLikeThoseOfTheWhole)
{
  int n_torn = 0;
  for (const bool turned : {false, true})
    for (const double degrees : {turned ? 40. : 0., 90.}) {
      const double angle = degrees * M_PI / 180;
      Scene<2> scene;
      scene.packing = cracked({std::cos(angle), std::sin(angle)}, turned);
      scene.material.friction = 0.3;
      scene.law = softening(4);
      scene.law.mode_ratio = 0.8;
      scene.loads = draw_apart<2>(degrees > 45 ? 0 : 1, 0);
      for (int side = 0; side < 2; ++side) {
        auto &load = scene.loads[side];
        const double sign = side == 0 ? -1 : 1;
        load.value[degrees > 45 ? 0 : 1] = sign * 0.012;
        load.value[degrees > 45 ? 1 : 0] = sign * 0.003;
        load.history = core::Cycles{core::Ramp{0.05}, 0.4, 1, 0.3};
      }
      const Outcome outcome = expect_parts_to_move_like_the_whole(scene, 180, 2);
      n_torn += outcome.n_broken;
      EXPECT_GT(outcome.n_soft, 10) << degrees;
      EXPECT_TRUE(outcome.has_reloaded) << degrees;
    }
  EXPECT_GT(n_torn, 0);
}

// Each of two cracks is far from the other one: where no other rank sees it, its own opens it
// alone.
TEST(SofteningInParts, WhatNobodyElseSeesIsNotTold)
{
  Scene<2> scene;
  auto lattice = box<Case<2, Kind::hexagonal, false>>(12);
  lattice.lower[1] *= 6;
  lattice.upper[1] *= 6;
  const double half = lattice.upper[0], height = lattice.upper[1];
  for (const double y : {-0.75, -0.27, 0.26, 0.75})
    lattice.cracks.push_back(
        {Vector<2>(-2 * half, y * height), Vector<2>(-0.3 * half, y * height)});
  scene.packing = packings::make_lattice_packing(lattice);
  scene.law = softening(4);
  scene.loads = draw_apart<2>(1, 0.03);
  for (const unsigned cut : {0u, 1u}) {
    const Outcome outcome = expect_parts_to_move_like_the_whole(scene, 150, cut);
    EXPECT_GT(outcome.n_soft, 20);
    EXPECT_GT(outcome.n_untold, 0);
  }
}

template <int dim>
Outcome soften_random(double n, int steps, const FractureLaw &law)
{
  packings::RandomParameters<dim> random;
  random.spacing = 0.01;
  random.size_ratio = 1.5;
  for (int c = 0; c < dim; ++c)
    random.upper[c] = 0.01 * n;
  Scene<dim> scene;
  scene.packing = packings::make_random_packing(random).packing;
  scene.material.friction = 0.4;
  scene.random_velocity = 0.01;
  scene.law = law;
  scene.loads = draw_apart<dim>(1, 0.03);
  return expect_parts_to_move_like_the_whole(scene, steps, 1);
}

// Strengths that scatter, too.
TEST(SofteningInParts, OpensAndTearsLikeTheWholeRandom2D)
{
  FractureLaw law = softening(3, {1 / 3., 0.8});
  law.strength.scatter.modulus = 20;
  const Outcome outcome = soften_random<2>(18, 80, law);
  EXPECT_GT(outcome.n_broken, 10);
  EXPECT_EQ(outcome.n_soft_across > 0, test::ranks().size() > 1);
}
TEST(SofteningInParts, OpensAndTearsLikeTheWholeRandom3D)
{
  const Outcome outcome = soften_random<3>(6, 40, softening(3));
  EXPECT_GT(outcome.n_broken, 10);
  EXPECT_EQ(outcome.n_soft_across > 0, test::ranks().size() > 1);
}

// Cracks of limited velocity: faces fall in time, some break at once as they are pressed.
TEST(SofteningInParts, FallsLikeTheWhole)
{
  for (const Criterion criterion :
       {Criterion(Criterion::maximum_tension), Criterion(Criterion::face_tension),
        Criterion(Criterion::mohr_coulomb)})
  {
    FractureLaw law{criterion, strength};
    law.strength.compressive = 3;
    law.strength.cohesion = 1;
    law.strength.friction_angle = 0.4;
    law.crack_velocities = {0.2};
    const Outcome outcome = soften_random<2>(18, 80, law);
    EXPECT_GT(outcome.n_broken, 20);
    EXPECT_GT(outcome.n_soft, 20);
  }
}

// A corner is torn off, while the other end of the body rests.
TEST(SofteningInParts, RestsWhereNothingHasArrived)
{
  Scene<2> scene;
  auto lattice = box<Case<2, Kind::hexagonal, false>>(16);
  lattice.lower[1] *= 4;
  lattice.upper[1] *= 4;
  scene.packing = packings::make_lattice_packing(lattice);
  scene.may_rest = true;
  scene.law = softening(3);
  scene.loads = draw_apart<2>(1, 0.04);
  scene.loads.resize(1);
  const Outcome outcome = expect_parts_to_move_like_the_whole(scene, 70, 3);
  EXPECT_GT(outcome.n_soft, 10);
  EXPECT_TRUE(test::ranks().any(outcome.at_rest > 0)); // else the test would say nothing
}
} // namespace
} // namespace ligament::dem::testing
