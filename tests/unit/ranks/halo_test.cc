// Cuts of a body, the parts that ranks hold of it, and the ghosts that they see.
#include "packings/lattice_packing.h"
#include "packings/packing_part.h"
#include "packings/random_packing.h"
#include "particles/block_sum.h"
#include "particles/halo.h"
#include "tests/support/ranks.h"
#include "tests/unit/ranks/packing_oracle.h"

#include "core/check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

namespace ligament::particles::testing
{
namespace
{
using packings::Packing, packings::PackingPart;
using test::ranks;

TEST(Partition, CutsWholeBlocksNearEqualShares)
{
  std::mt19937 random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const std::int64_t n = random() % 5000, n_blocks = (n + sum_block - 1) / sum_block;
    const int n_ranks = 1 + int(random() % 9);
    std::vector<std::int64_t> weights;
    for (int b = 0; b < n_blocks; ++b)
      weights.push_back(random() % 4); // some are 0
    const Partition p = make_partition(n, n_ranks, weights);
    ASSERT_EQ(p.n_ranks(), n_ranks);
    EXPECT_EQ(p.begin(0), 0);
    EXPECT_EQ(p.end(n_ranks - 1), n);
    const std::int64_t total = std::accumulate(weights.begin(), weights.end(), std::int64_t(0)),
                       largest =
                           weights.empty() ? 0 : *std::max_element(weights.begin(), weights.end());
    for (int r = 0; r < n_ranks; ++r) {
      EXPECT_LE(p.begin(r), p.end(r));
      EXPECT_TRUE(p.end(r) % sum_block == 0 || p.end(r) == n);
      std::int64_t sum = 0; // up to the end of this piece: within half a block of its share
      for (std::int64_t b = 0; b < n_blocks && b * sum_block < p.end(r); ++b)
        sum += weights[b];
      EXPECT_LE(2 * std::abs(sum * n_ranks - total * (r + 1)), largest * n_ranks);
      if (p.begin(r) < p.end(r)) {
        EXPECT_EQ(p.owner(p.begin(r)), r);
        EXPECT_EQ(p.owner(p.end(r) - 1), r);
      }
    }
  }
}

TEST(Partition, RefusesWrongWeights)
{
  EXPECT_THROW(make_partition(1000, 2, {1, 2}), core::InputError);
  EXPECT_THROW(make_partition(100, 2, {1, -1}), core::InputError);
  EXPECT_THROW(make_partition(100, 0), core::InputError);
}

template <int dim>
Packing<dim> turned_box(double n)
{
  packings::LatticeParameters<dim> lattice;
  lattice.spacing = 1;
  for (int c = 0; c < dim; ++c) {
    lattice.upper[c] = n + 0.3 * c;
    lattice.orientation[dim == 2 ? 0 : c] = 0.3;
  }
  if constexpr (dim == 2)
    lattice.cracks = {{{0.2 * n, 0.45 * n}, {0.7 * n, 0.55 * n}}};
  return packings::make_lattice_packing(lattice);
}

/// Every rank makes every part, so that nothing is left to one.
template <int dim>
void expect_rings(const Packing<dim> &whole, int n_ranks, int rings,
                  const packings::Groups<dim> &groups = {})
{
  const Partition partition = make_partition(whole.size(), n_ranks);
  int n_owned = 0;
  for (int r = 0; r < n_ranks; ++r) {
    std::set<int> owned, stepped;
    for (std::int64_t i = partition.begin(r); i < partition.end(r); ++i)
      owned.insert(int(i));
    stepped = owned;
    for (const auto &[group, particles] : packings::testing::members(whole, groups))
      if (group >= 0 && std::any_of(particles.begin(), particles.end(),
                                    [&](int i) { return owned.count(i) > 0; }))
        stepped.insert(particles.begin(), particles.end());
    const auto within = packings::testing::rings_around(whole, stepped, rings);

    const PackingPart<dim> held = packings::part_of(whole, partition, r, rings, 0, groups);
    EXPECT_EQ(held.n_whole, whole.size());
    EXPECT_EQ(std::set<int>(held.place.begin(), held.place.end()), within[rings]);
    EXPECT_TRUE(std::is_sorted(held.place.begin(), held.place.end()));
    const auto set_of = [&](const ParticleRanges &ranges) {
      std::set<int> places;
      for_each(ranges, [&](int k) { places.insert(held.place[k]); });
      return places;
    };
    EXPECT_EQ(set_of(held.part.owned), owned);
    EXPECT_EQ(set_of(held.part.stepped), stepped);
    EXPECT_EQ(set_of(held.part.pressed), within[rings - 1]);
    EXPECT_EQ(set_of(held.part.turned), within[rings]);
    n_owned += count(held.part.owned);
    for (std::size_t k = 0; k < held.place.size(); ++k)
      EXPECT_EQ(held.owner[k], partition.owner(held.place[k]));
    packings::testing::expect_same_packing(held.packing,
                                           packings::testing::piece_of(whole, within[rings]));
  }
  EXPECT_EQ(n_owned, whole.size());
}

template <int dim>
Packing<dim> random_box(double n)
{
  packings::RandomParameters<dim> random;
  random.spacing = 1;
  random.size_ratio = 2;
  random.upper.setConstant(n);
  return packings::make_random_packing(random).packing;
}

TEST(PackingPart, RingsAreTheNeighboursOfNeighbours)
{
  for (const int rings : {2, 3}) {
    expect_rings(turned_box<2>(20), 3, rings);
    expect_rings(turned_box<3>(7), 3, rings);
    expect_rings(random_box<2>(18), 4, rings);
  }
  expect_rings(turned_box<2>(20), 1, 2); // one rank: everything, nobody around
  expect_rings(turned_box<2>(3), 4, 2);  // more ranks than blocks: some own nothing
}

TEST(PackingPart, WholeGroupsAreSteppedWithRingsAroundThem)
{
  std::mt19937 random(11);
  const Packing<2> plane = turned_box<2>(30), irregular_plane = random_box<2>(26);
  const Packing<3> space = turned_box<3>(9), irregular_space = random_box<3>(8);
  for (int trial = 0; trial < 8; ++trial) {
    const auto cells = [&](auto upper) {
      return packings::testing::random_cells<decltype(upper)::RowsAtCompileTime>(random, upper, 1.5,
                                                                                 12);
    };
    const int rings = 2 + trial % 2, n_ranks = 1 + trial % 4;
    expect_rings<2>(plane, n_ranks, rings, cells(Vector<2>(30, 30)));
    expect_rings<2>(irregular_plane, n_ranks, rings, cells(Vector<2>(26, 26)));
    expect_rings<3>(space, n_ranks, rings, cells(Vector<3>(9, 9, 9)));
    expect_rings<3>(irregular_space, n_ranks, rings, cells(Vector<3>(8, 8, 8)));
  }
}

TEST(PackingPart, RefusesAnotherPartition)
{
  EXPECT_THROW(packings::part_of(turned_box<2>(6), make_partition(7, 1), 0, 2), core::InputError);
  const auto box = turned_box<2>(6);
  EXPECT_THROW(packings::part_of(box, make_partition(box.size(), 1), 0, 1), core::InputError);
}

/// A number that says whose it is, in which array.
double value_of(std::int64_t id, int array)
{
  return double(id) + array / 64.;
}

template <int dim>
void expect_ghosts_as_their_owners_have_them(const Packing<dim> &whole, bool turns)
{
  const Partition partition = make_partition(whole.size(), ranks().size());
  const PackingPart<dim> held = packings::part_of(whole, partition, ranks().rank(), 2);
  Particles<dim> p;
  packings::fill_particles(held.packing, 1., p);
  p.part = held.part;
  if (!turns)
    p.drop_orientations();
  const Owners owners{ranks(), held.owner};
  Halo<dim> halo(owners, p);
  const auto for_each_sent = [&](const auto &visit) {
    int array = 0;
    for (auto &component : p.displacement)
      visit(array++, component);
    for (auto &component : p.rotation)
      visit(array++, component);
  };
  for_each_sent([&](int array, std::vector<double> &values) {
    for (int i = 0; i < p.size() && !values.empty(); ++i)
      values[i] = owners.is_own(i) ? value_of(p.global_id[i], array) : -1;
  });
  for (auto &component : p.velocity)
    std::fill(component.begin(), component.end(), 3.);
  halo.update(p);
  for_each_sent([&](int array, const std::vector<double> &values) {
    for (int i = 0; i < p.size() && !values.empty(); ++i)
      EXPECT_EQ(values[i], value_of(p.global_id[i], array));
  });
  for (const auto &component : p.velocity)
    EXPECT_EQ(component, std::vector<double>(p.size(), 3.));
  EXPECT_EQ(halo.n_ghosts(), p.size() - count(p.part.owned));
  EXPECT_EQ(halo.n_ghosts() > 0, ranks().size() > 1);
  const std::size_t n_numbers = dim + (turns ? p.rotation.size() : 0);
  EXPECT_EQ(ranks().sum(std::int64_t(halo.bytes(p))),
            ranks().sum(std::int64_t(halo.n_ghosts() * n_numbers * sizeof(double))));
}

TEST(Halo, GhostsMoveAsTheirOwnersSay)
{
  expect_ghosts_as_their_owners_have_them(turned_box<2>(25), true);
  expect_ghosts_as_their_owners_have_them(turned_box<2>(25), false);
  expect_ghosts_as_their_owners_have_them(turned_box<3>(8), true);
}

TEST(Halo, RefusesNamesThatNobodyHas)
{
  if (ranks().is_one())
    return;
  const auto whole = turned_box<2>(25);
  const Partition partition = make_partition(whole.size(), ranks().size());
  const auto held = packings::part_of(whole, partition, ranks().rank(), 2);
  Particles<2> p;
  packings::fill_particles(held.packing, 1., p);
  if (ranks().rank() == ranks().size() - 1) {
    auto ids = p.global_id.list();
    for (auto &id : ids)
      id += std::int64_t(1) << 40;
    p.global_id = GlobalIds(ids);
  }
  EXPECT_THROW(Halo<2>(Owners{ranks(), held.owner}, p), core::InputError);
}
} // namespace
} // namespace ligament::particles::testing
