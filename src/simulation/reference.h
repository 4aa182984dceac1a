// What a set-up finds out at some cost and a resumed run takes as found: the seeds of an irregular
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

  /// Likewise, from which the packing is cut again.
  template <int dim>
  packings::Seeds<dim> seeds(const std::function<packings::Seeds<dim>()> &find);

  const core::State &tables() const { return tables_; }

private:
  // The table "seeds" of checkpoints of before had healed radii, and not all of them.
  static constexpr const char *packed_seeds = "packed_seeds";

  core::State tables_;
};

template <int dim>
packings::Seeds<dim> Reference::seeds(const std::function<packings::Seeds<dim>()> &find)
{
  const auto known = tables_.find(packed_seeds);
  if (known != tables_.end())
    return packings::seeds_of<dim>(known->second);
  auto seeds = find();
  tables_[packed_seeds] = packings::table_of(seeds);
  return seeds;
}
} // namespace ligament::program
