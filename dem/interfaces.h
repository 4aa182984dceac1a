// Bonds between particles of different materials: both sides of the face carry the same traction.
#pragma once

#include "dem/parts/force_part.h"

namespace ligament::dem
{
/// Every such bond splits Du = d_i + d_j so that both sides have the traction
///   t = 2G_i d_i / q_i + p_i a_i / q_i = 2G_j d_j / q_j - p_j a_j / q_j,   p = lambda theta,
/// and theta_i gets S a_i . d_i / (q_i V_i) (theory.md eqs. (D18), (D19)). This joins the pressures
/// of the particles at interfaces: they solve one sparse, symmetric positive definite system, to
/// round-off, by conjugate gradients. All other bonds of these particles must be in the table.
template <int dim>
class Interfaces : public ForcePart<dim>
{
public:
  using Particles = particles::Particles<dim>;

  explicit Interfaces(const BondNetwork<dim> &bonds);

  bool empty() const { return bonds_.empty(); }
  /// Particles that have or had a bond to another material, ascending.
  const std::vector<int> &members() const { return members_; }
  /// Whether a particle has or had a bond to another material.
  bool is_member(int i) const { return !member_.empty() && member_[i] >= 0; }

  std::vector<int> particles() const override { return members_; }
  /// From those of the members' other bonds and loads to those of all: after all other parts.
  void add_pressures(const Particles &particles, Evaluation<dim> &evaluation) const override;
  /// The way back.
  void take_pressures(const Particles &particles, Evaluation<dim> &evaluation) const;
  void add_forces(Particles &particles, Evaluation<dim> &evaluation) const override;
  void add_energies(const Particles &particles, Evaluation<dim> &evaluation,
                    std::vector<double> &energy) const override;
  void remove(const BondId &id, const Bond<dim> &bond, const Particles &particles) override;

  /// Of the bonds, bending included, and the volumes of the members, in J.
  double energy(const Particles &particles, const Evaluation<dim> &evaluation) const;

private:
  struct IndexedBond
  {
    Bond<dim> bond;
    int index; // in the network's table
  };
  std::vector<IndexedBond> bonds_;
  std::vector<int> members_; // particles
  std::vector<int> member_;  // by particle: place among the members or -1; empty: there are none
};
} // namespace ligament::dem
