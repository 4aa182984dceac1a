// Wing cracks at a closed crack under compression against linear elastic fracture mechanics.
#include "src/verification/cases/closed_crack.h"

#include "src/verification/bodies/kinked_crack.h"
#include "src/verification/instruments/breaking_run.h"

#include <fmt/format.h>

#include <array>

namespace ligament::program
{
namespace
{
constexpr double toughness = 1e6, friction = 0.3, half = 10e-3, width = 60e-3, height = 160e-3;

struct Plate
{
  std::string packing;
  double degrees = 0; // lattices
  int seed = 1;
  bool coupled = false;
  double local_damping = 0; // 0: mass damping as in examples/closed_crack
};

/// examples/closed_crack, on any packing.
Scene pressed_plate(const Plate &plate)
{
  Scene scene = unit_scene(2, {width, height, 0}, 0.25);
  scene.material.youngs_modulus = 40e9;
  scene.material.density = 2600;
  scene.material.friction = friction;
  scene.material.fracture.criterion = Criterion::maximum_tension;
  scene.material.fracture.toughness = toughness;
  const double tip = half / std::sqrt(2.);
  scene.specimen.cracks = {{{{-tip, -tip, 0}, {tip, tip, 0}}}};
  scene.zone.packing = named<PackingKind>(plate.packing);
  scene.zone.orientation[0] = plate.degrees * M_PI / 180;
  scene.zone.seed = plate.seed;
  scene.zone.spacing = 0.7e-3;
  if (plate.coupled) {
    add_far_field(scene, {0, 80e-3, 0}, 2.1e-3);
    scene.coupling.fine_damper = 8;
    scene.coupling.gap_filter = 4;
    scene.coupling.step_ratio = 2;
  }
  scene.damping.mass = plate.local_damping == 0 ? 1e4 : 0;
  scene.damping.local = plate.local_damping;
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
    for (const auto &face : run.body().force()->broken_bonds()) {
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
      const double force =
          body.force()->reaction(load)[1] + (body.far ? body.far->reaction(load)[1] : 0);
      wings.load += std::abs(force) / width / body.thickness / 2;
    }
    wings.residual = run.unbooked() / run.work();
    return wings;
  }
  return {};
}

/// Load over that of K_Ic at the end of wings of the same length in a plate of the same size.
double over_theory(const Wings &wings)
{
  if (wings.load == 0)
    return std::nan("");
  const KinkedCrack crack = {half, wings.length, M_PI / 4, 0, friction, 0.25, {width, height}};
  return wings.load * largest_stress_intensity(crack) / toughness;
}

class WingTable
{
public:
  /// Mean over the seeds, of a lattice one.
  void add(const std::string &name, Plate plate, int n_seeds = 1)
  {
    double sum = 0;
    for (; plate.seed <= n_seeds; ++plate.seed) {
      const Wings wings = grow_wings(pressed_plate(plate));
      keep_largest(worst_residual_, wings.residual);
      sum += over_theory(wings);
    }
    const double mean = sum / n_seeds;
    results_.push_back({"closed_crack/" + name, std::abs(mean - 1), 0.15, 0.07});
    results_.push_back({"closed_crack/" + name + "_ratio", mean, infinity, {}}); // on which side
  }

  std::vector<Result> results() const
  {
    auto results = results_;
    results.push_back({"closed_crack/residual_over_work", worst_residual_, 1e-4, 1e-5});
    return results;
  }

private:
  std::vector<Result> results_;
  double worst_residual_ = 0;
};

std::vector<Result> closed_crack()
{
  WingTable table;
  for (const double degrees : {0, 15, 30})
    table.add(fmt::format("hexagonal_{:.0f}", degrees), {"hexagonal", degrees});
  table.add("square", {"square"});
  table.add("random", {"random"}, 5);
  table.add("coupled_hexagonal_0", {"hexagonal", 0, 1, true});
  table.add("coupled_random", {"random", 0, 1, true});
  // The waves of a face that breaks die at once: the wings grow face by face, as in theory.
  table.add("slow_hexagonal_0", {"hexagonal", 0, 1, false, 0.7});
  return table.results();
}
} // namespace

std::vector<Case> closed_crack_cases()
{
  return {{"closed_crack", "wing cracks at a closed crack: load over theory, less 1", true,
           closed_crack}};
}
} // namespace ligament::program
