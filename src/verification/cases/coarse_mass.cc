// Light coarse masses: the same static answer in fewer steps, no smaller step.
#include "src/simulation/damping.h"
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases.h"
#include "src/verification/instruments/linear_motion.h"

#include <cmath>

namespace ligament::program
{
namespace
{
constexpr double height = 200, stress = 1e-4, nu = 0.3, cell_size = 4.1;

Scene long_bar(double coarse_mass)
{
  Scene scene = unit_scene(2, {18, height, 0}, nu);
  add_far_field(scene, {0, 40, 0}, cell_size);
  scene.coupling.coarse_mass = coarse_mass;
  return scene;
}

/// Elongation between the two ends, in d.
double elongation(const CoupledBody<2> &body)
{
  const auto &far = *body.far;
  double sum[2] = {}, number[2] = {};
  for (int i = 0; i < far.mesh().n_nodes(); ++i)
    for (const int end : {0, 1})
      if (std::abs(far.mesh().nodes[i][1] - (end ? height : -height) / 2) < 1e-6) {
        sum[end] += far.displacement[1][i];
        number[end] += 1;
      }
  return sum[1] / number[1] - sum[0] / number[0];
}

struct Relaxed
{
  long steps;   // to within 1e-3 of the answer for good
  double error; // at the end
};

/// Pulled at its ends by a traction that comes at once, brought to rest by kinetic damping.
Relaxed relax(double coarse_mass)
{
  Scene scene = long_bar(coarse_mass);
  add_tractions<2>(scene, {2, 3}, {0, stress, 0});
  scene.damping.kinetic = true;
  scene.coupling.fine_damper = 8;
  UnitBody<2> unit(scene);
  auto &body = unit.body;
  BodyDamping<2> damping(scene.damping);
  auto bodies = body.bodies();
  coupling::StepTime step;
  step.dt = body.dt;
  body.coupler->compute_forces(bodies, step);
  const double answer = stress * (1 - nu * nu) * height; // plane strain, E = 1
  Relaxed result = {0, 0};
  while (step.step < 12000) {
    damping.before_kick(body, step);
    body.coupler->kick(bodies, step);
    damping.after_kick(body, step);
    body.coupler->drift(bodies, step);
    ++step.step;
    step.time = double(step.step) * step.dt;
    body.coupler->compute_forces(bodies, step);
    result.error = std::abs(elongation(body) / answer - 1);
    if (!(result.error < 1e-3))
      result.steps = step.step;
  }
  return result;
}

/// Critical step over the one that the set-up calls stable.
double margin(double coarse_mass)
{
  Scene scene = long_bar(coarse_mass);
  UnitBody<2> unit(scene);
  LinearMotion<2> motion(unit.body);
  return 2 / motion.largest_frequency() / unit.body.dt_zone;
}
} // namespace

std::vector<Case> coarse_mass_cases()
{
  return {{"coarse_mass", "bar of 200 d at rest under tension, coarse masses times d/h = 1/4.1",
           true, [] {
             const Relaxed full = relax(1), light = relax(1 / cell_size);
             return std::vector<Result>{
                 {"coarse_mass/error", std::max(full.error, light.error), 1e-4, {}},
                 {"coarse_mass/step_gain", double(full.steps) / double(light.steps), 1.5, 2,
                  Result::Bound::at_least},
                 {"coarse_mass/margin", margin(1 / cell_size), 0.99, {}, Result::Bound::at_least}};
           }}};
}
} // namespace ligament::program
