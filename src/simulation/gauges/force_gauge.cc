#include "src/simulation/gauges/force_gauge.h"

#include <fmt/format.h>

namespace ligament::program
{
template <int dim>
ForceGauge<dim>::ForceGauge(const GaugeParameters &gauge, const CoupledBody<dim> &body)
    : name_(gauge.name)
{
  for (int k = 0; body.tools && k < body.tools->size(); ++k)
    if (body.tools->name(k) == gauge.tool)
      tool_ = k;
  for (int l = 0; tool_ < 0 && l < int(body.loads.size()); ++l)
    if (gauge.load >= 0 ? l == gauge.load : body.loads[l].boundary == gauge.side)
      loads_.push_back(l);
}

template <int dim>
std::vector<Column> ForceGauge<dim>::columns() const
{
  std::vector<Column> columns;
  for (int c = 0; c < dim; ++c)
    columns.push_back({fmt::format("{}_{}", name_, "xyz"[c]), "N"});
  return columns;
}

template <int dim>
void ForceGauge<dim>::read(GaugeLook<dim> &look, double *values)
{
  Vector<dim> force = Vector<dim>::Zero();
  for (const int load : loads_) {
    if (look.body.force())
      force += look.body.force()->reaction(load);
    if (look.body.far)
      force += look.body.far->reaction(load);
  }
  if (tool_ >= 0)
    force = look.body.tools->read(tool_).force;
  for (int c = 0; c < dim; ++c)
    values[c] = force[c];
}

template <int dim>
std::string ForceGauge<dim>::description() const
{
  if (tool_ >= 0)
    return fmt::format("of /tools/{} on the body", tool_);
  std::string list;
  for (const int load : loads_)
    list += fmt::format("{}/loads/{}", list.empty() ? "" : ", ", load);
  return "of " + list + " on the body";
}

template class ForceGauge<2>;
template class ForceGauge<3>;
} // namespace ligament::program
