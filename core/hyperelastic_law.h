// A continuum under finite strain, whose stress follows from an energy.
#pragma once

#include "core/types.h"

namespace ligament::core
{
/// Of homogeneous deformations F = 1 + gradient, the gradient that of the displacement.
template <int dim>
class HyperelasticLaw
{
public:
  using Matrix = Eigen::Matrix<double, dim, dim>;

  virtual ~HyperelasticLaw() = default;

  /// W in J/m^3, less that at rest. Both throw core::GuardStop beyond the deformations that they
  /// know.
  virtual double energy_density(const Matrix &gradient) const = 0;
  /// P in Pa, the first Piola-Kirchhoff stress. Rotations change neither W nor F^-1 P.
  virtual Matrix stress(const Matrix &gradient) const = 0;
};
} // namespace ligament::core
