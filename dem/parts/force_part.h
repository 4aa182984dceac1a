// A part of the force on bonded particles: the verbs that all have in common.
#pragma once

#include "dem/parts/evaluation.h"

#include <functional>

namespace ligament::dem
{
/// Called with each particle, lever (m) and force (N) on it.
template <int dim>
using VisitMoment = std::function<void(int, const Vector<dim> &, const Vector<dim> &)>;

/// ManyBodyForce runs its parts in their order: all pressures first, then all forces. A part of
/// which a body has nothing returns at once.
template <int dim>
class ForcePart
{
public:
  using Particles = particles::Particles<dim>;

  virtual ~ForcePart() = default;

  /// Those to whose pressures it adds, in any order.
  virtual std::vector<int> particles() const = 0;

  /// Adds its lambda_i theta_i (Pa) to those of the parts before it.
  virtual void add_pressures(const Particles &, Evaluation<dim> &) const {}

  /// In place of it where a material flows: adds its part of the strains of open cells.
  virtual void add_strains(const Particles &, Evaluation<dim> &) const {}

  /// Adds forces and torques at the pressures of all parts.
  virtual void add_forces(Particles &, Evaluation<dim> &) const {}

  /// The same for one particle, where it acts on a few only, beside the bonds' own elasticity.
  virtual void add_force_on(int, const Particles &, const Evaluation<dim> &, Wrench<dim> &) const {}

  /// Adds to the force of a bond on its first particle, in N, what it exerts beside the bond's own.
  virtual void add_force_of(const Bond<dim> &, const Particles &, Vector<dim> &) const {}

  /// Adds its energy to that of the particles (J), volumes aside, at the pressures of all parts.
  virtual void add_energies(const Particles &, Evaluation<dim> &,
                            std::vector<double> &energy) const = 0;

  /// What acts on particles beside their bonds, at the pressures of all parts.
  virtual void for_each_moment(const Particles &, const Evaluation<dim> &,
                               const VisitMoment<dim> &) const
  {
  }

  /// The bond no longer carries; the body knows already.
  virtual void remove(const BondId &, const Bond<dim> &, const Particles &) {}

  /// See ParticleForce::save and load; the body has lost its broken bonds already.
  virtual void save(core::State &, const core::Names &) const {}
  virtual void load(const core::State &, const core::Names &, const Particles &) {}
};
} // namespace ligament::dem
