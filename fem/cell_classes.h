// Cells that are equal up to a translation, found among many.
#pragma once

#include "fem/mesh.h"

#include <cstdint>
#include <map>

namespace ligament::fem
{
template <int dim>
class CellClasses
{
public:
  /// Number of the class of a cell with these corners (m), in the order of their first cells: whose
  /// edges agree within 1e-12 of its extent. Equal cells on either side of a limit of round-off may
  /// get two classes; different ones never share one.
  int number(const CellVectors<dim> &corners);

  int size() const { return int(shapes_.size()); }

private:
  using Key = std::array<std::int64_t, dim * n_cell_nodes<dim> + 1>;

  std::vector<CellVectors<dim>> shapes_; // m, corners from the first one
  std::map<Key, std::vector<int>> near_; // classes whose rounded shape is the same
};
} // namespace ligament::fem
