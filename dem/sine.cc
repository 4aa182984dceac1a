#include "dem/dispatch.h"
#include "dem/lattice_kernel.h"

#include <cstring>

namespace ligament::dem
{
namespace
{
/// Reduction by quarter turns (Cody and Waite), then Taylor series on [-pi/4, pi/4]: the first
/// terms left out are below 1e-19.
LIGAMENT_INLINE void one_angle(double x, double &cosine_minus_1, double &sine)
{
  constexpr double round = 6755399441055744.; // 1.5 * 2^52: adding it rounds to an integer
  constexpr double p1 = 1.57079632673412561417, p2 = 6.07710050630396597660e-11,
                   p3 = 2.02226624879595063154e-21; // pi/2 in parts of 33 bits
  const double shifted = x * (2 / M_PI) + round, k = shifted - round;
  std::int64_t bits;
  std::memcpy(&bits, &shifted, sizeof bits);
  const double r = ((x - k * p1) - k * p2) - k * p3, z = r * r;
  double s = 1. / 355687428096000.;
  s = s * z - 1. / 1307674368000.;
  s = s * z + 1. / 6227020800.;
  s = s * z - 1. / 39916800.;
  s = s * z + 1. / 362880.;
  s = s * z - 1. / 5040.;
  s = s * z + 1. / 120.;
  s = s * z - 1. / 6.;
  s = r + r * z * s;
  double c = 1. / 20922789888000.;
  c = c * z - 1. / 87178291200.;
  c = c * z + 1. / 479001600.;
  c = c * z - 1. / 3628800.;
  c = c * z + 1. / 40320.;
  c = c * z - 1. / 720.;
  c = c * z + 1. / 24.;
  c = c * z - 0.5;
  c = c * z; // cos(r) - 1
  const std::int64_t quarter = bits & 3;
  const double c1 = c + 1;
  cosine_minus_1 = quarter == 0 ? c : quarter == 1 ? -s - 1 : quarter == 2 ? -c1 - 1 : s - 1;
  sine = quarter == 0 ? s : quarter == 1 ? c1 : quarter == 2 ? -s : -c1;
}
} // namespace

LIGAMENT_DISPATCH
void cosine_minus_1_and_sine(const double *__restrict angle, double *__restrict cosine_minus_1,
                             double *__restrict sine, int n)
{
  for (int i = 0; i < n; ++i)
    one_angle(angle[i], cosine_minus_1[i], sine[i]);
}
} // namespace ligament::dem
