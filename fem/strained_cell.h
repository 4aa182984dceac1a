// A cell under finite strain: its mean deformation by the law of the body, what varies within it
// linearly.
#pragma once

#include "core/hyperelastic_law.h"
#include "fem/body.h"
#include "fem/corotated_cell.h"

namespace ligament::fem
{
/// Mean deformation of a cell, or of a weighted one: gradient = (1/V) int w grad N_a dV in 1/m, V =
/// int w dV in m^3.
template <int dim>
struct CellMean
{
  CellVectors<dim> gradient = CellVectors<dim>::Zero();
  double volume = 0;

  CellMean() = default;
  /// Of a cell of any convex shape; its corners in m, exact.
  CellMean(const CellVectors<dim> &corners, double thickness)
  {
    for (int q = 0; q < n_cell_nodes<dim>; ++q) {
      Vector<dim> s; // Gauss points of the unit cell
      for (int c = 0; c < dim; ++c)
        s[c] = (1 + (q >> c & 1 ? 1 : -1) / std::sqrt(3.)) / 2;
      add(shape_gradients_at<dim>(corners, s),
          cell_jacobian<dim>(corners, s).determinant() * thickness / n_cell_nodes<dim>);
    }
    close();
  }
  /// Of the gradients at a point that stands for so much volume; then close().
  void add(const CellVectors<dim> &gradients, double v)
  {
    gradient += v * gradients;
    volume += v;
  }
  void close()
  {
    if (volume > 0)
      gradient /= volume;
  }
};

/// What a cell's stiffness is beyond that of its mean deformation: 0 for homogeneous motions, never
/// below 0.
template <int dim>
CellMatrix<dim> deviation_stiffness(const CellMatrix<dim> &stiffness, const CellMean<dim> &mean,
                                    const Body<dim> &body)
{
  const auto b = strain_matrix<dim>(mean.gradient);
  CellMatrix<dim> k = stiffness - mean.volume * b.transpose() * body.stiffness * b;
  if (!body.stress.isZero(0))
    k -= stress_stiffness<dim>(mean.gradient, body.stress, mean.volume);
  return k;
}

/// Energy V W(F) + 1/2 u_R . K_d u_R in J, F of the mean, K_d the deviation's stiffness (theory.md
/// eq. (C31)), without the first part unless it is wanted; forces (minus its derivative, in N) into
/// `force`. Displacements u in m.
template <int dim>
double strained_cell(const core::HyperelasticLaw<dim> &law, const CellMean<dim> &mean,
                     const CellMatrix<dim> &deviation, const CellShape<dim> &shape,
                     const CellVectors<dim> &u, CellVectors<dim> &force, bool wants_energy)
{
  double energy = corotated_cell<dim>(deviation, shape, u, force);
  if (mean.volume == 0)
    return energy;
  const Eigen::Matrix<double, dim, dim> h = u * mean.gradient.transpose();
  force -= mean.volume * law.stress(h) * mean.gradient;
  if (wants_energy)
    energy += mean.volume * law.energy_density(h);
  return energy;
}
} // namespace ligament::fem
