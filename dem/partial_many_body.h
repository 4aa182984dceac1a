// A part of the many-body energy: every bond and every volume with a share of its own.
#pragma once

#include "dem/bond.h"
#include "particles/particle_force.h"

namespace ligament::dem
{
/// sum_bonds s_b [1/2 (2G) S/r |Du|^2 + bending] + sum_i s_i 1/2 lambda_i V_i theta_i^2, of intact
/// bonds at any rotation (theory.md eqs. (D5), (D8b)). Plain loops over few particles.
template <int dim>
class PartialManyBody : public particles::PartialForce<dim>
{
public:
  /// A bond between particles of the part, of one material. Volumes with a share need all their
  /// bonds.
  struct SharedBond
  {
    Bond<dim> bond;
    double share;
  };

  /// `share_of_volume` and `lambda_per_volume` (lambda_i / V_i, Pa/m^3) by particle of the part.
  PartialManyBody(std::vector<SharedBond> bonds, std::vector<double> share_of_volume,
                  std::vector<double> lambda_per_volume);

  double compute(particles::Particles<dim> &particles) override;

private:
  std::vector<SharedBond> bonds_;
  std::vector<double> share_, lambda_per_volume_;
  std::vector<double> pressure_; // lambda_i theta_i, Pa
  std::vector<Turn<dim>> turns_;
};
} // namespace ligament::dem
