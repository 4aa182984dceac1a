// Lattices that ranks pack by part are those that one process packs and cuts.
#include "packings/lattice_packing.h"
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
void expect_the_part(const LatticeParameters<dim> &lattice, const Packing<dim> &whole, int rings,
                     const Groups<dim> &groups = {}, const std::vector<std::int64_t> &weights = {})
{
  const auto partition = particles::make_partition(whole.size(), ranks().size(), weights);
  const PackingPart<dim> expected = part_of(whole, partition, ranks().rank(), rings, 0, groups),
                         found = make_lattice_part(lattice, ranks(), rings, groups, weights);
  EXPECT_EQ(found.n_whole, whole.size());
  EXPECT_EQ(found.place, expected.place);
  EXPECT_EQ(found.owner, expected.owner);
  expect_same_ranges(found.part.owned, expected.part.owned);
  expect_same_ranges(found.part.stepped, expected.part.stepped);
  expect_same_ranges(found.part.pressed, expected.part.pressed);
  expect_same_ranges(found.part.turned, expected.part.turned);
  expect_same_packing(found.packing, expected.packing);
}

/// From one window of rows to as many as there are rows in a small one.
template <int dim>
void expect_the_grouped_part(const LatticeParameters<dim> &lattice, const Packing<dim> &whole,
                             int rings, const Groups<dim> &groups)
{
  std::set<int> grouped;
  for (const auto &[group, particles] : members(whole, groups))
    if (group >= 0)
      grouped.insert(particles.begin(), particles.end());
  const Packing<dim> kept = piece_of(whole, rings_around(whole, grouped, rings)[rings]);
  expect_same_packing(grouped_part(whole, groups, rings), kept);
  for (const int n_windows : {1, 2, 3, 7})
    expect_same_packing(make_grouped_lattice(lattice, n_windows, groups, rings), kept);
}

/// With groups as high as `most` and others, and with pieces of unequal size.
template <int dim>
void expect_the_part(const LatticeParameters<dim> &lattice, double most)
{
  const Packing<dim> whole = make_lattice_packing(lattice);
  std::mt19937 random(5);
  for (int trial = 0; trial < 6; ++trial) {
    const int rings = 2 + trial % 2;
    expect_the_part(lattice, whole, rings);
    const Groups<dim> groups =
        random_cells<dim>(random, lattice.upper, trial < 3 ? most : 1.5, trial < 3 ? most : 8);
    const std::int64_t n_blocks = (whole.size() + particles::sum_block - 1) / particles::sum_block;
    std::vector<std::int64_t> weights;
    for (std::int64_t b = 0; b < n_blocks; ++b)
      weights.push_back(random() % 4);
    expect_the_part(lattice, whole, rings, groups, weights);
    expect_the_grouped_part(lattice, whole, trial % 4, groups);
  }
}

TEST(LatticePart, IsThatOfTheWholeInThePlane)
{
  for (const LatticeKind kind : {LatticeKind::hexagonal, LatticeKind::square})
    for (const double angle : {0., 0.4}) {
      LatticeParameters<2> lattice;
      lattice.kind = kind;
      lattice.spacing = 1;
      lattice.upper = {30.2, 170.7};
      lattice.orientation[0] = angle;
      lattice.cracks = {{{5, 60}, {22, 90}}};
      lattice.holes = {{{15, 130}, 6}};
      expect_the_part(lattice, 40);
    }
}

TEST(LatticePart, IsThatOfTheWholeInSpace)
{
  for (const LatticeKind kind : {LatticeKind::fcc, LatticeKind::simple_cubic})
    for (const double angle : {0., 0.4}) {
      LatticeParameters<3> lattice;
      lattice.kind = kind;
      lattice.spacing = 1;
      lattice.upper = {7.3, 8.1, 70.4};
      lattice.orientation = {angle, -angle / 2, angle};
      lattice.cracks = {{{2, -1, 20}, {2, 5, 20}, {2, 5, 40}, {2, -1, 40}}};
      expect_the_part(lattice, 40);
    }
}

// The rows lie another way than the lattice has them.
TEST(LatticePart, IsThatOfTheWholeWhereLayersAreTurned)
{
  LatticeParameters<2> lattice;
  lattice.spacing = 1;
  lattice.upper = {200.2, 20.7};
  lattice.small_layer = 0;
  expect_the_part(lattice, 60);
}

TEST(LatticePart, IsThatOfTheWholeInAZoneOfTheSpecimen)
{
  for (const double angle : {0., 0.4}) {
    LatticeParameters<2> plane;
    plane.spacing = 1;
    plane.upper = {60, 170.7};
    plane.orientation[0] = angle;
    plane.zone_lower = {12.3, -1e300};
    plane.zone_upper = {40.1, 140.4};
    plane.holes = {{{40, 60}, 6}}; // cells beside it reach across the side of the zone
    expect_the_part(plane, 40);
    plane.zone_parts.boxes = {{{12.3, -1e300}, {40.1, 70}}, {{20, 70}, {35, 140.4}}};
    expect_the_part(plane, 40);
    LatticeParameters<3> space;
    space.spacing = 1;
    space.upper = {12.3, 9.1, 70.4};
    space.orientation = {angle, -angle / 2, angle};
    space.zone_lower = {2.2, -1e300, 5};
    space.zone_upper = {9.1, 8.2, 1e300};
    expect_the_part(space, 40);
  }
}

TEST(LatticePart, NoGroupsAreAnEmptyPart)
{
  LatticeParameters<2> lattice;
  lattice.spacing = 1;
  lattice.upper = {20, 40};
  EXPECT_EQ(make_grouped_lattice(lattice, 2, {}, 2).size(), 0);
  EXPECT_EQ(grouped_part(make_lattice_packing(lattice), {}, 2).size(), 0);
}

TEST(LatticePart, RefusesWrongNumbers)
{
  LatticeParameters<2> lattice;
  lattice.spacing = 1;
  lattice.upper = {20, 40};
  EXPECT_THROW(make_lattice_part(lattice, ranks(), 2, {}, {1}), core::InputError);
  EXPECT_THROW(make_grouped_lattice(lattice, 0, {}, 2), core::InputError);
  EXPECT_THROW(make_grouped_lattice(lattice, 1, {}, -1), core::InputError);
}

TEST(LatticePart, RefusesJoinedSides)
{
  LatticeParameters<2> lattice;
  lattice.spacing = 1;
  lattice.upper = {20, 40};
  lattice.periodic[0] = true;
  EXPECT_THROW(make_lattice_part(lattice, ranks(), 2), core::InputError);
  EXPECT_THROW(make_grouped_lattice(lattice, 2, {}, 2), core::InputError);
}
} // namespace
} // namespace ligament::packings::testing
