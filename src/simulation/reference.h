// What a set-up finds out at some cost and a resumed run takes as found: the geometry of a random
// packing, the factor between toughness and strength, the stable step.
#pragma once

#include "core/state.h"
#include "packings/packing_state.h"

#include <functional>
#include <map>
#include <vector>

namespace ligament::program
{
class Reference
{
public:
  /// Nothing is known yet: the set-up fills it in.
  Reference() = default;
  explicit Reference(core::State tables) : tables_(std::move(tables)) {}

  /// The value of this name; where it is not known yet, what find() answers is kept.
  double value(const std::string &name, const std::function<double()> &find);
  /// Names of the values that begin so.
  std::vector<std::string> names(const std::string &begin) const;

  /// Likewise; `cracks` of the specimen are those of the scene.
  template <int dim>
  packings::RandomPacking<dim> packing(const packings::SpecimenParameters<dim> &specimen,
                                       const std::function<packings::RandomPacking<dim>()> &find);

  const core::State &tables() const { return tables_; }

private:
  core::State tables_;
};

template <int dim>
packings::RandomPacking<dim>
Reference::packing(const packings::SpecimenParameters<dim> &specimen,
                   const std::function<packings::RandomPacking<dim>()> &find)
{
  if (tables_.count("cells"))
    return packings::load_packing<dim>(tables_, specimen);
  auto packing = find();
  packings::save_packing(tables_, packing);
  return packing;
}
} // namespace ligament::program
