// How far a crack stands open at present, by the atoms that lack neighbours.
#pragma once

#include "src/simulation/gauges/gauge.h"

namespace ligament::program
{
/// Particles at crack faces (particles::ForceReport::at_crack_faces) belong to the crack when a
/// chain of them leads to its start whose places in the reference lie within two spacings of each
/// other. Its ends are the farthest ones along the direction and against it, seen from the start,
/// in m and at least 0; where faces meet again they go back.
template <int dim>
class OpenCrackGauge : public Gauge<dim>
{
public:
  OpenCrackGauge(const GaugeParameters &gauge, const CoupledBody<dim> &body);

  std::vector<Column> columns() const override;
  void read(GaugeLook<dim> &look, double *values) override;
  std::string description() const override;

private:
  std::string name_;
  Vector<dim> start_, direction_;
  double reach_; // m
};
} // namespace ligament::program
