#include "src/simulation/gauges/open_crack.h"

#include "src/output/format.h"
#include "src/simulation/gauges/near_places.h"

#include <fmt/format.h>

#include <algorithm>

namespace ligament::program
{
namespace
{
// Both faces, and places along them where an atom by chance lacks too few.
constexpr double reach = 2; // spacings
} // namespace

template <int dim>
OpenCrackGauge<dim>::OpenCrackGauge(const GaugeParameters &gauge, const CoupledBody<dim> &body)
    : name_(gauge.name), start_(to_vector<dim>(gauge.points[0])),
      direction_(to_vector<dim>(gauge.direction).normalized()), reach_(reach * body.spacing)
{
}

template <int dim>
std::vector<Column> OpenCrackGauge<dim>::columns() const
{
  return {{name_ + "_ahead", "m"}, {name_ + "_behind", "m"}};
}

template <int dim>
void OpenCrackGauge<dim>::read(GaugeLook<dim> &look, double *values)
{
  const auto &state = look.body.zone->state;
  const std::vector<char> at = look.body.force()->at_crack_faces(state);
  NearPlaces<dim> faces(reach_);
  for (std::size_t i = 0; i < at.size(); ++i)
    if (at[i])
      faces.add(get(state.reference, int(i)));
  std::vector<char> is_seen(faces.size(), 0);
  std::vector<int> front;
  const auto go_on_from = [&](const Vector<dim> &place) {
    faces.for_each_near(place, [&](int k) {
      if (!is_seen[k])
        front.push_back(k);
      is_seen[k] = 1;
    });
  };
  values[0] = values[1] = 0;
  go_on_from(start_);
  while (!front.empty()) {
    const Vector<dim> place = faces[front.back()];
    front.pop_back();
    const double along = (place - start_).dot(direction_);
    values[0] = std::max(values[0], along);
    values[1] = std::max(values[1], -along);
    go_on_from(place);
  }
}

template <int dim>
std::string OpenCrackGauge<dim>::description() const
{
  return fmt::format("farthest atoms that lack a quarter of their neighbours, joined to the start "
                     "by chains of gaps up to {}; costs a look at all bonds for each row",
                     quantity(reach_, "m"));
}

template class OpenCrackGauge<2>;
template class OpenCrackGauge<3>;
} // namespace ligament::program
