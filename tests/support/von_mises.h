// A toy law of plastic flow: von Mises with linear isotropic hardening, returned radially.
#pragma once

#include "dem/yield_law.h"

#include <cmath>

namespace ligament::tests
{
inline double mises_stress(const dem::Tensor &t)
{
  const double mean = (t[0] + t[1] + t[2]) / 3;
  double sum = 0;
  for (int c = 0; c < 3; ++c)
    sum += (t[c] - mean) * (t[c] - mean) + 2 * t[c + 3] * t[c + 3];
  return std::sqrt(1.5 * sum);
}

/// Its history is the accumulated plastic strain.
class VonMises : public dem::YieldLaw
{
public:
  /// Pa
  VonMises(double shear_modulus, double yield_stress, double hardening)
      : shear_modulus_(shear_modulus), yield_stress_(yield_stress), hardening_(hardening)
  {
  }

  /// The equivalent stress of sym(a (x) f) is at most |a||f|.
  double elastic_limit() const override { return yield_stress_; }

  void flow(int n, const dem::Tensor *stress, double *history,
            dem::Tensor *increment) const override
  {
    for (int i = 0; i < n; ++i) {
      increment[i].setZero();
      const double equivalent = mises_stress(stress[i]),
                   excess = equivalent - yield_stress_ - hardening_ * history[i];
      if (excess <= 0)
        continue;
      const double strain = excess / (3 * shear_modulus_ + hardening_);
      const double mean = stress[i].head<3>().sum() / 3;
      dem::Tensor deviator = stress[i];
      deviator.head<3>().array() -= mean;
      increment[i] = 1.5 * strain / equivalent * deviator;
      history[i] += strain;
    }
  }

private:
  double shear_modulus_, yield_stress_, hardening_;
};
} // namespace ligament::tests
