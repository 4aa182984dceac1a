// Packing files of bodies that are no boxes.
#include "core/check.h"
#include "packings/packing_file.h"
#include "src/simulation/make_packing.h"
#include "tests/support/small_plate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>

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

// Where four cells of a grid meet, faces of round-off join two of them: a cell that loses one is as
// whole as before, and flows on.
TEST(PackingFiles, GridsWithFacesOfRoundOffBreakAndFlow)
{
  std::ofstream out("grid.csv");
  out << "x,y,r\nm,m,m\n";
  std::mt19937 random(1);
  std::uniform_real_distribution<double> scatter(-1e-10, 1e-10);
  for (int i = 0; i < 24; ++i)
    for (int k = 0; k < 24; ++k)
      out << fmt::format("{:.17g},{:.17g},0.5\n", i - 11.5 + scatter(random),
                         k - 11.5 + scatter(random));
  out.close();
  SmallBody small(small_scene(
      {"/specimen/size=[24, 24]",
       R"(/discrete_zone={"extent": "all", "packing": "file", "packing_file": "grid.csv",
                          "spacing": 1.0746})",
       "/far_field=none",
       R"(/material={"youngs_modulus": 1, "poissons_ratio": 0.3, "density": 1,
                     "plasticity": {"law": "von_mises", "yield_stress": 0.003},
                     "fracture": {"criterion": "maximum_tension", "strength": 0.002}})"}));
  auto bodies = small.body.bodies();
  for (int step = 1; step <= 4; ++step) {
    small.deform(Eigen::Vector2d(0, 2e-3 * step).asDiagonal());
    small.body.coupler->compute_forces(bodies, {step, step * small.body.dt, small.body.dt});
  }
  EXPECT_GT(small.body.force()->n_broken(), 24);
  for (const double f : small.body.zone->state.force[1])
    EXPECT_TRUE(std::isfinite(f));
}
} // namespace
