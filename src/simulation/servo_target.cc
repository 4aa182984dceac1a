#include "src/simulation/servo_target.h"

#include "core/keyed_error.h"
#include "src/scene/servo_scales.h"
#include "src/simulation/make_loads.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace ligament::program
{
int steered_component(const LoadParameters &load)
{
  for (int c = 0; c < 3; ++c)
    if (load.velocity[c].value_or(0) != 0)
      return c;
  return 0;
}

template <int dim>
ServoTarget<dim>::ServoTarget(const Scene &scene, int load, const CoupledBody<dim> &body,
                              const GaugeSet<dim> &gauges)
    : load_(load)
{
  const LoadParameters &parameters = scene.loads[load];
  const ServoParameters &servo = *parameters.servo;
  component_ = steered_component(parameters);
  value_ = servo.wanted();
  gain_ = servo.gain != 0 ? servo.gain : 1;
  course_ = time_function_of(servo.history, servo.ramp);
  if (servo.gauge.empty()) {
    const int axis =
        parameters.boundary > inner_surface<dim> ? component_ : parameters.boundary / 2;
    const bool is_upper =
        body.load_places[load].middle[axis] > (body.lower[axis] + body.upper[axis]) / 2;
    sign_ = is_upper ? 1 : -1;
    area_ = body.load_places[load].area;
    const double outward = *parameters.velocity[component_] > 0 ? sign_ : -sign_;
    gain_ = outward * servo_stiffness(scene, parameters, component_);
    column_ = {fmt::format("servo_{}_error", load), "Pa"};
    return;
  }
  std::vector<std::string> names;
  for (const Column &column : gauges.columns()) {
    if (column.name == servo.gauge) {
      gauge_column_ = int(names.size());
      column_ = {fmt::format("servo_{}_error", load), column.unit};
    }
    names.push_back(column.name);
  }
  if (gauge_column_ < 0)
    throw core::KeyedError(fmt::format("/loads/{}/servo/gauge", load),
                           fmt::format("no gauge has the column \"{}\"", servo.gauge),
                           fmt::format("the gauges of this scene have {}", fmt::join(names, ", ")),
                           "name one of them");
}

template <int dim>
double ServoTarget<dim>::measured(const CoupledBody<dim> &body,
                                  const std::vector<double> &gauges) const
{
  if (gauge_column_ >= 0)
    return gauges[gauge_column_];
  double force = 0;
  if (body.force())
    force += body.force()->reaction(load_)[component_];
  if (body.far)
    force += body.far->reaction(load_)[component_];
  return sign_ * force / area_;
}

template <int dim>
std::vector<ServoTarget<dim>> servo_targets(const Scene &scene, const CoupledBody<dim> &body,
                                            const GaugeSet<dim> &gauges)
{
  std::vector<ServoTarget<dim>> targets;
  for (std::size_t k = 0; k < scene.loads.size(); ++k)
    if (scene.loads[k].servo)
      targets.emplace_back(scene, int(k), body, gauges);
  return targets;
}

template class ServoTarget<2>;
template class ServoTarget<3>;
template std::vector<ServoTarget<2>> servo_targets(const Scene &, const CoupledBody<2> &,
                                                   const GaugeSet<2> &);
template std::vector<ServoTarget<3>> servo_targets(const Scene &, const CoupledBody<3> &,
                                                   const GaugeSet<3> &);
} // namespace ligament::program
