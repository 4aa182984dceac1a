// Relaxed seeds as a table are the same seeds again, and give the same packing, bit by bit.
#include "packings/packing_state.h"
#include "packings/random_packing.h"
#include "tests/unit/ranks/packing_oracle.h"

#include <gtest/gtest.h>

namespace ligament::packings
{
namespace
{
template <int dim>
RandomParameters<dim> small_specimen()
{
  RandomParameters<dim> p;
  p.spacing = 0.01;
  p.thickness = 0.3;
  p.size_ratio = 3;
  p.relaxation_sweeps = 2;
  p.lower = Vector<dim>::Zero();
  p.upper = Vector<dim>::Constant(0.1);
  return p;
}

template <int dim>
void expect_the_same_packing(const RandomParameters<dim> &p)
{
  const RandomPacking<dim> made = make_random_packing(p);
  EXPECT_GT(made.n_healed, 0); // radii are those before
  const Seeds<dim> seeds = make_random_seeds(p), read = seeds_of<dim>(table_of(seeds));
  EXPECT_EQ(seeds.centre, read.centre);
  EXPECT_EQ(seeds.radius, read.radius);
  EXPECT_EQ(seeds.id, read.id);
  const RandomPacking<dim> again = pack_relaxed_seeds<dim>(p, read);
  testing::expect_same_packing(made.packing, again.packing);
  EXPECT_EQ(made.seeds.centre, again.seeds.centre);
  EXPECT_EQ(made.seeds.radius, again.seeds.radius);
  EXPECT_EQ(made.seeds.id, again.seeds.id);
  EXPECT_EQ(made.n_healed, again.n_healed);
}

TEST(PackingState, IsTheSamePackingAgain)
{
  auto plane = small_specimen<2>();
  plane.zone_upper[0] = 0.07;
  plane.cracks = {{{0.02, 0.05}, {0.06, 0.05}}};
  expect_the_same_packing(plane);
  auto space = small_specimen<3>();
  space.zone_upper[0] = 0.07;
  space.cracks = {{{0.02, 0.05, 0}, {0.06, 0.05, 0}, {0.06, 0.05, 0.1}, {0.02, 0.05, 0.1}}};
  expect_the_same_packing(space);
}

TEST(PackingState, IsTheSameBetweenJoinedSides)
{
  auto plane = small_specimen<2>();
  plane.periodic[0] = true;
  expect_the_same_packing(plane);
}

TEST(PackingState, HasMaterials)
{
  Seeds<2> seeds;
  for (int k = 0; k < 3; ++k)
    seeds.add(Vector<2>(k, 1), 0.5, 7 * k);
  EXPECT_TRUE(seeds_of<2>(table_of(seeds)).material.empty());
  seeds.material = {0, 2, 1};
  EXPECT_EQ(seeds_of<2>(table_of(seeds)).material, seeds.material);
}
} // namespace
} // namespace ligament::packings
