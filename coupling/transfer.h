// Between particles and nodes, laid out for the time loop: members sorted by cell, arrays apart.
#pragma once

#include "coupling/overlap.h"

namespace ligament::coupling
{
/// dim numbers per near node.
template <int dim>
using Nodal = Eigen::Matrix<double, Eigen::Dynamic, dim, Eigen::RowMajor>;

/// Phi, Phi^T and Psi^T over the members of an overlap. "Member" arrays follow the order of cells;
/// particle arrays are those of the zone.
template <int dim>
class Transfer
{
public:
  Transfer(const Overlap<dim> &overlap, const particles::Particles<dim> &particles);

  int size() const { return int(particle_.size()); }
  int particle(int k) const { return particle_[k]; }
  /// 0 for pad members, whose fluctuation is zero, else the inverse mass in 1/kg.
  double inverse_mass(int k) const { return inverse_mass_[k]; }
  double mass(int k) const { return mass_[k]; }
  /// s of the member, see Overlap::position.
  double position(int k) const { return position_[k]; }

  /// nodal += Phi^T f + Psi_pad^T T of the particles' forces and torques.
  void add_forces(const particles::Particles<dim> &particles, Nodal<dim> &nodal) const;

  /// nodal += Phi^T M w of the free members.
  void add_momentum(const Components<dim> &w, Nodal<dim> &nodal) const;

  /// w -= Phi nodal for free members.
  void subtract(const Nodal<dim> &nodal, Components<dim> &w) const;

  /// v = Phi V + w; pads also turn with the mesh.
  void write_velocities(const Nodal<dim> &nodal, const Components<dim> &w,
                        particles::Particles<dim> &particles) const;

  /// Large rotation: gives pads the orientation of the mesh's motion U (m), theory.md eq. (C15);
  /// from now on they turn with its rate, until the next call.
  void turn_pads(const Nodal<dim> &u, particles::Particles<dim> &particles);

private:
  static constexpr int nc = fem::n_cell_nodes<dim>;
  struct CellGroup
  {
    int begin, end; // members
    std::array<int, nc> nodes;
  };
  struct Pad
  {
    int particle;
    std::array<int, nc> nodes;
    Eigen::Matrix<double, dim, nc> gradient; // of the shape functions, 1/m
    std::array<Eigen::Matrix<double, n_spins<dim>, dim>, nc> spin;
  };

  std::vector<CellGroup> groups_;
  std::vector<int> particle_;
  std::array<std::vector<double>, nc> value_; // shape functions
  std::vector<double> mass_, inverse_mass_;   // kg, 1/kg; 0 for pads
  std::vector<double> free_;                  // 1, or 0 for pads
  std::vector<double> position_;
  std::vector<Pad> pads_;
};
} // namespace ligament::coupling
