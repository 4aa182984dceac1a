// The force of loads on the body, with all components.
#pragma once

#include "src/simulation/gauges/gauge.h"

namespace ligament::program
{
/// In N, as it acts on the body: of a load, of all loads on a side, or of a tool.
template <int dim>
class ForceGauge : public Gauge<dim>
{
public:
  ForceGauge(const GaugeParameters &gauge, const CoupledBody<dim> &body);

  std::vector<Column> columns() const override;
  void read(GaugeLook<dim> &look, double *values) override;
  std::string description() const override;

private:
  std::string name_;
  std::vector<int> loads_;
  int tool_ = -1;
};
} // namespace ligament::program
