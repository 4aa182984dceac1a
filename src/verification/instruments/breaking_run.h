// A body that is pulled or pressed until it breaks, stepped as `run` does, with its energy balance.
#pragma once

#include "src/simulation/damping.h"
#include "src/simulation/energy_ledger.h"
#include "src/verification/bodies/unit_bodies.h"

#include <cmath>

namespace ligament::program
{
template <int dim>
class BreakingRun
{
public:
  explicit BreakingRun(const Scene &scene) : unit_(scene), damping_(scene.damping)
  {
    now_.dt = unit_.body.dt;
    auto bodies = unit_.body.bodies();
    unit_.body.coupler->compute_forces(bodies, now_);
    start_ = residual();
  }

  /// To the next impulse of the far field.
  void step()
  {
    auto &body = unit_.body;
    auto bodies = body.bodies();
    for (int k = 0; k < body.coupler->step_ratio(); ++k) {
      damping_.before_kick(body, now_);
      body.coupler->kick(bodies, now_);
      damping_.after_kick(body, now_);
      body.coupler->drift(bodies, now_);
      ++now_.step;
      now_.time = double(now_.step) * now_.dt;
      body.coupler->compute_forces(bodies, now_);
    }
  }

  const CoupledBody<dim> &body() const { return unit_.body; }
  double time() const { return now_.time; }
  /// J, since the start.
  double unbooked() const { return std::abs(residual() - start_); }
  double work() const { return ledger().external_work; }
  /// Of load number `number` on particles and nodes along an axis, in N.
  double load(int number, int axis) const
  {
    const auto &body = unit_.body;
    return (body.force() ? body.force()->reaction(number)[axis] : 0) +
           (body.far ? body.far->reaction(number)[axis] : 0);
  }

private:
  EnergyLedger ledger() const { return read_ledger(unit_.body, now_, damping_.energy()); }
  double residual() const { return ledger().residual(); }

  UnitBody<dim> unit_;
  BodyDamping<dim> damping_;
  coupling::StepTime now_;
  double start_ = 0;
};

/// Ends along the axis `axis`, moved apart (above 0) or together at this speed each.
inline void add_pull(Scene &scene, int axis, double speed, double ramp)
{
  for (const bool upper : {false, true}) {
    LoadParameters load;
    load.boundary = 2 * axis + upper;
    load.kind = LoadKind::velocity;
    load.ramp = ramp;
    load.value[axis] = upper ? speed : -speed;
    load.velocity = load.value;
    scene.loads.push_back(load);
  }
}
} // namespace ligament::program
