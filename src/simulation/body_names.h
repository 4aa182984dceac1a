// The names of a body's particles and nodes in tables of states, found when first asked for.
#pragma once

#include "core/names.h"
#include "src/simulation/coupled_body.h"

#include <optional>

namespace ligament::program
{
/// The body must outlive it.
template <int dim>
class BodyNames
{
public:
  explicit BodyNames(const CoupledBody<dim> &body) : body_(body) {}

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
