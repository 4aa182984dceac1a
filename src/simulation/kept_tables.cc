#include "src/simulation/kept_tables.h"

#include <cmath>
#include <limits>
#include <numeric>

namespace ligament::program
{
namespace
{
/// The fields of a state by the names of their tables.
template <typename State, typename Visit>
void for_each_list(const std::string &name, State &kept, Visit &&visit)
{
  visit(name + "_particles", kept.particles.fields);
  visit(name + "_nodes", kept.cells.node_fields);
  visit(name + "_cells", kept.cells.cell_fields);
}
} // namespace

core::Table numbered_rows(std::size_t n)
{
  std::vector<std::int64_t> numbers(n);
  std::iota(numbers.begin(), numbers.end(), 0);
  return core::Table(std::move(numbers));
}

void add_items(core::Table &table, const std::string &column, int n_components,
               const std::vector<double> &values)
{
  std::vector<double> component(values.size() / n_components);
  for (int c = 0; c < n_components; ++c) {
    for (std::size_t i = 0; i < component.size(); ++i)
      component[i] = values[n_components * i + c];
    table.add(column + "_" + std::to_string(c), component);
  }
}

std::vector<double> items(const core::Table &table, const std::string &column, int n_components)
{
  std::vector<double> values(n_components * table.n_rows());
  for (int c = 0; c < n_components; ++c) {
    const std::vector<double> component = table.reals(column + "_" + std::to_string(c));
    for (std::size_t i = 0; i < component.size(); ++i)
      values[n_components * i + c] = component[i];
  }
  return values;
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

void save_fields(core::State &state, const std::string &name, const BodyState &kept)
{
  core::save_value(state, name, "time", kept.time);
  for_each_list(name, kept, [&](const std::string &table, const std::vector<Field> &fields) {
    if (fields.empty())
      return;
    core::Table rows = numbered_rows(fields[0].values.size() / fields[0].n_components());
    for (const Field &field : fields)
      add_items(rows, field.name, field.n_components(), field.values);
    state.emplace(table, std::move(rows));
  });
}

BodyState load_fields(const core::State &state, const std::string &name, BodyState like)
{
  like.time = core::load_real(state, name, "time");
  for_each_list(name, like, [&](const std::string &table, std::vector<Field> &fields) {
    for (Field &field : fields)
      field.values = items(core::table(state, table), field.name, field.n_components());
  });
  return like;
}
} // namespace ligament::program
