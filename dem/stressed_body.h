// A body in a state, bond by bond: for all that is asked of few bonds, and for output.
#pragma once

#include "dem/parts/inelastic_strains.h"

namespace ligament::dem
{
template <int dim>
struct StressedBody
{
  using Particles = particles::Particles<dim>;

  const Particles &particles;
  const Evaluation<dim> &evaluation; // with the pressures of all parts
  const InelasticStrains<dim> &strains;
  const std::vector<ForcePart<dim> *> &parts;

  const BondedBody<dim> &body() const { return evaluation.body; }

  BondMotion<dim> motion(const Bond<dim> &bond, const Turn<dim> &turn_i,
                         const Turn<dim> &turn_j) const
  {
    return strains.motion(bond, particles, turn_i, turn_j);
  }
  BondMotion<dim> motion(const Bond<dim> &bond) const
  {
    return motion(bond, Turn<dim>::of(particles, bond.i), Turn<dim>::of(particles, bond.j));
  }
  /// On i, in N.
  Vector<dim> force(const Bond<dim> &bond, const BondMotion<dim> &motion) const;

  /// The same with what parts change in it.
  Vector<dim> whole_force(const Bond<dim> &bond) const
  {
    Vector<dim> sum = force(bond, motion(bond));
    for (const auto *part : parts)
      part->add_force_of(bond, particles, sum);
    return sum;
  }

  /// What all parts but contacts exert on a particle.
  Wrench<dim> wrench_on(int i) const;

  /// Averaged stresses in Pa (Voigt order), theory.md eq. (D10); of the body before its energy was
  /// weighted. Of all particles, cells that lack faces completed; and of these, ascending, as their
  /// bonds make them.
  void find_stresses(Components<n_strains<dim>> &stress) const;
  std::vector<Strain<dim>> stresses_of(const std::vector<int> &few) const;

  /// Largest tension on a face in Pa over the bonds of these particles; 0 when there is none.
  double max_tension(const std::vector<int> &of) const;
};
} // namespace ligament::dem
