// A triangular solve over dense tiles, in the vectors of the machine that runs it.
#pragma once

#include "coupling/algebra/lane_array.h"

#include <vector>

namespace ligament::coupling
{
/// Column by column.
struct alignas(64) Tile
{
  double value[lane_array_size][lane_array_size] = {};
};

/// Steps x_k <- D_k (x_k - sum_l T_l x_other(l)) over blocks x_k of 8 unknowns.
struct TileSweep
{
  struct Step
  {
    int block;
    int begin, end; // tiles
  };
  std::vector<Step> steps;
  std::vector<int> other;     // block that each tile multiplies
  std::vector<Tile> tiles;    // T, in the order of the steps
  std::vector<Tile> diagonal; // D, one per step
};

/// Goes through the steps for n_columns (1 to 3) right-hand sides at once, whose numbers of one
/// block stand together: x holds n_columns per block.
void sweep_tiles(const TileSweep &sweep, int n_columns, LaneArray *x);
} // namespace ligament::coupling
