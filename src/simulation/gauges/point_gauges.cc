#include "src/simulation/gauges/point_gauges.h"

#include <fmt/format.h>

namespace ligament::program
{
template <int dim>
PointGauge<dim>::PointGauge(const GaugeParameters &gauge, const GaugePlaces<dim> &places)
    : name_(gauge.name), first_(places, to_vector<dim>(gauge.points[0])),
      second_(places, to_vector<dim>(gauge.points[1])),
      is_distance_(gauge.kind == GaugeKind::distance), direction_(to_vector<dim>(gauge.direction))
{
  if (direction_.norm() == 0)
    direction_ = second_.place() - first_.place();
  direction_.normalize();
  description_ = fmt::format("from {} and {}; exact where the strain is the same all over them",
                             first_.source(places.body), second_.source(places.body));
}

// The difference of two lengths that are nearly the same, without taking one from the other.
template <int dim>
void PointGauge<dim>::read(GaugeLook<dim> &look, double *values)
{
  const Vector<dim> moved = second_.reading(look.body).displacement(look.body) -
                            first_.reading(look.body).displacement(look.body);
  if (!is_distance_) {
    values[0] = moved.dot(direction_);
    return;
  }
  const Vector<dim> apart = second_.place() - first_.place();
  values[0] = moved.dot(2 * apart + moved) / ((apart + moved).norm() + apart.norm());
}

template class PointGauge<2>;
template class PointGauge<3>;
} // namespace ligament::program
