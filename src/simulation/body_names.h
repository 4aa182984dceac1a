// The names of a body's particles and nodes in tables of states, found when first asked for.
#pragma once

#include "core/names.h"
#include "src/simulation/coupled_body.h"
#include "src/simulation/whole_body.h"

#include <optional>

namespace ligament::program
{
/// The body must outlive it. Of a body in parts the first rank has the names of all particles, the
/// others none.
template <int dim>
class BodyNames
{
public:
  /// On all ranks at once.
  explicit BodyNames(const CoupledBody<dim> &body) : body_(body)
  {
    if (!body.ranks.is_one())
      particles_ = core::Names(names_at_first(*body.zone));
  }

  /// None without a zone.
  const core::Names &particles()
  {
    if (!particles_)
      particles_ = body_.zone ? body_.zone->state.names() : core::Names();
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
