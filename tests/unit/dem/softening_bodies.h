// Bodies on which softening faces are tested: a column of two cells, the same body in another
// order.
#pragma once

#include "tests/unit/dem/body.h"

#include <gtest/gtest.h>

namespace ligament::dem::testing
{
/// The ends of the second axis move apart by so many m/s in all, after a smooth start.
template <int dim>
std::vector<core::BoundaryLoad<dim>> draw_apart(double speed, double start)
{
  std::vector<core::BoundaryLoad<dim>> loads(2);
  for (int end = 0; end < 2; ++end) {
    loads[end].boundary = 2 + end;
    loads[end].value[1] = (end ? 0.5 : -0.5) * speed;
    loads[end].history = core::Ramp{start};
  }
  return loads;
}

/// Two cubes or squares, one above the other, held across at their ends only.
template <int dim>
packings::Packing<dim> column()
{
  Packing<dim> p;
  const double d = p.spacing = 0.01;
  p.thickness = dim == 2 ? 0.3 : 1;
  for (int c = 0; c < dim; ++c)
    p.centre[c] = {0, c == 1 ? d : 0};
  p.volume.assign(2, std::pow(d, dim) * p.thickness);
  p.global_id = {0, 1};
  const double area = std::pow(d, dim - 1) * p.thickness;
  const Vector<dim> up = d / 2 * Vector<dim>::Unit(1);
  p.faces.push_back({0, 1, Vector<dim>::Unit(1), area, d / 2, d / 2, up, -up, -1, false});
  for (int i = 0; i < 2; ++i)
    for (int c = 0; c < dim; ++c)
      for (int end = 0; end < 2; ++end)
        if (const Vector<dim> n = (end ? 1 : -1) * Vector<dim>::Unit(c); c != 1 || end == i)
          p.boundary_faces.push_back({i, n, area, d / 2, d / 2 * n, 2 * c + end});
  return p;
}

/// The same packing with its particles in another order.
template <int dim>
Packing<dim> renumbered(const Packing<dim> &p, const std::vector<int> &place)
{
  Packing<dim> q = p;
  q.global_id.resize(p.size());
  for (int i = 0; i < p.size(); ++i) {
    for (int c = 0; c < dim; ++c)
      q.centre[c][place[i]] = p.centre[c][i];
    q.volume[place[i]] = p.volume[i];
    q.global_id[place[i]] = i;
  }
  for (auto &f : q.faces) {
    f.i = place[f.i], f.j = place[f.j];
    f.direction = -1;
    if (f.i < f.j)
      continue;
    std::swap(f.i, f.j);
    std::swap(f.q_i, f.q_j);
    std::swap(f.lever_i, f.lever_j);
    f.normal = -f.normal;
  }
  std::reverse(q.faces.begin(), q.faces.end());
  q.boundary_faces.clear();
  q.directions.clear();
  return q;
}

/// All numbers of a state, by name.
inline std::vector<double> all_numbers(const core::State &state)
{
  std::vector<double> numbers;
  for (const auto &[name, table] : state)
    for (const std::string &column : table.columns())
      for (const double x : table.reals(column))
        numbers.push_back(x);
  return numbers;
}

/// To the bit, but for the payloads of what is no number.
inline void expect_same_numbers(const core::State &left, const core::State &right)
{
  const auto a = all_numbers(left), b = all_numbers(right);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k)
    ASSERT_TRUE(a[k] == b[k] || (std::isnan(a[k]) && std::isnan(b[k])));
}
} // namespace ligament::dem::testing
