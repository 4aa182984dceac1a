// What a tool does to the body and how far it has come: columns that every tool has.
#pragma once

#include "src/simulation/gauges/gauge.h"

namespace ligament::program
{
/// Force on the body in N, displacement of the tool in m.
template <int dim>
class ToolGauge : public Gauge<dim>
{
public:
  explicit ToolGauge(int tool, const CoupledBody<dim> &body);

  std::vector<Column> columns() const override;
  void read(GaugeLook<dim> &look, double *values) override;
  std::string description() const override;

private:
  int tool_;
  std::string name_;
};
} // namespace ligament::program
