// Packing files of bodies that are no boxes.
#include "core/check.h"
#include "packings/packing_file.h"
#include "src/simulation/make_packing.h"
#include "tests/support/small_plate.h"

#include <algorithm>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
/// The small plate with grips twice as wide as what lies between them.
std::vector<std::string> waisted()
{
  return {R"(/specimen={"outline": [{"at": [-24, -60]}, {"at": [24, -60]}, {"at": [24, -40]},
             {"at": [12, -30]}, {"at": [12, 30]}, {"at": [24, 40]}, {"at": [24, 60]},
             {"at": [-24, 60]}, {"at": [-24, 40]}, {"at": [-12, 30]}, {"at": [-12, -30]},
             {"at": [-24, -40]}]})",
          "/discrete_zone/packing=random"};
}

packings::Packing<2> packed(const std::vector<std::string> &overrides,
                            packings::Seeds<2> *seeds = nullptr)
{
  const Scene scene = small_scene(overrides);
  core::Log log;
  Reference reference;
  auto made = make_packing<2>(scene, reference, log);
  if (seeds)
    *seeds = *made.seeds;
  return std::move(made.packing);
}

// The zone's own box is wider than the body in it.
TEST(PackingFiles, ThatOfARunIsTaken)
{
  packings::Seeds<2> seeds;
  const auto first = packed(waisted(), &seeds);
  packings::write_packing_file<2>("waist.csv", seeds);
  const std::vector<std::string> from_file = {"/discrete_zone/packing=file",
                                              "/discrete_zone/packing_file=waist.csv"};
  const auto again = packed(waisted() + from_file);
  EXPECT_EQ(again.volume, first.volume);
  EXPECT_EQ(again.faces.size(), first.faces.size());
  // For twice the zone there are too few.
  EXPECT_THROW(packed(waisted() + from_file +
                      std::vector<std::string>{
                          R"(/discrete_zone/region={"lower": [null, -28], "upper": [null, 28]})"}),
               core::InputError);
}
} // namespace
