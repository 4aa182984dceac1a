// Snapshots and the table of broken faces: exact round trips, damage is refused.
#include "src/output/snapshot.h"

#include "core/check.h"
#include "core/files.h"
#include "src/analysis/field_error.h"
#include "src/output/broken_bonds.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace ligament;
using namespace ligament::program;

namespace
{
/// A cube of particles with displacements of their own.
Snapshot cube(int n, double spacing, std::int64_t first_id, double factor)
{
  Snapshot s;
  s.dimension = 3;
  s.time = 1e-5;
  s.spacing = spacing;
  for (int i = 0; i < n * n * n; ++i) {
    const double x = i % n * spacing, y = i / n % n * spacing, z = i / (n * n) * spacing;
    s.global_id.push_back(first_id + i);
    s.reference.insert(s.reference.end(), {x, y, z});
    s.displacement.insert(s.displacement.end(), {factor * y, factor * z, factor * (x - y)});
    s.velocity.insert(s.velocity.end(), {factor, 0, -factor / 3});
  }
  return s;
}

TEST(Snapshot, ComesBackToTheLastBit)
{
  const Snapshot s = cube(3, 0.1, 5, 1. / 7);
  write_snapshot("snapshot.bin", s);
  const Snapshot back = read_snapshot("snapshot.bin");
  EXPECT_EQ(back.dimension, s.dimension);
  EXPECT_EQ(back.time, s.time);
  EXPECT_EQ(back.spacing, s.spacing);
  EXPECT_EQ(back.global_id, s.global_id);
  EXPECT_EQ(back.reference, s.reference);
  EXPECT_EQ(back.displacement, s.displacement);
  EXPECT_EQ(back.velocity, s.velocity);
}

TEST(Snapshot, DamageIsRefused)
{
  write_snapshot("good.bin", cube(2, 1, 0, 1));
  const std::string good = core::read_file("good.bin");
  for (std::size_t byte = 0; byte < good.size(); byte += 29) {
    std::string bad = good;
    bad[byte] = char(bad[byte] ^ 4);
    core::write_file("bad.bin", bad);
    EXPECT_THROW(read_snapshot("bad.bin"), core::InputError) << byte;
  }
  for (const std::size_t size : {std::size_t(0), std::size_t(20), good.size() - 1}) {
    core::write_file("bad.bin", good.substr(0, size));
    EXPECT_THROW(read_snapshot("bad.bin"), core::InputError) << size;
  }
  EXPECT_THROW(read_snapshot("missing.bin"), core::InputError);
  EXPECT_THROW(write_snapshot("/dev/full", cube(2, 1, 0, 1)), core::EnvironmentError);
}

// Part of the reference, with other numbers and every value 10 % larger.
TEST(FieldError, MatchesParticlesByTheirPlace)
{
  const Snapshot reference = cube(4, 0.01, 0, 1), run = cube(3, 0.01, 1000, 1.1);
  const FieldError error = field_error(run, reference);
  EXPECT_EQ(error.matched, 27);
  EXPECT_NEAR(*error.displacement, 0.1, 1e-12);
  EXPECT_NEAR(*error.displacement_max, 0.1, 1e-12);
  EXPECT_NEAR(*error.velocity, 0.1, 1e-12);

  Snapshot shifted = run;
  for (double &x : shifted.reference)
    x += 0.1 * run.spacing;
  EXPECT_EQ(field_error(shifted, reference).matched, 0);
  EXPECT_FALSE(field_error(shifted, reference).displacement);
}

TEST(BrokenBonds, ComeBack)
{
  const std::vector<BrokenBond> bonds = {{1, 2, 1e-5, {0.1, 1. / 3, 0}, {0.6, 0.8, 0}, 1e-3, 2e-7},
                                         {7, 123456789, 2e-5, {1, 2, 3}, {0, 0, 1}, 2e-3, 0}};
  write_broken_bonds("broken_bonds.csv", bonds, 3);
  const auto back = read_broken_bonds("broken_bonds.csv");
  ASSERT_EQ(back.size(), bonds.size());
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    EXPECT_EQ(back[b].i, bonds[b].i);
    EXPECT_EQ(back[b].j, bonds[b].j);
    EXPECT_EQ(back[b].time, bonds[b].time);
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(back[b].centroid[c], bonds[b].centroid[c]);
      EXPECT_EQ(back[b].normal[c], bonds[b].normal[c]);
    }
    EXPECT_EQ(back[b].size, bonds[b].size);
    EXPECT_EQ(back[b].energy, bonds[b].energy);
  }
  write_broken_bonds("none.csv", {}, 2);
  EXPECT_TRUE(read_broken_bonds("none.csv").empty());
}
} // namespace
