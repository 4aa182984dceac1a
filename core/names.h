// Names of particles and nodes that outlive every numbering: from an index to its name and back.
#pragma once

#include "core/state.h"

#include <array>

namespace ligament::core
{
class Names
{
public:
  Names() = default;
  /// The name of every index; no two are equal (core::InputError else).
  explicit Names(std::vector<std::int64_t> names);

  int size() const { return int(names_.size()); }
  std::int64_t name(int index) const { return names_[index]; }
  /// -1 for a stranger.
  int index(std::int64_t name) const;
  /// All indices in the order of their names, and these names.
  const std::vector<int> &ascending() const { return order_; }
  const std::vector<std::int64_t> &sorted() const { return sorted_; }

  /// Values in the order of the names; and the other way round, where `keys` are the names of
  /// `from`: values of strangers are passed over, indices without a row keep theirs.
  template <typename T, typename U>
  std::vector<T> sort(const std::vector<U> &values) const;
  template <typename T, typename U>
  void put(const std::vector<std::int64_t> &keys, const std::vector<T> &from,
           std::vector<U> &values) const;

  /// A table of fields of all that have names, one column per component: <column>_0, _1, ...
  template <std::size_t n>
  void save(Table &table, const std::string &column,
            const std::array<std::vector<double>, n> &values) const
  {
    for (std::size_t c = 0; c < n; ++c)
      table.add(column + "_" + std::to_string(c), sort<double>(values[c]));
  }
  template <std::size_t n>
  void load(const Table &table, const std::string &column,
            std::array<std::vector<double>, n> &values) const
  {
    for (std::size_t c = 0; c < n; ++c)
      put(table.keys(), table.reals(column + "_" + std::to_string(c)), values[c]);
  }

private:
  std::vector<std::int64_t> names_, sorted_;
  std::vector<int> order_;
};

template <typename T, typename U>
std::vector<T> Names::sort(const std::vector<U> &values) const
{
  std::vector<T> sorted(order_.size());
  for (std::size_t k = 0; k < order_.size(); ++k)
    sorted[k] = T(values[order_[k]]);
  return sorted;
}

template <typename T, typename U>
void Names::put(const std::vector<std::int64_t> &keys, const std::vector<T> &from,
                std::vector<U> &values) const
{
  std::size_t mine = 0;
  for (std::size_t k = 0; k < keys.size(); ++k) { // both ascend
    while (mine < sorted_.size() && sorted_[mine] < keys[k])
      ++mine;
    if (mine < sorted_.size() && sorted_[mine] == keys[k])
      values[order_[mine]] = U(from[k]);
  }
}
} // namespace ligament::core
