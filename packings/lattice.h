// The infinite lattice: where its points are, who neighbours whom, and its whole cell.
#pragma once

#include "packings/lattice_packing.h"

#include <cstdint>

namespace ligament::packings
{
/// Number of a lattice point along the basis vectors; the first runs along the close-packed rows.
template <int dim>
using LatticeIndex = Eigen::Matrix<int, dim, 1>;

template <int dim>
struct LatticeNeighbour
{
  LatticeIndex<dim> offset;
  Vector<dim> direction; // unit
  double distance;       // m
};

template <int dim>
class Lattice
{
public:
  explicit Lattice(const LatticeParameters<dim> &parameters);

  Vector<dim> position(const LatticeIndex<dim> &k) const
  {
    Vector<dim> x = centre_;
    for (int a = 0; a < dim; ++a)
      x += basis_.col(a) * (k[a] + shift_[a]);
    return x;
  }

  /// The real coordinates k with position(k) = x.
  Vector<dim> coordinates(const Vector<dim> &x) const { return inverse_ * (x - centre_) - shift_; }

  /// From a point to another, in m.
  Vector<dim> step(const LatticeIndex<dim> &k) const { return basis_ * k.template cast<double>(); }

  /// A number, not negative and below 2^53, that is unique and grows along rows, then layers.
  /// Components lie within +-2^16 (3D) or +-2^25 (2D), else throws core::InputError.
  static std::int64_t global_id(const LatticeIndex<dim> &k);

  double spacing;     // m
  double cell_volume; // m^dim, without thickness
  double face_area;   // m^(dim-1)
  double cell_radius; // m, from the centre to the farthest corner of the cell
  Vector<dim> extent; // m, half the size of the cell along the axes
  std::vector<LatticeNeighbour<dim>> forward;   // half of the neighbours
  std::vector<LatticeNeighbour<dim>> reachable; // all points within 6 d, nearest first

private:
  Vector<dim> centre_, shift_;
  Eigen::Matrix<double, dim, dim> basis_, inverse_;
};
} // namespace ligament::packings
