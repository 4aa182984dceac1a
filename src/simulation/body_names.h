// The names of a body's particles and nodes in tables of states, found when first asked for.
#pragma once

#include "core/names.h"
#include "src/simulation/coupled_body.h"
#include "src/simulation/whole_body.h"

#include <memory>
#include <optional>

namespace ligament::program
{
/// The body must outlive it. Of a body in parts each rank has the names of the particles that it
/// owns, unless the first one is to have all of them.
template <int dim>
class BodyNames
{
public:
  explicit BodyNames(const CoupledBody<dim> &body) : body_(body) {}

  /// On all ranks at once: the first one has all particles, the others none.
  static std::shared_ptr<BodyNames> at_first(const CoupledBody<dim> &body)
  {
    const auto names = std::make_shared<BodyNames>(body);
    if (!body.ranks.is_one())
      names->particles_ = core::Names(names_at_first(*body.zone));
    return names;
  }

  /// None without a zone.
  const core::Names &particles()
  {
    if (!particles_)
      particles_ = !body_.zone            ? core::Names()
                   : body_.ranks.is_one() ? body_.zone->state.names()
                                          : core::Names(owned<dim, std::int64_t>(
                                                *body_.zone, body_.zone->state.global_id.list()));
    return *particles_;
  }
  /// None without a far field.
  const core::Names &nodes()
  {
    if (!nodes_)
      nodes_ = body_.far ? fem::node_names<dim>(body_.far->mesh(), body_.lower, body_.upper)
                         : core::Names();
    return *nodes_;
  }

private:
  const CoupledBody<dim> &body_;
  std::optional<core::Names> particles_, nodes_;
};
} // namespace ligament::program
