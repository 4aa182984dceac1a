// Far fields whose cells change their size inside the overlap.
#pragma once

#include "src/scene/scene.h"

namespace ligament::program
{
/// Keys of /far_field; by default all cells are equal.
struct Grading
{
  int levels = 0;
  int fine_cells = 0;
  double growth = 1;

  void apply(Scene &scene) const
  {
    scene.far_field->levels = levels;
    scene.far_field->fine_cells = fine_cells;
    scene.far_field->growth = growth;
  }
};

/// For overlaps of four cells: doubled by hanging nodes, or growing.
inline constexpr Grading hanging_cells = {1, 1, 1}, growing_cells = {2, 1, 1.2};
} // namespace ligament::program
