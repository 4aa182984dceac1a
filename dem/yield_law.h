// What a law of plastic flow answers: from the stress of a particle to its plastic strain.
#pragma once

#include "core/types.h"

namespace ligament::dem
{
/// xx, yy, zz, yz, xz, xy of a symmetric tensor, without engineering factors, in the axes of the
/// particle's reference; in 2D yz and xz are 0.
using Tensor = Vec<6>;

class YieldLaw
{
public:
  virtual ~YieldLaw() = default;

  /// In Pa. Nothing yields, whatever its history, under a stress that is a sum of sym(a (x) f)
  /// with a sum of |a||f| below it (theory.md section 1.10).
  virtual double elastic_limit() const = 0;

  /// The flow of n particles side by side under `stress` (Pa): overwrites `increment`, what their
  /// plastic strains grow by, with zeros where nothing yields. `history` has one number per
  /// particle, 0 at first, which is the law's own.
  virtual void flow(int n, const Tensor *stress, double *history, Tensor *increment) const = 0;
};
} // namespace ligament::dem
