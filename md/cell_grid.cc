#include "md/cell_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

CellGrid::CellGrid(const std::vector<AtomRecord> &places, double reach) : edge(reach / 2)
{
  std::array<double, 3> upper;
  find_extent(places, lower, upper);
  const auto n_along = [&](int c) { return std::floor((upper[c] - lower[c]) / edge) + 1; };
  // A few cells per place at most.
  while (n_along(0) * n_along(1) * n_along(2) > 8. * double(places.size()) + 64)
    edge *= 1.26;
  for (int c = 0; c < 3; ++c)
    n[c] = int(n_along(c));
}

std::array<int, 3> CellGrid::cell_of(const AtomRecord &place) const
{
  std::array<int, 3> cell;
  for (int c = 0; c < 3; ++c)
    cell[c] = std::clamp(int((component(place)[c] - lower[c]) / edge), 0, n[c] - 1);
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
