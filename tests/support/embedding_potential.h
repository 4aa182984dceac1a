// Energies of bonds and of atoms in the density of their neighbours, as formulas.
#pragma once

#include "core/types.h"

#include <cmath>
#include <functional>
#include <map>
#include <vector>

namespace ligament::tests
{
/// E = sum phi(r) over bonds + sum F(rho) over atoms, rho the sum of f(r):
///   phi = b exp(-p (x - 1)) (x_c - x)^3, f = (x_c - x)^3, F = -sqrt(rho), x = r / rest,
/// with b such that the crystal of spacing `rest` is free of stress. phi and f end with two
/// derivatives at the range.
class EmbeddingPotential
{
public:
  struct Value
  {
    double value, slope, bend;
  };

  /// Of a hexagonal (dim = 2) or FCC crystal of this spacing in m; stressed, as its bonds are
  /// longer by `strain` than they would be at rest. `reach`: x_c. In normal form F' vanishes at the
  /// density of the crystal; the energy is the same but for a constant.
  EmbeddingPotential(int dim, double spacing, double reach, double strain = 0,
                     bool is_normal = true)
      : rest_(spacing / (1 + strain)), reach_(reach)
  {
    double pair_virial = 0, density_virial = 0, rho = 0;
    const auto at_rest = shells(dim);
    for (const auto &[x, n] : at_rest) {
      rho += n * density(x * rest_).value;
      pair_virial += n * x * pair(x * rest_).slope / 2;
      density_virial += n * x * density(x * rest_).slope;
    }
    b_ = -embedding(rho).slope * density_virial / pair_virial;
    if (!is_normal)
      return;
    rho = 0;
    for (const auto &[x, n] : at_rest)
      rho += n * density(x * spacing).value;
    shift_ = embedding(rho).slope;
  }

  double range() const { return reach_ * rest_; }

  Value pair(double r) const
  {
    const double x = r / rest_, y = std::max(reach_ - x, 0.), e = b_ * std::exp(-p_ * (x - 1));
    const Value f = density(r);
    return {e * y * y * y + 2 * shift_ * f.value,
            -e * (p_ * y + 3) * y * y / rest_ + 2 * shift_ * f.slope,
            e * ((p_ * y + 6) * p_ * y + 6) * y / (rest_ * rest_) + 2 * shift_ * f.bend};
  }
  Value density(double r) const
  {
    const double y = std::max(reach_ - r / rest_, 0.);
    return {y * y * y, -3 * y * y / rest_, 6 * y / (rest_ * rest_)};
  }
  Value embedding(double rho) const
  {
    const double root = std::sqrt(rho);
    return {-root - shift_ * rho, -0.5 / root - shift_, 0.25 / (rho * root)};
  }

private:
  /// Distances over the spacing, and how many neighbours are there.
  static std::map<double, int> shells(int dim)
  {
    if (dim == 2)
      return {{1, 6}, {std::sqrt(3.), 6}, {2, 6}, {std::sqrt(7.), 12}};
    return {{1, 12}, {std::sqrt(2.), 6}, {std::sqrt(3.), 24}, {2, 12}};
  }

  static constexpr double p_ = 4;
  double rest_, reach_; // m, of rest_
  double b_ = 1, shift_ = 0;
};
} // namespace ligament::tests
