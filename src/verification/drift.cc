// Energy of coupled bodies that move as noise: kept when undamped, falling with dampers.
#include "src/verification/cases.h"
#include "src/verification/unit_bodies.h"

#include <random>

namespace ligament::program
{
namespace
{
template <int dim>
void start_noise(CoupledBody<dim> &body, double amplitude)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-amplitude, amplitude);
  const auto fill = [&](auto &components) {
    for (auto &component : components)
      for (double &v : component)
        v = uniform(random);
  };
  fill(body.zone->state.velocity);
  fill(body.far->velocity);
  body.far->distribute();
  auto bodies = body.bodies();
  body.coupler->take_velocities(bodies);
}

/// Mechanical energy of the body (theory.md, "The energy ledger") every `interval` steps.
template <int dim>
std::vector<double> energies(const Scene &scene, double amplitude, long n_steps, int interval)
{
  UnitBody<dim> unit(scene);
  auto &body = unit.body;
  start_noise(body, amplitude);
  auto bodies = body.bodies();
  std::vector<double> series;
  coupling::StepTime step;
  step.dt = body.dt;
  for (; step.step < n_steps; ++step.step, step.time = step.step * step.dt) {
    body.coupler->compute_forces(bodies, step);
    if (step.step % interval == 0) {
      const auto e = body.coupler->energy(bodies, step);
      series.push_back(e.kinetic_discrete + e.kinetic_far + e.potential_discrete + e.potential_far +
                       e.blended);
    }
    body.coupler->kick(bodies, step);
    body.coupler->drift(bodies, step);
  }
  return series;
}

/// What happened to the energy, over its mean.
struct Course
{
  double drift;       // least-squares slope of block means, per 1e5 steps
  double fluctuation; // largest distance of a sample from the mean
};

Course course(const std::vector<double> &series, int interval)
{
  constexpr int n_blocks = 50;
  const int per_block = int(series.size()) / n_blocks;
  double mean = 0, xx = 0, xy = 0;
  for (const double e : series)
    mean += e / double(series.size());
  for (int b = 0; b < n_blocks; ++b) {
    double block = 0;
    for (int k = 0; k < per_block; ++k)
      block += (series[b * per_block + k] / mean - 1) / per_block;
    const double x = b - (n_blocks - 1) / 2.;
    xx += x * x;
    xy += x * block;
  }
  Course result = {std::abs(xy / xx) / (double(per_block) * interval) * 1e5, 0};
  for (const double e : series)
    keep_worst(result.fluctuation, std::abs(e / mean - 1));
  return result;
}

Scene band_2d(int step_ratio)
{
  Scene scene = unit_scene(2, {18, 118, 0}, 0.22);
  add_far_field(scene, {0, 34, 0}, 4.6);
  scene.coupling.step_ratio = step_ratio;
  return scene;
}

Scene band_3d()
{
  Scene scene = unit_scene(3, {6.3, 6.7, 66}, 0.3);
  add_far_field(scene, {0, 0, 23}, 3.1);
  scene.coupling.transition_cells = 4;
  return scene;
}

Scene made_random(Scene scene)
{
  scene.zone.packing = "random";
  return scene;
}

template <int dim>
std::vector<Result> undamped(const std::string &name, const Scene &scene, double amplitude,
                             long n_steps)
{
  const int interval = 5 * scene.coupling.step_ratio;
  const Course c = course(energies<dim>(scene, amplitude, n_steps, interval), interval);
  if (scene.coupling.step_ratio == 1)
    return {{name + "/drift", c.drift, 1e-8, 1e-9},
            {name + "/fluctuation", c.fluctuation, 1e-6, {}}};
  return {{name + "/drift", c.drift, 1e-6, {}}, {name + "/fluctuation", c.fluctuation, 5e-3, {}}};
}

/// Largest rise of the energy between two samples, over the energy at the start; and what is left.
std::vector<Result> damped()
{
  Scene scene = band_2d(1);
  scene.time.step_fraction = 0.95;
  scene.coupling.fine_damper = 8;
  scene.coupling.gap_filter = 4;
  const auto series = energies<2>(scene, 1e-9, 4000, 1);
  double rise = -1;
  for (std::size_t k = 1; k < series.size(); ++k)
    keep_worst(rise, (series[k] - series[k - 1]) / series[0]);
  return {{"decay/rise", rise, 1e-12, 0}, {"decay/left", series.back() / series[0], 1, {}}};
}
} // namespace

std::vector<Case> drift_cases()
{
  const std::string text = "undamped noise at 0.9 of the critical step, ";
  return {{"drift", text + "strain 1e-8, 5e3 steps", false,
           [] { return undamped<2>("drift", band_2d(1), 1e-8, 5000); }},
          {"drift_3d", text + "FCC, strain 1e-8, 2e3 steps", false,
           [] { return undamped<3>("drift_3d", band_3d(), 1e-8, 2000); }},
          {"drift_random", text + "random, strain 1e-8, 5e3 steps", false,
           [] { return undamped<2>("drift_random", made_random(band_2d(1)), 1e-8, 5000); }},
          {"drift_random_3d", text + "random, strain 1e-8, 2e3 steps", true,
           [] { return undamped<3>("drift_random_3d", made_random(band_3d()), 1e-8, 2000); }},
          {"drift_long_random", text + "random, strain 1e-6, 1e5 steps", true,
           [] { return undamped<2>("drift_long_random", made_random(band_2d(1)), 1e-6, 100000); }},
          {"drift_ratio", text + "step ratio 4, strain 1e-8, 1e4 steps", true,
           [] { return undamped<2>("drift_ratio", band_2d(4), 1e-8, 10000); }},
          {"drift_long", text + "strain 1e-6, 1e5 steps", true,
           [] { return undamped<2>("drift_long", band_2d(1), 1e-6, 100000); }},
          {"drift_long_3d", text + "FCC, strain 1e-6, 1e5 steps", true,
           [] { return undamped<3>("drift_long_3d", band_3d(), 1e-6, 100000); }},
          {"drift_long_ratio", text + "step ratio 4, strain 1e-6, 1e5 steps", true,
           [] { return undamped<2>("drift_long_ratio", band_2d(4), 1e-6, 100000); }},
          {"decay", "damped noise at 0.95 of the critical step, every step", false, damped}};
}
} // namespace ligament::program
