#include "src/simulation/gauges/crack_tip.h"

#include "src/output/format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
// Faces of one crack: neighbours along a row, and those that a particle keeps apart.
constexpr double reach = 2; // spacings

constexpr double from_the_start = -std::numeric_limits<double>::infinity(); // s
} // namespace

template <int dim>
CrackTipGauge<dim>::CrackTipGauge(const GaugeParameters &gauge, const CoupledBody<dim> &body,
                                  double smoothing)
    : name_(gauge.name), start_(to_vector<dim>(gauge.points[0])),
      direction_(to_vector<dim>(gauge.direction).normalized()), smoothing_(smoothing),
      faces_(reach * body.spacing)
{
  add(start_, from_the_start);
  for (const BrokenBond &face : body.cut_faces) {
    Vector<dim> centre;
    for (int c = 0; c < dim; ++c)
      centre[c] = face.centroid[c];
    add(centre, from_the_start);
  }
}

template <int dim>
void CrackTipGauge<dim>::add(const Vector<dim> &centre, double time)
{
  const int face = sets_.add();
  farthest_.push_back((centre - start_).dot(direction_));
  faces_.for_each_near(centre, [&](int near) {
    const int a = sets_.find(near), b = sets_.find(face);
    farthest_[b] = std::max(farthest_[a], farthest_[b]);
    sets_.join(a, b);
  });
  faces_.add(centre);
  const double position = farthest_[sets_.find(0)];
  if (steps_.empty() || position > steps_.back().second)
    steps_.push_back({time, position});
}

template <int dim>
std::vector<Column> CrackTipGauge<dim>::columns() const
{
  return {{name_ + "_position", "m"}, {name_ + "_speed", "m/s"}};
}

template <int dim>
double CrackTipGauge<dim>::position_at(double time) const
{
  const auto later = std::upper_bound(steps_.begin(), steps_.end(), time,
                                      [](double t, const auto &step) { return t < step.first; });
  return std::prev(later)->second; // the first one is always there
}

template <int dim>
void CrackTipGauge<dim>::read(GaugeLook<dim> &look, double *values)
{
  if (const auto &force = *look.body.force(); std::size_t(force.n_broken()) > n_broken_) {
    const auto broken = force.broken_bonds_of_body(look.body.zone->state);
    for (; n_broken_ < broken.size(); ++n_broken_)
      add(broken[n_broken_].position, broken[n_broken_].time);
  }
  values[0] = steps_.back().second;
  values[1] = (values[0] - position_at(look.time - smoothing_)) / smoothing_;
}

template <int dim>
std::string CrackTipGauge<dim>::description() const
{
  return fmt::format("farthest of the faces that chains of gaps up to {} join to the start; speed "
                     "over the last {}",
                     quantity(faces_.reach(), "m"), quantity(smoothing_, "s"));
}

template class CrackTipGauge<2>;
template class CrackTipGauge<3>;
} // namespace ligament::program
