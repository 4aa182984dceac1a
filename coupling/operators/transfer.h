// Between particles and nodes: members sorted by cell, arrays apart.
#pragma once

#include "coupling/overlap.h"

namespace ligament::coupling
{
/// Phi and Phi^T over the members of an overlap. "Member" arrays follow the order of cells;
/// particle arrays are those of the zone.
template <int dim>
class Transfer
{
public:
  Transfer(const Overlap<dim> &overlap, const particles::Particles<dim> &particles);

  int size() const { return int(particle_.size()); }
  int particle(int k) const { return particle_[k]; }
  /// kg; 0 for pad members, whose fluctuation is zero.
  double mass(int k) const { return mass_[k]; }
  /// s of the member, see Overlap::position.
  double position(int k) const { return position_[k]; }

  /// Members' values of a field of all particles, and back.
  template <typename Field>
  void read(const Field &field, Components<dim> &members) const
  {
    for (int c = 0; c < dim; ++c)
      for (int k = 0; k < size(); ++k)
        members[c][k] = field[c][particle_[k]];
  }
  template <typename Field>
  void write(const Components<dim> &members, Field &field) const
  {
    for (int c = 0; c < dim; ++c)
      for (int k = 0; k < size(); ++k)
        field[c][particle_[k]] = members[c][k];
  }

  /// nodal += Phi^T M w of the free members.
  void add_momentum(const Components<dim> &w, Nodal<dim> &nodal) const;

  /// w -= Phi nodal for free members.
  void subtract(const Nodal<dim> &nodal, Components<dim> &w) const;

private:
  static constexpr int nc = fem::n_cell_nodes<dim>;
  struct CellGroup
  {
    int begin, end; // members
    std::array<int, nc> nodes;
  };
  std::vector<CellGroup> groups_;
  std::vector<int> particle_;
  std::array<std::vector<double>, nc> value_; // shape functions
  std::vector<double> mass_;                  // kg; 0 for pads
  std::vector<double> free_;                  // 1, or 0 for pads
  std::vector<double> position_;
};
} // namespace ligament::coupling
