// A triangular solve over dense tiles, in the vectors of the machine that runs it.
#pragma once

#include <vector>

namespace ligament::coupling
{
inline constexpr int tile_size = 8;

/// Column by column.
struct alignas(64) Tile
{
  double value[tile_size][tile_size] = {};
};

/// Steps x_k <- D_k (x_k - sum_l T_l x_other(l)) over blocks x_k of `tile_size` unknowns.
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

/// The numbers of one block for one right-hand side; a block's n_columns (1 to 3) stand together.
struct alignas(64) TileVector
{
  double value[tile_size] = {};
};

/// Goes through the steps for n_columns right-hand sides at once.
void sweep_tiles(const TileSweep &sweep, int n_columns, TileVector *x);
} // namespace ligament::coupling
