#include "src/simulation/load_growth.h"

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
/// Of a load, over its value.
template <int dim>
double size_at(const core::BoundaryLoad<dim> &load, double time)
{
  return load.kind == core::BoundaryLoad<dim>::Kind::velocity ? load.history.integral(time)
                                                              : load.history.value(time);
}
template <int dim>
double rate_at(const core::BoundaryLoad<dim> &load, double time)
{
  return load.kind == core::BoundaryLoad<dim>::Kind::velocity ? load.history.value(time)
                                                              : load.history.rate(time);
}

template <int dim>
bool has_value(const core::BoundaryLoad<dim> &load)
{
  return std::any_of(load.value.begin(), load.value.end(), [](const auto &v) { return v && *v; });
}

template <int dim>
double share_of(const core::BoundaryLoad<dim> &load, double from, double to, double time)
{
  const double start = size_at(load, from);
  return (size_at(load, time) - start) / (size_at(load, to) - start);
}
} // namespace

template <int dim>
LoadGrowth<dim>::LoadGrowth(const std::vector<core::BoundaryLoad<dim>> &loads, double from,
                            double to)
    : from_(from), to_(to)
{
  constexpr double round_off = 1e-9;
  for (const auto &load : loads) {
    if (!has_value(load) || size_at(load, to) == size_at(load, from))
      continue;
    if (!lead_) {
      lead_ = &load;
      continue;
    }
    for (const double part : {0.25, 0.5, 0.75}) {
      const double time = from + part * (to - from);
      is_proportional_ = is_proportional_ && std::abs(share_of(load, from, to, time) -
                                                      share_of(*lead_, from, to, time)) < round_off;
    }
  }
}

template <int dim>
double LoadGrowth<dim>::share(double time) const
{
  return lead_ ? share_of(*lead_, from_, to_, time) : (time - from_) / (to_ - from_);
}

template <int dim>
double LoadGrowth<dim>::rate(double time) const
{
  return lead_ ? rate_at(*lead_, time) / (size_at(*lead_, to_) - size_at(*lead_, from_)) : 0;
}

template <int dim>
double LoadGrowth<dim>::next_corner(const std::vector<core::BoundaryLoad<dim>> &loads, double from,
                                    double last)
{
  double corner = last;
  for (const auto &load : loads)
    if (has_value(load))
      corner = std::min(corner, load.history.next_corner(from));
  return corner;
}

template <int dim>
bool LoadGrowth<dim>::may_turn(const std::vector<core::BoundaryLoad<dim>> &loads)
{
  return std::any_of(loads.begin(), loads.end(),
                     [](const auto &load) { return has_value(load) && !load.history.is_ramp(); });
}

template class LoadGrowth<2>;
template class LoadGrowth<3>;
} // namespace ligament::program
