// Grains a thousand times stiffer than what is around them: energy, eigenvalues, decay.
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases.h"
#include "src/verification/instruments/linear_motion.h"
#include "src/verification/instruments/noise_run.h"

#include <algorithm>

namespace ligament::program
{
namespace
{
/// A band with stiff grains in its middle, one of them as thin as a particle, one on a free side.
Scene band(int dim, const std::string &packing)
{
  Scene scene = dim == 2 ? unit_scene(2, {18, 132, 0}, 0.3) : unit_scene(3, {6.3, 6.7, 84}, 0.3);
  scene.zone.packing = named<PackingKind>(packing);
  scene.coupling.transition_cells = 4;
  add_far_field(scene, dim == 2 ? Point{0, 60, 0} : Point{0, 0, 42}, dim == 2 ? 4.1 : 3.1);
  Inclusion stiff;
  stiff.material = scene.material;
  stiff.material.youngs_modulus = 1000;
  stiff.material.poissons_ratio = 0.2;
  if (dim == 2) {
    stiff.balls = {{{-4, 2, 0}, 3.2}, {{4, -4, 0}, 1.1}, {{9, 4, 0}, 2.6}};
    stiff.boxes = {{{-6, -7, 0}, {-2, -5.9, 0}}};
  } else
    stiff.balls = {{{-1, 0.5, 1}, 1.9}, {{3, -2, -2}, 1.6}};
  Inclusion hard = stiff; // of another Poisson's ratio, touching the first
  hard.material.poissons_ratio = 0.45;
  hard.boxes.clear();
  hard.balls = {{dim == 2 ? Point{-0.5, 5, 0} : Point{-2, 2, 2}, 1.4}};
  scene.inclusions = {stiff, hard};
  return scene;
}

/// Two materials alone: every particle of a random packing is a grain.
Scene mosaic()
{
  Scene scene = unit_scene(2, {24, 24, 0}, 0.3);
  scene.zone.packing = PackingKind::random;
  Inclusion stiff;
  stiff.material = scene.material;
  stiff.material.youngs_modulus = 1000;
  for (int k = 0; k < 100; ++k) // a lattice of points that nothing else has
    stiff.balls.push_back({{-12 + 2.39 * (k % 10), -12 + 2.39 * (k / 10), 0}, 0.75});
  scene.inclusions = {stiff};
  return scene;
}

constexpr double strain = 1e-8;

template <int dim>
void judge(const std::string &name, const Scene &scene, std::vector<Result> &results)
{
  UnitBody<dim> unit(scene);
  {
    LinearMotion<dim> motion(unit.body);
    const auto [least, largest] = motion.squared_frequencies();
    results.push_back({name + "/margin",
                       2 / std::sqrt(largest) / unit.body.dt_zone,
                       1,
                       {},
                       Result::Bound::at_least});
    results.push_back({name + "/least", least / largest, -1e-12, {}, Result::Bound::at_least});
    motion.rest();
  }
  const int terms = 10, interval = terms + 2; // of (E7)
  const auto energy = run_noise(unit.body, strain, 20000, interval, terms).shadow;
  const Course course = course_of(energy, interval);
  results.push_back({name + "/drift", std::abs(course.drift), 1e-8, 1e-9});
  results.push_back({name + "/fluctuation", course.fluctuation, strain, {}});
}

template <int dim>
void damped(const std::string &name, Scene scene, std::vector<Result> &results)
{
  scene.time.step_fraction = 0.95;
  scene.coupling.fine_damper = 8;
  scene.coupling.gap_filter = 4;
  UnitBody<dim> unit(scene);
  const auto energy = run_noise(unit.body, strain, 20000, 1, 0).leap_frog;
  double rise = -1;
  for (std::size_t k = 1; k < energy.size(); ++k)
    keep_largest(rise, (energy[k] - energy[k - 1]) / energy[0]);
  results.push_back({name + "/rise", rise, 1e-12, 0});
  results.push_back({name + "/left", energy.back() / energy[0], 1, {}});
}

std::vector<Result> contrast()
{
  std::vector<Result> results;
  judge<2>("stability_contrast/hexagonal", band(2, "hexagonal"), results);
  judge<2>("stability_contrast/random", band(2, "random"), results);
  judge<2>("stability_contrast/mosaic", mosaic(), results);
  judge<3>("stability_contrast/fcc", band(3, "fcc"), results);
  damped<2>("stability_contrast/hexagonal", band(2, "hexagonal"), results);
  damped<2>("stability_contrast/random", band(2, "random"), results);
  return results;
}
} // namespace

std::vector<Case> contrast_cases()
{
  return {{"stability_contrast", "grains a thousand times stiffer: undamped and damped noise", true,
           contrast}};
}
} // namespace ligament::program
