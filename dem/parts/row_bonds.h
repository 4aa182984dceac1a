// The bonds of lattice rows as part of the force: they are most of it, and come first.
#pragma once

#include "dem/parts/evaluation.h"

namespace ligament::dem
{
/// The verbs of ForcePart, but that pressures come last, on top of the other parts', and forces
/// first: one sweep does both.
template <int dim>
class RowBonds
{
public:
  using Particles = particles::Particles<dim>;

  explicit RowBonds(const BondedBody<dim> &body);

  void add_pressures(const Particles &particles, Evaluation<dim> &evaluation) const;
  /// Adds pressures; overwrites forces and torques, but where there is no lattice.
  void set_forces(Particles &particles, Evaluation<dim> &evaluation) const;
  /// Adds pressures; overwrites energies.
  void set_energies(const Particles &particles, Evaluation<dim> &evaluation,
                    std::vector<double> &energy) const;

  const LatticeConstants<dim> &constants() const { return kernel_.constants(); }

private:
  LatticeKernel<dim> kernel_;
  mutable RowWindow window_; // scratch: nothing in it outlives a call
};
} // namespace ligament::dem
