// Sides of cells under a pressure that follows them.
#pragma once

#include "core/part.h"
#include "fem/mesh.h"

#include <vector>

namespace ligament::fem
{
/// The pressed part of a side of a cell, through its corners: a segment in 2D, in 3D the area
/// vector of the bilinear face. Area vectors of a closed surface add up to nothing, and in 2D so do
/// the moments of what half of each does at either end (theory.md section 8).
template <int dim>
class PressedFace
{
public:
  static constexpr int n_corners = n_cell_nodes<dim> / 2;

  /// Part: of the face that is pressed. `thickness` in m, 1 in 3D.
  PressedFace(const Mesh<dim> &mesh, const CellFace<dim> &face, const core::Part<dim> &part,
              double thickness, int load);

  /// Number in the list of loads.
  int load() const { return load_; }
  const std::array<int, n_corners> &nodes() const { return nodes_; }
  /// Of the face's area, what the pressure at the corner acts on; nothing is pressed where all are
  /// 0.
  const std::array<double, n_corners> &shares() const { return shares_; }
  /// Outward, in m^2, where the nodes are displaced by so much.
  Vector<dim> area(const Mesh<dim> &mesh, const Components<dim> &displacement) const;

private:
  Vector<dim> area_between(const std::array<Vector<dim>, n_corners> &corners) const;

  int load_;
  std::array<int, n_corners> nodes_; // as in the cell: lexicographic
  std::array<double, n_corners> shares_;
  double factor_; // thickness, negative where the corners run the other way about
};
} // namespace ligament::fem
