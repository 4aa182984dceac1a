#include "md/cell_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace ligament::md
{
void find_extent(const std::vector<AtomRecord> &places, std::array<double, 3> &lower,
                 std::array<double, 3> &upper)
{
  lower.fill(std::numeric_limits<double>::infinity());
  upper.fill(-std::numeric_limits<double>::infinity());
  for (const AtomRecord &place : places)
    for (int c = 0; c < 3; ++c) {
      lower[c] = std::min(lower[c], component(place)[c]);
      upper[c] = std::max(upper[c], component(place)[c]);
    }
}

namespace
{
/// Between which all but the outermost places of either side lie, and as much again around them.
std::pair<double, double> extent_of_most(const std::vector<AtomRecord> &places, int c)
{
  std::vector<double> x;
  for (const AtomRecord &place : places)
    x.push_back(component(place)[c]);
  const auto n_outer = std::ptrdiff_t(x.size() / 64);
  const auto low = x.begin() + n_outer, high = x.end() - 1 - n_outer;
  std::nth_element(x.begin(), low, x.end());
  const double first = *low;
  std::nth_element(x.begin(), high, x.end());
  const double way = *high - first;
  return {first - way, *high + way};
}
} // namespace

CellGrid::CellGrid(const std::vector<AtomRecord> &places, double reach) : edge(reach / 2)
{
  std::array<double, 3> upper;
  find_extent(places, lower, upper);
  const auto n_along = [&](int c) { return std::floor((upper[c] - lower[c]) / edge) + 1; };
  const auto n_of_all = [&] { return n_along(0) * n_along(1) * n_along(2); };
  const double most = 8. * double(places.size()) + 64; // a few cells per place
  // Few that have flown far away lie in the outermost cells: the others shall not share one.
  if (n_of_all() > most)
    for (int c = 0; c < 3; ++c) {
      const auto [first, last] = extent_of_most(places, c);
      lower[c] = std::max(lower[c], first - reach);
      upper[c] = std::min(upper[c], last + reach);
    }
  while (n_of_all() > most)
    edge *= 1.26;
  for (int c = 0; c < 3; ++c)
    n[c] = int(n_along(c));
}

std::array<int, 3> CellGrid::cell_of(const AtomRecord &place) const
{
  std::array<int, 3> cell;
  for (int c = 0; c < 3; ++c)
    cell[c] = int(std::clamp((component(place)[c] - lower[c]) / edge, 0., n[c] - 1.));
  return cell;
}

std::vector<int> CellGrid::order(const std::vector<AtomRecord> &places) const
{
  std::vector<int> cells, next(n_cells() + 1, 0), order(places.size());
  for (const AtomRecord &place : places) {
    cells.push_back(number(cell_of(place)));
    ++next[cells.back() + 1];
  }
  for (int c = 0; c < n_cells(); ++c)
    next[c + 1] += next[c];
  for (std::size_t i = 0; i < places.size(); ++i)
    order[next[cells[i]]++] = int(i);
  return order;
}
} // namespace ligament::md
