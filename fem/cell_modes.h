// Strain modes that a cell has to itself, for those who integrate its energy with weights of their
// own.
#pragma once

#include "fem/mesh.h"

namespace ligament::fem
{
/// Strains G of a cell's own modes at s in [-1, 1]^dim (theory.md eq. (F8)): what the corners'
/// motion leaves out of a bending cell, and in 3D what it needs to keep its volume at every Gauss
/// point.
template <int dim>
Eigen::Matrix<double, n_strains<dim>, n_cell_modes<dim>> mode_strains(const Vector<dim> &s);
} // namespace ligament::fem
