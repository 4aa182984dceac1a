// cos - 1 and sin of vectors of angles, compiled once for every instruction set.
#if defined(LIGAMENT_DEM_SINE_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LIGAMENT_DEM_SINE_H
#undef LIGAMENT_DEM_SINE_H
#else
#define LIGAMENT_DEM_SINE_H
#endif

#include <hwy/highway.h>

#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

template <typename D>
HWY_INLINE hn::Vec<D> polynomial(D d, hn::Vec<D> z, std::initializer_list<double> coefficients)
{
  auto sum = hn::Zero(d);
  for (const double c : coefficients)
    sum = hn::MulAdd(sum, z, hn::Set(d, c));
  return sum;
}

/// To round-off for any angle below 1e5. Reduction by quarter turns (Cody and Waite), then Taylor
/// series on [-pi/4, pi/4]: the first terms left out are below 1e-19.
template <typename D>
HWY_INLINE void cosine_minus_1_and_sine(D d, hn::Vec<D> x, hn::Vec<D> &cosine_minus_1,
                                        hn::Vec<D> &sine)
{
  constexpr double round = 6755399441055744.; // 1.5 * 2^52: adding it rounds to an integer
  constexpr double p1 = 1.57079632673412561417, p2 = 6.07710050630396597660e-11,
                   p3 = 2.02226624879595063154e-21; // pi/2 in parts of 33 bits
  const auto shifted = hn::MulAdd(x, hn::Set(d, 2 / M_PI), hn::Set(d, round));
  const auto k = hn::Sub(shifted, hn::Set(d, round));
  const auto r = hn::NegMulAdd(
      k, hn::Set(d, p3), hn::NegMulAdd(k, hn::Set(d, p2), hn::NegMulAdd(k, hn::Set(d, p1), x)));
  const auto z = hn::Mul(r, r);
  auto s = polynomial(d, z,
                      {1. / 355687428096000., -1. / 1307674368000., 1. / 6227020800.,
                       -1. / 39916800., 1. / 362880., -1. / 5040., 1. / 120., -1. / 6.});
  s = hn::MulAdd(hn::Mul(r, z), s, r);
  auto c = polynomial(d, z,
                      {1. / 20922789888000., -1. / 87178291200., 1. / 479001600., -1. / 3628800.,
                       1. / 40320., -1. / 720., 1. / 24., -0.5});
  c = hn::Mul(c, z); // cos(r) - 1
  cosine_minus_1 = c;
  sine = s;
  const auto zero = hn::Zero(d);
  if (HWY_LIKELY(hn::AllTrue(d, hn::Eq(k, zero))))
    return;
  const hn::RebindToUnsigned<D> du;
  const auto quarter = hn::BitCast(du, shifted);
  const auto odd = hn::RebindMask(d, hn::TestBit(quarter, hn::Set(du, 1)));
  const auto second = hn::RebindMask(d, hn::TestBit(quarter, hn::Set(du, 2)));
  // Quarter turns 0 to 3: cos is c, -s, -c, s and sin is s, c, -s, -c.
  const auto one = hn::Set(d, 1.), c1 = hn::Add(c, one);
  const auto cosine = hn::IfThenElse(odd, hn::Neg(s), c1);
  const auto turned = hn::IfThenElse(odd, c1, s);
  cosine_minus_1 = hn::IfThenElse(hn::Or(odd, second),
                                  hn::Sub(hn::IfThenElse(second, hn::Neg(cosine), cosine), one), c);
  sine = hn::IfThenElse(second, hn::Neg(turned), turned);
}
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
