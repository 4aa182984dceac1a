// The coarse stiffness and mass of the overlap and its transition, and the residual that the patch
// fit has to remove.
#pragma once

#include "coupling/operators/interpolated_motion.h"
#include "fem/fem_solver.h"

#include <Eigen/SparseCore>

namespace ligament::coupling
{
/// Matrices on near nodes. Vector unknowns are numbered component by component: c * n_nodes + node,
/// so that a column-major n_nodes x dim matrix of nodal values is the vector.
template <int dim>
struct BlendedOperators
{
  /// Coarse stiffness without the patch fit, N/m (theory.md eq. (C3)): cells weighted by 1 - a
  /// minus the discrete energy weighted by 1 - a, evaluated on the interpolated motion; transition
  /// cells whole.
  Eigen::SparseMatrix<double> stiffness;
  /// Scalar coarse mass of the near cells and of the particles' share, kg; without the lumped mass
  /// of cells that stay with the far-field solver.
  Eigen::SparseMatrix<double> mass;
  /// Per near node a lower bound of `mass` in the sense of quadratic forms, kg: consistent masses
  /// count 1/3^dim of their row sum, less in cells with hanging corners. Keeps the gap filter below
  /// the mass (theory.md, "Dampers").
  Eigen::VectorXd mass_bound;
  /// Force on the near nodes under each unit strain, spins at rest, N; one column per strain. Under
  /// each unit gradient where bonds bear forces in the reference.
  Eigen::MatrixXd residual;
  /// g = Phi^T f(X): what these forces leave at the near nodes, N (theory.md eq. (C26)); empty: no
  /// bond bears any.
  Nodal<dim> dead_load;
  /// Of find_free_normals.
  std::vector<std::vector<Vector<dim>>> free_normals;
};

/// `coarse_mass` multiplies the particles' share of the mass; the cells have the density of `body`.
template <int dim>
BlendedOperators<dim> make_blended_operators(const Overlap<dim> &overlap,
                                             const particles::Particles<dim> &particles,
                                             const particles::ParticleForce<dim> &force,
                                             const fem::Body<dim> &body, double coarse_mass = 1);

/// The cells' part alone: stiffness weighted by 1 - a, without the subtracted terms, and mass,
/// without the particles' share. Residual, mass bound and normals stay empty. Throws
/// core::InputError where the overlap reaches a loaded or held side.
template <int dim>
BlendedOperators<dim>
make_cell_operators(const Overlap<dim> &overlap, const particles::Particles<dim> &particles,
                    const particles::ParticleForce<dim> &force, const fem::Body<dim> &body);

/// Releases the overlap's and the transition's cells from the far field; what mass its own cells
/// still have at near nodes comes back, in kg. Throws core::InputError where a near node is held.
template <int dim>
Eigen::SparseMatrix<double> take_over_cells(const Overlap<dim> &overlap, fem::FemSolver<dim> &far);

/// Displacement gradient of unit strain k in Voigt order (engineering shear 1: symmetric halves).
template <int dim>
Eigen::Matrix<double, dim, dim> unit_strain(int k);

/// Displacement gradient k of `n_states`: the unit strains, or where there are dim^2 the unit
/// gradients, row by row.
template <int dim>
Eigen::Matrix<double, dim, dim> unit_gradient(int k, int n_states);
} // namespace ligament::coupling
