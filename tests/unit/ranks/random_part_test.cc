// Random packings that ranks relax and cut by part are those of one process.
#include "packings/gathered_part.h"
#include "packings/random_part.h"
#include "particles/block_sum.h"
#include "tests/support/ranks.h"
#include "tests/unit/ranks/packing_oracle.h"

#include "core/check.h"

#include <gtest/gtest.h>

namespace ligament::packings::testing
{
namespace
{
using test::ranks;

void expect_same_ranges(const particles::ParticleRanges &a, const particles::ParticleRanges &b)
{
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k)
    EXPECT_TRUE(a[k].begin == b[k].begin && a[k].end == b[k].end);
}

template <int dim>
void expect_same_seeds(const Seeds<dim> &a, const Seeds<dim> &b)
{
  EXPECT_EQ(a.centre, b.centre);
  EXPECT_EQ(a.radius, b.radius);
  EXPECT_EQ(a.id, b.id);
}

template <int dim>
void expect_the_part(const RandomParameters<dim> &p, const Seeds<dim> &seeds,
                     const RandomPacking<dim> &whole, int rings, const Groups<dim> &groups = {},
                     const std::vector<std::int64_t> &weights = {})
{
  const auto partition = particles::make_partition(whole.packing.size(), ranks().size(), weights);
  const PackingPart<dim> expected =
      part_of(whole.packing, partition, ranks().rank(), rings, 0, groups);
  const RandomPart<dim> part = make_random_part(p, seeds, ranks(), rings, groups, weights);
  const PackingPart<dim> &found = part.held;
  EXPECT_EQ(found.n_whole, whole.packing.size());
  EXPECT_EQ(found.place, expected.place);
  EXPECT_EQ(found.owner, expected.owner);
  expect_same_ranges(found.part.owned, expected.part.owned);
  expect_same_ranges(found.part.stepped, expected.part.stepped);
  expect_same_ranges(found.part.pressed, expected.part.pressed);
  expect_same_ranges(found.part.turned, expected.part.turned);
  expect_same_packing(found.packing, expected.packing);
  expect_same_seeds(part.seeds, whole.seeds);
  EXPECT_EQ(part.n_healed, whole.n_healed);
  for (int r = 0; r <= rings; ++r)
    expect_same_packing(gather_grouped(found, groups, r, ranks()),
                        grouped_part(whole.packing, groups, r));
}

/// With groups of several sizes and pieces of unequal size, some of them empty.
template <int dim>
void expect_the_parts(const RandomParameters<dim> &p, double most)
{
  const RandomPacking<dim> whole = make_random_packing(p);
  const Seeds<dim> seeds = make_random_seeds(p, ranks());
  expect_same_seeds(seeds, make_random_seeds(p));
  EXPECT_GT(whole.packing.size(), 4 * particles::sum_block);
  std::mt19937 random(5);
  for (int trial = 0; trial < 4; ++trial) {
    const int rings = 2 + trial % 2;
    expect_the_part(p, seeds, whole, rings);
    const Groups<dim> groups =
        random_cells<dim>(random, p.upper, trial < 2 ? most : 1.5, trial < 2 ? most : 4);
    std::vector<std::int64_t> weights;
    for (int b = 0; b * particles::sum_block < whole.packing.size(); ++b)
      weights.push_back(trial == 3 && b > 0 ? 0 : 1 + random() % 4);
    expect_the_part(p, seeds, whole, rings, groups, weights);
  }
}

template <int dim>
RandomParameters<dim> specimen(const Vector<dim> &size, double size_ratio)
{
  RandomParameters<dim> p;
  p.spacing = 1;
  p.thickness = 0.7;
  p.upper = size;
  p.size_ratio = size_ratio;
  p.relaxation_sweeps = 4;
  p.seed = 7;
  return p;
}

TEST(RandomPart, IsThatOfTheWholeInThePlane)
{
  for (const double ratio : {1., 4.}) {
    auto p = specimen<2>({30, 41}, ratio);
    p.holes = {{{9, 20}, 4}};
    p.notches = {{{22, 30}, {31, 32}}};
    p.cracks = {{{12, 8.2}, {26, 11.4}}};
    expect_the_parts(p, 12);
  }
}

TEST(RandomPart, IsThatOfTheWholeInSpace)
{
  for (const double ratio : {1., 2.}) {
    auto p = specimen<3>({9, 8, 11}, ratio);
    p.relaxation_sweeps = 2;
    p.notches = {{{-1, -1, 5}, {3, 9, 6.5}}};
    p.cracks = {{{4, -1, 2.2}, {10, -1, 2.6}, {10, 9, 2.6}, {4, 9, 2.2}}};
    expect_the_parts(p, 4);
  }
}

// Whether a cell is in it is known to whoever has cut the cell; seeds beyond its sides are kept.
TEST(RandomPart, IsThatOfTheWholeInAZoneOfTheSpecimen)
{
  auto plane = specimen<2>({70, 60}, 2);
  plane.zone_lower = {12.3, -1e300};
  plane.zone_upper = {50.1, 48.4};
  plane.cracks = {{{-1, 21.3}, {30, 25}}};
  expect_the_parts(plane, 12);
  plane.zone_parts.boxes = {{{12.3, -1e300}, {50.1, 20}}, {{20, 20}, {35, 48.4}}};
  expect_the_parts(plane, 12);
  auto space = specimen<3>({13, 9, 12}, 1);
  space.relaxation_sweeps = 1;
  space.zone_lower = {2.2, -1e300, -1e300};
  space.zone_upper = {11.1, 1e300, 9.7};
  expect_the_parts(space, 4);
}

TEST(RandomPart, RefusesWrongNumbersAndJoinedSides)
{
  auto p = specimen<2>({20, 20}, 1);
  p.relaxation_sweeps = 0;
  const Seeds<2> seeds = make_random_seeds(p);
  EXPECT_THROW(make_random_part(p, seeds, ranks(), 2, {}, {1}), core::InputError);
  EXPECT_THROW(make_random_part(p, seeds, ranks(), 1), core::InputError);
  auto none = p;
  none.zone_lower = {9.9, 9.9};
  none.zone_upper = {10.1, 10.1};
  EXPECT_THROW(make_random_part(none, seeds, ranks(), 2), core::InputError);
  p.periodic[0] = true;
  EXPECT_THROW(make_random_part(p, seeds, ranks(), 2), core::InputError);
}

// Faces are made by the first of two seeds; cells that are cut out of turn must not change that.
TEST(RandomPart, GroupsThatAreFarApartAreCutInTheOrderOfTheSeeds)
{
  auto p = specimen<2>({40, 40}, 3);
  p.relaxation_sweeps = 1;
  const RandomPacking<2> whole = make_random_packing(p);
  Groups<2> corners;
  corners.reach = 40;
  corners.of = [](const Vector<2> &x) { return (x - Vector<2>(20, 20)).norm() > 22 ? 3 : -1; };
  expect_the_part(p, make_random_seeds(p), whole, 3, corners);
}
} // namespace
} // namespace ligament::packings::testing
