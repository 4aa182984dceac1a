// The lattice bonds of blocks with plastic strains, vectorised along rows.
#pragma once

#include "dem/lattice_kernel.h"

namespace ligament::dem
{
/// What one sweep over a block reads and writes; passed through the run-time dispatch. Streams of
/// `turned` lie `stride` apart, those of `sums` TractionScreen::block, from the block's first
/// particle on.
template <int dim>
struct PlasticRows
{
  enum class Sums
  {
    forces, // force and torque that plastic strains add, theory.md eq. (D21), and half their energy
    stresses // sum of f (x) a, f the whole force of a bond
  };
  static constexpr int n_turned = 2 * dim * dim; // R - I and R ep, row by row
  static constexpr int n_forces = n_particle_dofs<dim> + 1, n_stresses = dim * dim;

  LatticeArrays<dim> arrays; // displacement, rotation, mask, pressure
  LatticeConstants<dim> constants;
  const std::vector<RowSegment> *segments;
  std::array<const double *, 6> strain; // as in Tensor
  double *turned;
  long stride;
  double *sums = nullptr;
};

/// Fills `turned` of a block.
void turn_plastic(const PlasticRows<2> &rows, const RowRange &block);
void turn_plastic(const PlasticRows<3> &rows, const RowRange &block);
/// Overwrites the sums of a block; `turned` is that of the block and its neighbours.
void sum_plastic(const PlasticRows<2> &rows, const RowRange &block, PlasticRows<2>::Sums what);
void sum_plastic(const PlasticRows<3> &rows, const RowRange &block, PlasticRows<3>::Sums what);
} // namespace ligament::dem
