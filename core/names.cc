#include "core/names.h"

#include "core/check.h"

#include <algorithm>
#include <numeric>

namespace ligament::core
{
Names::Names(std::vector<std::int64_t> names) : names_(std::move(names)), order_(names_.size())
{
  std::iota(order_.begin(), order_.end(), 0);
  if (!std::is_sorted(names_.begin(), names_.end()))
    std::sort(order_.begin(), order_.end(), [&](int a, int b) { return names_[a] < names_[b]; });
  for (const int i : order_)
    sorted_.push_back(names_[i]);
  require(std::adjacent_find(sorted_.begin(), sorted_.end()) == sorted_.end(),
          "two particles or nodes have the same name");
}

int Names::index(std::int64_t name) const
{
  const auto place = std::lower_bound(sorted_.begin(), sorted_.end(), name);
  return place != sorted_.end() && *place == name ? order_[place - sorted_.begin()] : -1;
}
} // namespace ligament::core
