#include "src/simulation/overlap_guard.h"

#include "src/output/format.h"

#include <fmt/format.h>

#include <algorithm>

namespace ligament::program
{
using particles::Watch;

namespace
{
template <int dim>
std::string place(const Vector<dim> &x)
{
  std::string text;
  for (int c = 0; c < dim; ++c)
    text += (c ? ", " : "") + quantity(x[c], "m");
  return "(" + text + ")";
}
} // namespace

template <int dim>
OverlapGuard<dim>::OverlapGuard(const CoupledBody<dim> &body)
{
  const auto *overlap = body.coupler->overlap();
  if (!overlap || !(body.force()->can_break() || body.force()->can_flow()))
    return;
  watch_.assign(body.zone->state.size(), Watch::none);
  for (const auto &m : overlap->members)
    watch_[m.particle] = m.pad ? Watch::exempt : Watch::watched;
  body.force()->set_noted_share(limit);
}

template <int dim>
bool OverlapGuard<dim>::is_watched(const particles::BrokenBond<dim> &bond) const
{
  return std::max(watch_[bond.i], watch_[bond.j]) == Watch::watched;
}

template <int dim>
std::optional<std::string> OverlapGuard<dim>::look(const CoupledBody<dim> &body)
{
  if (watch_.empty())
    return {};
  const auto &broken = body.force()->broken_bonds();
  for (; seen_ < broken.size(); ++seen_)
    if (is_watched(broken[seen_])) {
      ++n_broken_;
      energy_.add(broken[seen_].energy);
    }
  if (found_)
    return {};
  constexpr const char *remedy = "make /discrete_zone/region larger";
  if (n_broken_ > 0) {
    found_ = true;
    const auto first =
        std::find_if(broken.begin(), broken.end(), [this](const auto &b) { return is_watched(b); });
    return fmt::format("{} in the overlap broke, the first at {}: the mesh there still carries as "
                       "if {} had not; {}",
                       n_broken_ == 1 ? "a face" : grouped(n_broken_) + " faces",
                       place<dim>(first->position), n_broken_ == 1 ? "it" : "they", remedy);
  }
  const auto flow = body.force()->flow_utilisation(body.zone->state, watch_);
  if (flow.share >= 1) {
    found_ = true;
    return fmt::format("the overlap would flow at {}, where particles and mesh stay elastic: they "
                       "bear {:.0f} % of the yield stress; {}",
                       place<dim>(flow.place), 100 * flow.share, remedy);
  }
  const auto most = body.force()->utilisation(body.zone->state, watch_);
  if (most.share < limit)
    return {};
  found_ = true;
  return fmt::format("a face in the overlap bears {:.0f} % of what breaks it, at {}: fracture "
                     "comes near it; {}",
                     100 * most.share, place<dim>(most.place), remedy);
}

template <int dim>
void OverlapGuard<dim>::save(core::State &state) const
{
  core::save_value(state, "recorder", "guard_seen", std::int64_t(seen_));
  core::save_value(state, "recorder", "guard_broken", std::int64_t(n_broken_));
  core::save_sum(state, "guard_energy", energy_);
  core::save_value(state, "recorder", "guard_found", std::int64_t(found_));
}

template <int dim>
void OverlapGuard<dim>::load(const core::State &state)
{
  seen_ = std::size_t(core::load_integer(state, "recorder", "guard_seen"));
  n_broken_ = long(core::load_integer(state, "recorder", "guard_broken"));
  energy_ = core::load_sum(state, "guard_energy");
  found_ = core::load_integer(state, "recorder", "guard_found") != 0;
}

template class OverlapGuard<2>;
template class OverlapGuard<3>;
} // namespace ligament::program
