// Gauges between two points: an extensometer, and a clip gauge.
#pragma once

#include "src/simulation/gauges/gauge.h"
#include "src/simulation/gauges/motion_reading.h"

namespace ligament::program
{
/// Change of the distance between two points, or the motion of the second against the first along a
/// direction that does not turn; in m.
template <int dim>
class PointGauge : public Gauge<dim>
{
public:
  /// Kinds distance and opening.
  PointGauge(const GaugeParameters &gauge, const GaugePlaces<dim> &places);

  std::vector<Column> columns() const override { return {{name_, "m"}}; }
  void read(GaugeLook<dim> &look, double *values) override;
  std::string description() const override { return description_; }

private:
  std::string name_, description_;
  PointMotion<dim> first_, second_;
  bool is_distance_;
  Vector<dim> direction_; // unit; of an opening
};
} // namespace ligament::program
