// What a servo follows: a quantity of the body, and what it should be.
#pragma once

#include "src/output/table.h"
#include "src/simulation/gauges/gauge_set.h"

namespace ligament::program
{
/// Of one load of the scene that has a servo.
template <int dim>
class ServoTarget
{
public:
  /// core::KeyedError where no gauge has the column.
  ServoTarget(const Scene &scene, int load, const CoupledBody<dim> &body,
              const GaugeSet<dim> &gauges);

  /// In the unit of the quantity, and per s.
  double wanted(double time) const { return value_ * course_.value(time); }
  double wanted_rate(double time) const { return value_ * course_.rate(time); }
  /// The quantity, from what the gauges read.
  double measured(const CoupledBody<dim> &body, const std::vector<double> &gauges) const;
  /// By how much it rises while the load moves by 1 m along its velocity, as the scene has it or
  /// estimated from the specimen.
  double gain() const { return gain_; }
  /// Of its error.
  const Column &column() const { return column_; }
  int load() const { return load_; }

private:
  int load_, gauge_column_ = -1; // -1: the load's own stress
  int component_ = 0;            // of the load's velocity
  double sign_ = 1, area_ = 1;   // of the stress: tension on the upper side is positive
  double value_, gain_;
  core::TimeFunction course_;
  Column column_;
};

template <int dim>
std::vector<ServoTarget<dim>> servo_targets(const Scene &scene, const CoupledBody<dim> &body,
                                            const GaugeSet<dim> &gauges);

/// The component of its velocity that a servo steers.
int steered_component(const LoadParameters &load);
} // namespace ligament::program
