// What the near cells alone have of stiffness, mass and strain: their share of the body.
#pragma once

#include "coupling/overlap.h"
#include "fem/strained_cell.h"

#include <Eigen/SparseCore>

namespace ligament::coupling
{
/// Stiffness in N/m of a near cell with its share of the energy: 1 - a in the overlap, else whole.
template <int dim>
fem::CellMatrix<dim> blended_cell_stiffness(const Overlap<dim> &overlap,
                                            const typename Overlap<dim>::Cell &cell,
                                            const fem::Body<dim> &body);

/// Consistent mass in kg of a near cell with its share of the energy, between its nodes.
template <int dim>
Eigen::Matrix<double, fem::n_cell_nodes<dim>, fem::n_cell_nodes<dim>>
blended_cell_mass(const Overlap<dim> &overlap, const typename Overlap<dim>::Cell &cell,
                  const fem::Body<dim> &body);

/// Mean deformation of a near cell, weighted as its energy.
template <int dim>
fem::CellMean<dim> blended_cell_mean(const Overlap<dim> &overlap,
                                     const typename Overlap<dim>::Cell &cell,
                                     const fem::Body<dim> &body);

/// Change of the coarse stiffness in N/m where the near cells are alone, in the transition and
/// beyond the particles that have a motion of their own, when one body takes the place of another.
template <int dim>
Eigen::SparseMatrix<double> change_of_cells_alone(const Overlap<dim> &overlap,
                                                  const fem::Body<dim> &from,
                                                  const fem::Body<dim> &to);
} // namespace ligament::coupling
