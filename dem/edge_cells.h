// Cells at the coupled edge of a packing: their faces never break, and those that lack faces answer
// as if they had them.
#pragma once

#include "dem/bond.h"
#include "dem/materials.h"
#include "packings/packing.h"
#include "particles/particle_force.h"

namespace ligament::dem
{
/// theory.md eq. (D9c). Forces know nothing of this: on pads they belong to an energy that the
/// coupler subtracts.
template <int dim>
class EdgeCells
{
public:
  EdgeCells() = default; // a packing without such an edge

  /// `weights` of the volumetric energy; empty: all 1.
  EdgeCells(particles::CoupledEdge<dim> edge,
            const std::vector<packings::BoundaryFace<dim>> &boundary_faces,
            const Materials &materials, const particles::Particles<dim> &particles,
            const std::vector<double> &weights);

  bool empty() const { return is_pad_.empty(); }
  bool is_pad(int particle) const { return !is_pad_.empty() && is_pad_[particle]; }
  /// A face of a pad never does.
  bool may_break(const Bond<dim> &bond) const { return !is_pad(bond.i) && !is_pad(bond.j); }

  /// Overwrites lambda_i theta_i (Pa) of the open cells by those of the whole cells in the mesh's
  /// motion. With them the tractions on all faces of pads are right, and with these the averaged
  /// stresses of pads that are not open.
  void complete_pressures(const particles::Particles<dim> &particles,
                          std::vector<double> &pressure) const;

  /// Overwrites the averaged stresses (Pa, Voigt order) of the open cells likewise.
  void complete_stresses(const particles::Particles<dim> &particles,
                         Components<n_strains<dim>> &stress) const;

private:
  using Matrix = Eigen::Matrix<double, dim, dim>;
  struct OpenCell
  {
    int particle;
    Matrix moment; // sum of S A (x) n / V over the faces that carry load, missing ones included
    double shear_modulus, lambda; // Pa
    double weight;
  };

  Matrix strain(const particles::Particles<dim> &particles, int k) const;

  std::vector<char> is_pad_; // of each particle
  std::vector<OpenCell> open_;
  std::function<Matrix(int)> gradient_;
};
} // namespace ligament::dem
