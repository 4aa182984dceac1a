#include "src/simulation/kept_tables.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

namespace ligament::program
{
core::Table numbered_rows(std::size_t n)
{
  std::vector<std::int64_t> numbers(n);
  std::iota(numbers.begin(), numbers.end(), 0);
  return core::Table(std::move(numbers));
}

void add_items(core::Table &table, const core::Names &names, const std::string &column,
               int n_components, const std::vector<double> &values)
{
  const std::vector<int> &order = names.ascending();
  std::vector<double> component(order.size());
  for (int c = 0; c < n_components; ++c) {
    bool is_zero = true; // bit by bit
    for (std::size_t k = 0; k < order.size(); ++k) {
      component[k] = values[std::size_t(n_components) * order[k] + c];
      is_zero = is_zero && component[k] == 0 && !std::signbit(component[k]);
    }
    if (!is_zero)
      table.add(column + "_" + std::to_string(c), component);
  }
}

std::vector<double> items(const core::Table &table, const core::Names &names,
                          const std::string &column, int n_components)
{
  std::vector<double> values(std::size_t(n_components) * names.size()), component(names.size());
  for (int c = 0; c < n_components; ++c) {
    const std::string name = column + "_" + std::to_string(c);
    if (!table.has(name))
      continue;
    names.put(table.keys(), table.reals(name), component);
    for (std::size_t i = 0; i < component.size(); ++i)
      values[n_components * i + c] = component[i];
  }
  return values;
}

std::string kept_name(const std::string &kind, double time)
{
  std::uint64_t bits;
  std::memcpy(&bits, &time, sizeof(bits));
  return fmt::format("{}_{:016x}", kind, bits);
}

void save_optional(core::State &state, const std::string &table, const std::string &column,
                   const std::optional<double> &value)
{
  core::save_value(state, table, column, value.value_or(std::numeric_limits<double>::quiet_NaN()));
}

std::optional<double> load_optional(const core::State &state, const std::string &table,
                                    const std::string &column)
{
  const double value = core::load_real(state, table, column);
  return std::isnan(value) ? std::nullopt : std::optional(value);
}

} // namespace ligament::program
