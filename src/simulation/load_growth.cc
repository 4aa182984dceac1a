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
  return load.pressure.value_or(0) != 0 ||
         std::any_of(load.value.begin(), load.value.end(), [](const auto &v) { return v && *v; });
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
  const auto are_in_proportion = [&](const auto &a, const auto &b) {
    for (const double part : {0.25, 0.5, 0.75}) {
      const double time = from + part * (to - from);
      if (!(std::abs(share_of(a, from, to, time) - share_of(b, from, to, time)) < round_off))
        return false;
    }
    return true;
  };
  for (const auto &load : loads) {
    if (!has_value(load) || size_at(load, to) == size_at(load, from))
      continue;
    if (std::none_of(courses_.begin(), courses_.end(),
                     [&](const auto *course) { return are_in_proportion(load, *course); }))
      courses_.push_back(&load);
  }
}

template <int dim>
double LoadGrowth<dim>::share(double time) const
{
  return courses_.empty() ? (time - from_) / (to_ - from_)
                          : share_of(*courses_[0], from_, to_, time);
}

template <int dim>
Eigen::VectorXd LoadGrowth<dim>::shares(double time) const
{
  Eigen::VectorXd shares(n_courses());
  shares[0] = share(time);
  for (int k = 1; k < n_courses(); ++k)
    shares[k] = share_of(*courses_[k], from_, to_, time);
  return shares;
}

template <int dim>
Eigen::VectorXd LoadGrowth<dim>::rates(double time) const
{
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(n_courses());
  for (std::size_t k = 0; k < courses_.size(); ++k)
    rates[Eigen::Index(k)] =
        rate_at(*courses_[k], time) / (size_at(*courses_[k], to_) - size_at(*courses_[k], from_));
  return rates;
}

template <int dim>
double LoadGrowth<dim>::time_of(double wanted) const
{
  double low = from_, high = to_;
  for (int k = 0; k < 60; ++k) {
    const double middle = low + (high - low) / 2;
    (share(middle) >= wanted ? high : low) = middle;
  }
  return high;
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
