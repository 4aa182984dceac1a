// Cells that hold places, for searches within a reach.
#pragma once

#include "md/atom_record.h"

#include <array>
#include <vector>

namespace ligament::md
{
/// Corners of the box around the places, in m.
void find_extent(const std::vector<AtomRecord> &places, std::array<double, 3> &lower,
                 std::array<double, 3> &upper);

/// Cubes of half the reach over all places, or larger ones where these are thinly spread. Places
/// that lie far from most others belong to the cell of the grid that is nearest.
struct CellGrid
{
  std::array<double, 3> lower; // m
  double edge;                 // m
  std::array<int, 3> n;

  CellGrid(const std::vector<AtomRecord> &places, double reach);

  std::array<int, 3> cell_of(const AtomRecord &place) const;
  /// Counts along x first, then y, then z.
  int number(const std::array<int, 3> &cell) const
  {
    return (cell[2] * n[1] + cell[1]) * n[0] + cell[0];
  }
  int n_cells() const { return n[0] * n[1] * n[2]; }

  /// Numbers of the places in the order of their cells, within a cell as they come.
  std::vector<int> order(const std::vector<AtomRecord> &places) const;
};
} // namespace ligament::md
