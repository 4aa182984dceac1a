#include "packings/packing_state.h"

#include <numeric>

namespace ligament::packings
{
namespace
{
std::string component(int c)
{
  return "centre_" + std::to_string(c);
}
} // namespace

template <int dim>
core::Table table_of(const Seeds<dim> &seeds)
{
  std::vector<std::int64_t> rows(seeds.centre.size());
  std::iota(rows.begin(), rows.end(), 0);
  core::Table table(std::move(rows));
  for (int c = 0; c < dim; ++c) {
    std::vector<double> values;
    values.reserve(seeds.centre.size());
    for (const Vector<dim> &x : seeds.centre)
      values.push_back(x[c]);
    table.add(component(c), values);
  }
  table.add("radius", seeds.radius);
  table.add("id", seeds.id);
  if (!seeds.material.empty())
    table.add("material", std::vector<std::int64_t>(seeds.material.begin(), seeds.material.end()));
  return table;
}

template <int dim>
Seeds<dim> seeds_of(const core::Table &table)
{
  Seeds<dim> seeds;
  seeds.centre.resize(table.n_rows());
  for (int c = 0; c < dim; ++c) {
    const std::vector<double> values = table.reals(component(c));
    for (std::size_t k = 0; k < values.size(); ++k)
      seeds.centre[k][c] = values[k];
  }
  seeds.radius = table.reals("radius");
  seeds.id = table.integers("id");
  if (table.has("material"))
    for (const std::int64_t material : table.integers("material"))
      seeds.material.push_back(int(material));
  return seeds;
}

template core::Table table_of(const Seeds<2> &);
template core::Table table_of(const Seeds<3> &);
template Seeds<2> seeds_of(const core::Table &);
template Seeds<3> seeds_of(const core::Table &);
} // namespace ligament::packings
