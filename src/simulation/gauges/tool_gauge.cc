#include "src/simulation/gauges/tool_gauge.h"

#include <fmt/format.h>

namespace ligament::program
{
template <int dim>
ToolGauge<dim>::ToolGauge(int tool, const CoupledBody<dim> &body)
    : tool_(tool), name_(body.tools->name(tool))
{
}

template <int dim>
std::vector<Column> ToolGauge<dim>::columns() const
{
  std::vector<Column> columns;
  for (int c = 0; c < dim; ++c)
    columns.push_back({fmt::format("{}_force_{}", name_, "xyz"[c]), "N"});
  for (int c = 0; c < dim; ++c)
    columns.push_back({fmt::format("{}_displacement_{}", name_, "xyz"[c]), "m"});
  columns.push_back({name_ + "_area", "m^2"});
  return columns;
}

template <int dim>
void ToolGauge<dim>::read(GaugeLook<dim> &look, double *values)
{
  const ToolReading<dim> reading = look.body.tools->read(tool_);
  for (int c = 0; c < dim; ++c) {
    values[c] = reading.force[c];
    values[dim + c] = reading.displacement[c];
  }
  values[2 * dim] = reading.area;
}

template <int dim>
std::string ToolGauge<dim>::description() const
{
  return "force on the body, way of the tool, area that it presses on";
}

template class ToolGauge<2>;
template class ToolGauge<3>;
} // namespace ligament::program
