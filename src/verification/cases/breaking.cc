// Cracks off the rows and through random packings, with friction and rattling flanks: is every
// joule booked?
#include "src/verification/cases/breaking.h"

#include "src/verification/instruments/breaking_run.h"

#include <fmt/format.h>

#include <random>

namespace ligament::program
{
namespace
{
/// A plate of 20 x 40 spacings with a central crack, all that does not matter drawn at random.
Scene plate(std::mt19937 &random, int number)
{
  std::uniform_real_distribution<double> unit(0, 1);
  Scene scene = unit_scene(2, {20, 40, 0}, 0.1 + 0.3 * unit(random));
  const double angle = M_PI / 4 * unit(random), a = 5;
  const Point tip = {a * std::cos(angle), a * std::sin(angle), 0};
  scene.specimen.cracks = {{{{-tip[0], -tip[1], 0}, tip}}};
  scene.material.friction = number % 3 == 0 ? 0.3 : 0;
  scene.material.fracture.criterion = Criterion::maximum_tension;
  scene.material.fracture.strength = 1e-3;
  constexpr PackingKind packings[] = {PackingKind::hexagonal, PackingKind::random,
                                      PackingKind::hexagonal, PackingKind::square,
                                      PackingKind::random};
  scene.zone.packing = packings[number % 5];
  scene.zone.orientation[0] = scene.zone.is_irregular() ? 0 : M_PI / 3 * unit(random);
  scene.zone.seed = number + 1;
  scene.zone.size_ratio = scene.zone.is_irregular() ? 1 + 2 * unit(random) : 1;
  add_pull(scene, 1, 2e-5, 40);
  return scene;
}

/// Largest residual of all steps over the work.
double worst_residual(const Scene &scene, double duration, long &n_broken)
{
  BreakingRun<2> run(scene);
  double worst = 0;
  while (run.time() < duration) {
    run.step();
    keep_largest(worst, run.unbooked());
  }
  n_broken += long(run.body().force()->broken_bonds().size());
  return worst / run.work();
}

std::vector<Result> energy_residual(int n, bool coupled)
{
  std::mt19937 random(7);
  double worst = 0;
  long n_broken = 0;
  for (int k = 0; k < n; ++k) {
    Scene scene = plate(random, k);
    if (coupled) {
      scene.specimen.size[1] = 120;
      add_far_field(scene, {0, 50, 0}, 5); // whose far step is at least three zone steps
      scene.coupling.fine_damper = 8;
      scene.coupling.gap_filter = 4;
      scene.coupling.step_ratio = 1 + k % 3;
    }
    keep_largest(worst, worst_residual(scene, coupled ? 2400 : 900, n_broken));
  }
  const std::string name = coupled ? "energy_residual_coupled" : "energy_residual";
  return {{name + "/residual_over_work", worst, 1e-4, 1e-5},
          {name + "/broken_faces", double(n_broken), 10. * n, {}, Result::Bound::at_least}};
}
} // namespace

std::vector<Case> breaking_cases()
{
  return {{"energy_residual", "energy balance of plates that break off the rows, every step", false,
           [] { return energy_residual(5, false); }},
          {"energy_residual_coupled", "the same with a far field and its dampers", true,
           [] { return energy_residual(9, true); }}};
}
} // namespace ligament::program
