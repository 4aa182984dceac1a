#include "core/dashpots.h"

#include <algorithm>
#include <cmath>

namespace ligament::core
{
double Dashpot::memory(double dt) const
{
  if (kind != Kind::node)
    return time;
  // Of tau^2 + tau dt/2 = (time^2 - dt^2)/8: nodes and steps then have the impedance of a wave to
  // second order (theory.md eq. (A5)).
  return dt < time ? std::sqrt(time * time / 8 - dt * dt / 16) - dt / 4 : 0;
}

template <int dim>
Dashpots<dim>::Dashpots(const Places &places, const std::function<bool(int)> &owns)
{
  for (const auto &[place, dashpots] : places) {
    for (const Dashpot &d : dashpots)
      if (d.coefficient > 0)
        dashpots_.push_back(d);
    if (dashpots_.size() > (places_.empty() ? 0 : places_.back().end))
      places_.push_back({place[0], place[1], dashpots_.size(), !owns || owns(place[0])});
  }
  memory_.assign(dashpots_.size(), 0.);
}

template <int dim>
void Dashpots<dim>::prepare(double dt)
{
  factors_.clear();
  for (const Dashpot &d : dashpots_) {
    const double c = d.coefficient, tau = d.memory(dt), keep = tau / (tau + dt);
    factors_.push_back(
        d.kind == Dashpot::Kind::layer
            ? Factors{c * keep, -c * keep, 0, keep}
            : Factors{c * (1 - keep), c * keep, d.kind == Dashpot::Kind::node ? c * tau : 0, keep});
  }
  dt_ = dt;
}

template <int dim>
std::map<std::array<std::int64_t, 3>, std::size_t> Dashpots<dim>::numbers(const Names &names) const
{
  std::map<std::array<std::int64_t, 3>, std::size_t> numbers;
  std::size_t begin = 0;
  for (const Place &place : places_) {
    for (std::size_t k = begin; k < place.end; ++k)
      numbers[{names.name(place.index), place.component, std::int64_t(k - begin)}] = k;
    begin = place.end;
  }
  return numbers;
}

template <int dim>
void Dashpots<dim>::save(State &state, const std::string &name, const Names &names) const
{
  std::vector<std::int64_t> keys;
  std::vector<double> memory;
  for (const auto &[key, k] : numbers(names)) {
    keys.insert(keys.end(), key.begin(), key.end());
    memory.push_back(memory_[k]);
  }
  Table table(std::move(keys), 3);
  table.add("memory", memory);
  state[name] = std::move(table);
  save_sum(state, name + "_energy", energy_);
}

template <int dim>
void Dashpots<dim>::load(const State &state, const std::string &name, const Names &names)
{
  const Table &rows = table(state, name);
  const std::vector<double> memory = rows.reals("memory");
  const auto all = numbers(names);
  for (std::size_t r = 0; r < rows.n_rows(); ++r) {
    const auto found =
        all.find({rows.keys()[3 * r], rows.keys()[3 * r + 1], rows.keys()[3 * r + 2]});
    if (found != all.end())
      memory_[found->second] = memory[r];
  }
  energy_ = load_sum(state, name + "_energy");
}

double layer_rate(double depth, double width, double speed)
{
  constexpr double strength = 6;
  const double x = std::clamp(depth / width, 0., 1.);
  return strength * speed / width * x * x;
}

Dashpot layer_dashpot(double mass, double depth, double width, double speed)
{
  constexpr double memory = 0.25; // in times of a wave through the layer
  return {Dashpot::Kind::layer, mass * layer_rate(depth, width, speed), memory * width / speed};
}

template class Dashpots<2>;
template class Dashpots<3>;
} // namespace ligament::core
