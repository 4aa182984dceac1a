// The servos of a run: loads that move as what is measured asks for.
#pragma once

#include "core/log.h"
#include "src/simulation/servo_law.h"
#include "src/simulation/servo_target.h"

namespace ligament::program
{
/// Looks in every step of the far field, between forces and kick, whatever is written, and says how
/// the loads move behind the next one: supports have booked how they move until then.
template <int dim>
class Servos
{
public:
  Servos(const Scene &scene, const CoupledBody<dim> &body, core::Log &log);

  bool empty() const { return machines_.empty(); }
  /// `far_step` in s, until the next look.
  void steer(const CoupledBody<dim> &body, double time, double far_step);

  /// A new body takes the place of the one before.
  void watch(const Scene &scene, const CoupledBody<dim> &body);
  void save(core::State &state) const;
  void load(const core::State &state);

  /// How far the quantities were from their courses; a warning where it was much.
  void put_into(RunRecord &record, core::Log &log) const;

private:
  /// Their loads follow the courses that are kept here.
  void take_courses(const CoupledBody<dim> &body);

  struct Machine
  {
    ServoTarget<dim> target;
    ServoLaw law;
    double fastest;                // m/s
    core::SteeredCourse *followed; // by the load in the body; the same as
    core::SteeredCourse course = {};
    double largest_error = 0, largest_wanted = 0; // in the unit of the quantity
    double squares = 0;                           // of errors, times s
    double seconds = 0;
  };

  std::optional<GaugeSet<dim>> gauges_; // of those that a servo follows, if any
  std::vector<Machine> machines_;
};

} // namespace ligament::program
