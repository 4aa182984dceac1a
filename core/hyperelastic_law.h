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

  /// Overwrites `stress` by P in Pa, the first Piola-Kirchhoff stress; returns the energy density W
  /// in J/m^3, less that at rest. Rotations change neither W nor F^-1 P. Throws core::GuardStop
  /// beyond the deformations that it knows.
  virtual double evaluate(const Matrix &gradient, Matrix &stress) const = 0;
};
} // namespace ligament::core
