// A small body with tools that takes steps like a run, and looks at its ledger.
#pragma once

#include "src/simulation/energy_ledger.h"
#include "src/simulation/initial_motion.h"
#include "src/simulation/tools/rigid_tools.h"
#include "tests/support/static_body.h"

namespace ligament::tests
{
template <int dim>
struct ToolBody
{
  core::Log log;
  core::Timers timers;
  program::CoupledBody<dim> body;
  coupling::StepTime now;

  /// Of the plate (2D) or the bar (3D) after `overrides`.
  explicit ToolBody(const std::vector<std::string> &overrides)
      : ToolBody(static_scene<dim>(overrides))
  {
  }
  explicit ToolBody(const program::Scene &scene) : body(program::make_body<dim>(scene, log, timers))
  {
    now.dt = body.dt;
    program::start_motion(scene, body);
    compute();
  }

  const program::RigidTools<dim> &tools() const
  {
    return dynamic_cast<const program::RigidTools<dim> &>(*body.tools);
  }
  void compute()
  {
    auto bodies = body.bodies();
    body.coupler->compute_forces(bodies, now);
    body.tools->act(bodies, now, body.coupler->step_ratio());
  }
  void step()
  {
    auto bodies = body.bodies();
    body.coupler->kick(bodies, now);
    body.coupler->drift(bodies, now);
    now = {now.step + 1, double(now.step + 1) * now.dt, now.dt};
    compute();
  }
  /// To the next action of the far field.
  void far_step()
  {
    for (int k = 0; k < body.coupler->step_ratio(); ++k)
      step();
  }
  program::EnergyLedger ledger() const { return read_ledger(body, now, 0); }

  /// kg m/s of the body half a step ago; scale with the velocities that a kick leaves.
  Vector<dim> momentum() const
  {
    Vector<dim> sum = Vector<dim>::Zero();
    const auto &state = body.zone->state;
    for (int i = 0; i < state.size(); ++i)
      sum += state.mass[i] * get(state.velocity, i);
    return sum;
  }
};
} // namespace ligament::tests
