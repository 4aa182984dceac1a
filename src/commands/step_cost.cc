#include "src/commands/step_cost.h"

#include "src/simulation/damping.h"

#include <chrono>

namespace ligament::program
{
template <int dim>
StepCost measure_step_cost(const Scene &scene, CoupledBody<dim> &body, core::Timers &timers,
                           double seconds)
{
  using Clock = std::chrono::steady_clock;
  auto bodies = body.bodies();
  BodyDamping<dim> damping(scene.damping);
  coupling::StepTime step;
  step.dt = body.dt;
  const auto advance = [&](int n) {
    for (int i = 0; i < n; ++i, ++step.step) {
      body.coupler->compute_forces(bodies, step);
      damping.before_kick(body, step);
      body.coupler->kick(bodies, step);
      damping.after_kick(body, step);
      body.coupler->drift(bodies, step);
    }
  };
  const auto seconds_of = [&](const std::string &one, const std::string &other) {
    double sum = 0;
    for (const auto &row : timers.rows())
      if (row.name == one || row.name == other)
        sum += row.seconds;
    return sum;
  };
  const auto discrete_seconds = [&] { return seconds_of("discrete forces", "discrete motion"); };
  const auto mesh_seconds = [&] { return seconds_of("far field", "coupling"); };
  const int block = 4 * body.coupler->step_ratio();
  advance(block); // caches
  const double discrete_before = discrete_seconds(), mesh_before = mesh_seconds();
  const auto start = Clock::now();
  long n = 0;
  double passed = 0;
  while (passed < seconds) {
    advance(block);
    n += block;
    passed = std::chrono::duration<double>(Clock::now() - start).count();
  }
  return {passed / n, (discrete_seconds() - discrete_before) / passed,
          (mesh_seconds() - mesh_before) / passed};
}

template StepCost measure_step_cost(const Scene &, CoupledBody<2> &, core::Timers &, double);
template StepCost measure_step_cost(const Scene &, CoupledBody<3> &, core::Timers &, double);
} // namespace ligament::program
