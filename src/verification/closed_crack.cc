// Wing cracks at a closed crack under compression against linear elastic fracture mechanics.
#include "src/verification/closed_crack.h"

#include "src/verification/breaking_run.h"
#include "src/verification/kinked_crack.h"

#include <fmt/format.h>

#include <array>

namespace ligament::program
{
namespace
{
constexpr double toughness = 1e6, friction = 0.3, half = 10e-3, width = 60e-3, height = 160e-3;

/// examples/closed_crack, on any packing.
Scene pressed_plate(const std::string &packing, double degrees, int seed)
{
  Scene scene = unit_scene(2, {width, height, 0}, 0.25);
  scene.material.youngs_modulus = 40e9;
  scene.material.density = 2600;
  scene.material.friction = friction;
  scene.material.fracture = {"maximum_tension", {}, toughness};
  const double tip = half / std::sqrt(2.);
  scene.specimen.cracks = {{{{-tip, -tip, 0}, {tip, tip, 0}}}};
  scene.zone.packing = packing;
  scene.zone.orientation[0] = degrees * M_PI / 180;
  scene.zone.seed = seed;
  scene.zone.spacing = 0.7e-3;
  add_far_field(scene, {0, 80e-3, 0}, 2.1e-3);
  scene.coupling.fine_damper = 8;
  scene.coupling.gap_filter = 4;
  scene.coupling.step_ratio = 2;
  scene.damping.mass = 1e4;
  add_pull(scene, 1, -20e-3, 0.2e-3);
  return scene;
}

/// Load (Pa) at which the later wing breaks its third face, and the mean length of both (m).
struct Wings
{
  double load = 0, length = 0, residual = 0;
};

Wings grow_wings(const Scene &scene)
{
  BreakingRun<2> run(scene);
  const Vector<2> tip = Vector<2>::Constant(half / std::sqrt(2.));
  while (run.time() < 3e-3) {
    run.step();
    std::array<int, 2> n = {0, 0};
    Wings wings;
    for (const auto &face : run.body().force->broken_bonds()) {
      const int side = face.position.sum() > 0;
      const double end =
          (face.position - (side ? 1 : -1) * tip).norm() + face.area / run.body().thickness / 2;
      if (++n[side] == 3)
        wings.length += end / 2;
    }
    if (n[0] < 3 || n[1] < 3)
      continue;
    for (const int load : {0, 1}) {
      const auto &body = run.body();
      double force = body.far->reaction(load)[1] + body.force->reaction(load)[1];
      wings.load += std::abs(force) / width / body.thickness / 2;
    }
    wings.residual = run.unbooked() / run.work();
    return wings;
  }
  return {};
}

/// Load over that of K_Ic at the end of wings of the same length.
double over_theory(const Wings &wings)
{
  if (wings.load == 0)
    return std::nan("");
  const KinkedCrack crack = {half, wings.length, M_PI / 4, 0, friction, 0.25};
  return wings.load * largest_stress_intensity(crack) / toughness;
}

std::vector<Result> closed_crack()
{
  std::vector<Result> results;
  double worst_residual = 0;
  const auto measure = [&](const std::string &packing, double degrees, int seed) {
    const Wings wings = grow_wings(pressed_plate(packing, degrees, seed));
    keep_worst(worst_residual, wings.residual);
    return over_theory(wings);
  };
  for (const double degrees : {0, 15, 30})
    results.push_back({fmt::format("closed_crack/hexagonal_{:.0f}", degrees),
                       std::abs(measure("hexagonal", degrees, 1) - 1), 0.15, 0.07});
  results.push_back({"closed_crack/square", std::abs(measure("square", 0, 1) - 1), 0.15, 0.07});
  double mean = 0;
  for (int seed = 1; seed <= 5; ++seed)
    mean += measure("random", 0, seed) / 5;
  results.push_back({"closed_crack/random", std::abs(mean - 1), 0.15, 0.07});
  results.push_back({"closed_crack/residual_over_work", worst_residual, 1e-4, 1e-5});
  return results;
}
} // namespace

std::vector<Case> closed_crack_cases()
{
  return {{"closed_crack", "wing cracks at a closed crack: load over theory, less 1", true,
           closed_crack}};
}
} // namespace ligament::program
