// Drawn scenes follow from their seed alone, are scenes that the program takes, and cover all
// kinds.
#include "core/counter_random.h"
#include "core/extremes.h"
#include "packings/lattice_packing.h"
#include "src/scene/read_scene.h"
#include "src/verification/cases/random_scenes_draw.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

using namespace ligament;
using namespace ligament::program;

namespace
{
constexpr int n_scenes = 300;

// The first number of SplitMix64 from the state 0, the hash of "a" as its authors list it.
TEST(CounterRandom, IsTheSameEverywhere)
{
  EXPECT_EQ(core::mix(0x9e3779b97f4a7c15ull), 0xe220a8397b1dcdafull);
  EXPECT_EQ(std::uint64_t(core::stream_name("a")), 0xaf63dc4c8601ec8cull);
  double sum = 0;
  for (int k = 0; k < 1000; ++k)
    sum += core::random_number(5, core::stream_name("mean"), k);
  EXPECT_NEAR(sum / 1000, 0.5, 4 * std::sqrt(1. / 12000));
}

TEST(RandomScenes, FollowFromTheSeedAlone)
{
  const auto first = draw_scene(17).json;
  EXPECT_NE(draw_scene(18).json, first);
  EXPECT_EQ(draw_scene(17).json, first);
}

TEST(RandomScenes, AreAcceptedWithTheirMirrorImages)
{
  for (int seed = 1; seed <= n_scenes; ++seed) {
    const RandomScene scene = draw_scene(seed);
    for (const auto &json : {scene.json, all_discrete(scene.json), mirrored(scene.json)}) {
      const auto input = parse_scene(json.dump(), "scene");
      for (const auto &error : input.errors)
        ADD_FAILURE() << seed << ": " << core::to_string(error);
    }
  }
}

TEST(RandomScenes, KeepWithinTheirBounds)
{
  for (int seed = 1; seed <= n_scenes; ++seed) {
    SCOPED_TRACE(seed);
    const RandomScene drawn = draw_scene(seed);
    const auto scene = *parse_scene(drawn.json.dump(), "scene").scene;
    double particles = scene.dimension == 2 ? 1 / 0.87 : 1.42;
    for (int c = 0; c < scene.dimension; ++c)
      particles *= scene.specimen.size[c] / scene.zone.spacing;
    EXPECT_GT(particles, 500);
    EXPECT_LT(particles, 7000);
    const double ratio = scene.far_field->cell_size / scene.zone.spacing;
    EXPECT_GE(ratio, 2.29);
    EXPECT_LE(ratio, 5.01);
    EXPECT_GE(ratio * scene.coupling.overlap_cells, 6.99);
    EXPECT_EQ(drawn.must_hold, drawn.load == "compression" && scene.specimen.cracks.empty());
    EXPECT_GT(scene.material.fracture.strength.value_or(1), 0);
    EXPECT_EQ(drawn.toughness.has_value(), scene.material.fracture.toughness.has_value());
  }
}

TEST(RandomScenes, CoverAllKinds)
{
  std::map<std::string, int> n;
  for (int seed = 1; seed <= n_scenes; ++seed) {
    const RandomScene s = draw_scene(seed);
    for (const auto &word : {s.packing, s.zone, s.crack, s.load, s.control, s.damping})
      ++n[word];
    ++n[s.dimension == 3 ? "3D" : s.json["plane"].get<std::string>()];
    n["turned"] += s.json["discrete_zone"].contains("orientation");
    n["sizes"] += s.json["discrete_zone"].contains("size_ratio");
    n["formula"] += s.toughness.has_value();
    n["steps"] += s.json["coupling"]["step_ratio"] > 1;
    n["grows"] += s.json["far_field"].contains("levels");
    const double nu = s.json["material"]["poissons_ratio"];
    ++n[nu < 0 ? "nu < 0" : nu == 0 ? "nu 0" : nu > 0.42 ? "nu high" : "nu"];
  }
  for (const char *word :
       {"square",   "hexagonal", "random",      "fcc",   "simple_cubic", "band",
        "box",      "l_shape",   "centre",      "edge",  "hole",         "none",
        "tension",  "shear",     "compression", "mixed", "velocity",     "displacement",
        "traction", "mass",      "local",       "3D",    "strain",       "stress",
        "turned",   "sizes",     "formula",     "steps", "grows",        "nu < 0",
        "nu 0",     "nu high",   "nu"})
    EXPECT_GE(n[word], 4) << word;
}

nlohmann::ordered_json lattice(const char *packing, nlohmann::ordered_json orientation)
{
  return {{"dimension", orientation.is_array() ? 3 : 2},
          {"specimen", {{"size", {10, 12}}}},
          {"discrete_zone", {{"packing", packing}, {"orientation", orientation}}},
          {"loads", nlohmann::ordered_json::array()}};
}

template <int dim>
Components<dim> centres(const nlohmann::ordered_json &scene)
{
  packings::LatticeParameters<dim> p;
  p.spacing = 1;
  p.upper = Vector<dim>::Constant(5);
  p.upper[1] = 6;
  p.lower = -p.upper;
  const auto &zone = scene["discrete_zone"];
  p.kind = packings::lattice_kind(zone["packing"]);
  for (int c = 0; c < n_spins<dim>; ++c)
    p.orientation[c] = zone["orientation"].is_array() ? zone["orientation"][c].get<double>()
                                                      : zone["orientation"].get<double>();
  return packings::make_lattice_packing<dim>(p).centre;
}

/// Largest distance of an image of a centre from the centres of the mirrored scene.
template <int dim>
double largest_distance(const nlohmann::ordered_json &scene)
{
  const auto a = centres<dim>(scene), b = centres<dim>(mirrored(scene));
  double worst = a[0].size() == b[0].size() ? 0 : 1e9;
  for (std::size_t i = 0; i < a[0].size(); ++i) {
    double least = 1e9;
    for (std::size_t j = 0; j < b[0].size(); ++j) {
      double square = 0;
      for (int c = 0; c < dim; ++c)
        square += std::pow((c == 0 ? -1 : 1) * a[c][i] - b[c][j], 2);
      keep_smallest(least, std::sqrt(square));
    }
    keep_largest(worst, least);
  }
  return worst;
}

TEST(RandomScenes, MirrorsOfLatticesAreLattices)
{
  for (const char *packing : {"square", "hexagonal"})
    for (const double angle : {0., 0.2, -1.1})
      EXPECT_LT(largest_distance<2>(lattice(packing, angle)), 1e-13) << packing << angle;
  for (const char *packing : {"simple_cubic", "fcc"})
    for (const double angle : {0., 0.3})
      EXPECT_LT(largest_distance<3>(lattice(packing, {angle, -0.4 * angle, 0.7 * angle})), 1e-13)
          << packing << angle;
}

TEST(RandomScenes, MirrorsTurnCracksZonesAndLoads)
{
  for (int seed = 1; seed <= 50; ++seed) {
    auto scene = draw_scene(seed).json, back = mirrored(mirrored(scene));
    EXPECT_NE(mirrored(scene).dump(), scene.dump());
    scene["discrete_zone"].erase("orientation"); // a lattice has several
    back["discrete_zone"].erase("orientation");
    EXPECT_EQ(back, scene) << seed;
  }
}
} // namespace
