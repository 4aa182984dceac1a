// Parts of a coupled scene's discrete zone, and the particles of its overlap, as ranks make them.
#include "src/simulation/make_packing.h"
#include "tests/support/ranks.h"
#include "tests/support/small_plate.h"
#include "tests/unit/ranks/packing_oracle.h"

#include "packings/packing_file.h"
#include "particles/block_sum.h"

namespace ligament::program
{
namespace
{
using test::ranks;

/// Cells of a mesh all over the zone, whose sides are at y = -20 and 20, but for a strip of it;
/// cuts between ranks run through them.
packings::Groups<2> overlap_cells()
{
  packings::Groups<2> groups;
  groups.reach = 4.1;
  groups.of = [](const Vector<2> &x) {
    if (x[1] > 3 && x[1] < 12)
      return -1;
    return int(std::floor(x[0] / 4.1)) + 100 * int(std::floor(x[1] / 4.1)) + 10000;
  };
  return groups;
}

void expect_the_parts(const std::vector<std::string> &overrides)
{
  const Scene scene = tests::small_scene(overrides);
  core::Log log;
  Reference reference;
  const auto whole = make_packing<2>(scene, reference, log).packing;
  const auto groups = overlap_cells();
  std::vector<std::int64_t> weights;
  for (int b = 0; b * particles::sum_block < whole.size(); ++b)
    weights.push_back(1 + b % 5);
  const auto partition = particles::make_partition(whole.size(), ranks().size(), weights);
  const auto held = packings::part_of(whole, partition, ranks().rank(), 3, 0, groups);
  Reference found; // by all ranks together
  const auto zone = make_packing_part<2>(scene, found, ranks(), 3, log, groups, weights);
  const auto &part = zone.held;
  EXPECT_EQ(part.place, held.place);
  EXPECT_EQ(particles::count(part.part.stepped), particles::count(held.part.stepped));
  EXPECT_EQ(ranks().any(particles::count(part.part.stepped) > particles::count(part.part.owned)),
            !ranks().is_one());
  packings::testing::expect_same_packing(part.packing, held.packing);

  EXPECT_EQ(zone.overlap.has_value(), scene.zone.is_irregular());
  const auto overlap = zone.overlap
                           ? *zone.overlap
                           : packings::make_grouped_lattice<2>(lattice_of<2>(scene), 2, groups, 3);
  EXPECT_GT(overlap.size(), 300);
  EXPECT_LT(overlap.size(), whole.size());
  packings::testing::expect_same_packing(overlap, packings::grouped_part(whole, groups, 3));
  EXPECT_TRUE(found.tables() == reference.tables());
}

TEST(ZoneParts, AreThoseOfTheWholeZone)
{
  for (const char *packing : {"hexagonal", "square", "random"})
    expect_the_parts({"/discrete_zone/packing=" + std::string(packing)});
  expect_the_parts({"/discrete_zone/orientation=20"});
}

// Packed whole by every rank.
TEST(ZoneParts, AreThoseOfAPackingFile)
{
  const Scene scene = tests::small_scene({"/discrete_zone/packing=random"});
  core::Log log;
  Reference reference;
  const std::string file = "packing_" + std::to_string(ranks().rank()) + ".csv";
  packings::write_packing_file(file, *make_packing<2>(scene, reference, log).seeds);
  expect_the_parts({"/discrete_zone/packing=file", "/discrete_zone/packing_file=" + file});
}
} // namespace
} // namespace ligament::program
