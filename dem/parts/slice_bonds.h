// Bonds of one material that no lattice row holds, as part of the force.
#pragma once

#include "dem/parts/force_part.h"

namespace ligament::dem
{
template <int dim>
class SliceBonds : public ForcePart<dim>
{
public:
  using Particles = particles::Particles<dim>;

  explicit SliceBonds(const BondedBody<dim> &body);

  std::vector<int> particles() const override { return slices_.particles(); }
  void add_pressures(const Particles &particles, Evaluation<dim> &evaluation) const override;
  void add_strains(const Particles &particles, Evaluation<dim> &evaluation) const override;
  /// After those of rows; overwrites where there is no lattice.
  void add_forces(Particles &particles, Evaluation<dim> &evaluation) const override;
  void add_energies(const Particles &particles, Evaluation<dim> &evaluation,
                    std::vector<double> &energy) const override;
  void remove(const BondId &id, const Bond<dim> &bond, const Particles &particles) override;

private:
  const SliceNearness *awake_slices(const Particles &particles, Evaluation<dim> &evaluation) const;

  BondSlices<dim> slices_;
  mutable core::LargeArray records_; // scratch: from the pressures to the forces or energies
};
} // namespace ligament::dem
