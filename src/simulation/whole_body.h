// What observers see of a body in parts: each rank what it owns, and the first one, where it asks
// for that, all of it in the one order of the particles, the others nothing.
#pragma once

#include "src/simulation/coupled_body.h"

namespace ligament::program
{
/// From values of the particles at hand, n of each, those of what the rank owns, into `own`, whose
/// memory is used again. One process owns all.
template <int dim, typename T>
void copy_owned(const particles::ParticleSolver<dim> &zone, const std::vector<T> &values,
                std::vector<T> &own, int n = 1)
{
  own.clear();
  if (zone.ranks().is_one())
    own = values;
  else
    for (const auto &[begin, end] : zone.state.part.owned)
      own.insert(own.end(), values.begin() + std::ptrdiff_t(n) * begin,
                 values.begin() + std::ptrdiff_t(n) * end);
}

/// The same, returned.
template <int dim, typename T>
std::vector<T> owned(const particles::ParticleSolver<dim> &zone, std::vector<T> values, int n = 1)
{
  if (zone.ranks().is_one())
    return values;
  std::vector<T> own;
  copy_owned(zone, values, own, n);
  return own;
}

/// Component by component.
template <int dim, std::size_t n>
std::array<std::vector<double>, n> owned(const particles::ParticleSolver<dim> &zone,
                                         std::array<std::vector<double>, n> values)
{
  for (auto &component : values)
    component = owned<dim, double>(zone, std::move(component));
  return values;
}

/// From values of the particles at hand, n of each, those of the body's on the first rank; nothing
/// on the others. One process has them already. All ranks call it.
template <int dim, typename T>
std::vector<T> at_first(const particles::ParticleSolver<dim> &zone, std::vector<T> values,
                        int n = 1)
{
  if (zone.ranks().is_one())
    return values;
  return zone.ranks().gather_at_first(owned<dim, T>(zone, std::move(values), n));
}

/// Component by component.
template <int dim, std::size_t n>
std::array<std::vector<double>, n> at_first(const particles::ParticleSolver<dim> &zone,
                                            std::array<std::vector<double>, n> values)
{
  for (auto &component : values)
    component = at_first<dim, double>(zone, std::move(component));
  return values;
}

/// The names of the body's particles.
template <int dim>
std::vector<std::int64_t> names_at_first(const particles::ParticleSolver<dim> &zone)
{
  return at_first<dim, std::int64_t>(zone, zone.state.global_id.list());
}

/// Of the body, on all ranks.
template <int dim>
std::int64_t n_overlap_particles(const CoupledBody<dim> &body)
{
  std::int64_t n = 0;
  if (const auto *overlap = body.coupler->overlap())
    for (const auto &m : overlap->members)
      n += body.zone->state.part.owns(m.particle);
  return body.ranks.sum(n);
}
} // namespace ligament::program
