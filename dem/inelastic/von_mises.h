// The return to von Mises' yield surface, theory.md eq. (D24a); compiled once for every instruction
// set.
#if defined(LIGAMENT_DEM_VON_MISES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LIGAMENT_DEM_VON_MISES_H
#undef LIGAMENT_DEM_VON_MISES_H
#else
#define LIGAMENT_DEM_VON_MISES_H
#endif

#include "dem/inelastic/tensor_lanes.h"

#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
template <int dim, typename D>
class VonMisesReturn
{
  using V = hn::Vec<D>;
  using Tensor = SymmetricTensor<dim, V>;

public:
  /// Whether all that flows is a share of the deviator.
  static constexpr bool is_radial = true;

  HWY_INLINE VonMisesReturn(D d, const FlowLaw &law) : d_(d), law_(law) {}

  /// Whether no strain E with these E:E of a whole cell has a stress that is near.
  HWY_INLINE bool is_far(V square) const
  {
    const V factor = hn::Set(d_, 6 * 4 * law_.shear * law_.shear);
    constexpr double round_off = 1e-9;
    const V limit = hn::Set(d_, (1 - round_off) * law_.yield * law_.yield);
    return hn::AllTrue(d_, hn::Lt(hn::Mul(factor, square), limit));
  }

  /// Where the stress is at least half as large as the first one that flows.
  HWY_INLINE hn::Mask<D> is_near(const Tensor &stress) const
  {
    const double half = 0.5 * law_.yield;
    return hn::Ge(double_dot(deviator(d_, stress)), hn::Set(d_, half * half / 1.5));
  }

  /// The increment of e, 0 where nothing flows or not `where`; the history follows. Returns where
  /// anything flows.
  HWY_INLINE hn::Mask<D> flow(const Tensor &stress, hn::Mask<D> where, V &history,
                              Tensor &increment) const
  {
    const Tensor s = deviator(d_, stress);
    V along;
    const auto flows = find_flow(double_dot(s), where, history, along);
    for (int c = 0; c < n_tensor<dim>; ++c)
      increment.c[c] = hn::Mul(along, s.c[c]);
    return flows;
  }

  /// The same as increment over deviator s, from s:s.
  HWY_INLINE hn::Mask<D> find_flow(V square, hn::Mask<D> where, V &history, V &along) const
  {
    const V zero = hn::Zero(d_);
    const V equivalent = hn::Sqrt(hn::Mul(hn::Set(d_, 1.5), square));
    along = zero;
    V yield, slope;
    find_yield(history, yield, slope);
    const auto flows = hn::And(where, hn::Gt(equivalent, yield));
    if (hn::AllFalse(d_, flows))
      return flows;
    if (law_.n_points == 0 && law_.saturation == 0) {
      const double per_stress = 1 / (3 * law_.shear + law_.hardening);
      const V strain =
          hn::IfThenElseZero(flows, hn::Mul(hn::Sub(equivalent, yield), hn::Set(d_, per_stress)));
      history = hn::Add(history, strain);
      // Beside the strain, not after it.
      const V share = hn::Div(yield, hn::Max(equivalent, yield));
      const V excess = hn::Sub(hn::Set(d_, 1.), share);
      along = hn::IfThenElseZero(flows, hn::Mul(hn::Set(d_, 1.5 * per_stress), excess));
      return flows;
    }
    const V three_shear = hn::Set(d_, 3 * law_.shear);
    V strain = hn::Div(hn::Sub(equivalent, yield), hn::Add(three_shear, slope));
    for (int step = 0; step < 3; ++step) { // Newton's
      find_yield(hn::Add(history, strain), yield, slope);
      const V excess = hn::Sub(hn::NegMulAdd(three_shear, strain, equivalent), yield);
      strain = hn::Max(zero, hn::Add(strain, hn::Div(excess, hn::Add(three_shear, slope))));
    }
    strain = hn::IfThenElseZero(flows, strain);
    history = hn::Add(history, strain);
    along = hn::IfThenElseZero(
        flows, hn::Div(hn::Mul(hn::Set(d_, 1.5), strain), hn::Max(equivalent, yield)));
    return flows;
  }

private:
  HWY_INLINE void find_yield(V p, V &yield, V &slope) const
  {
    if (law_.n_points > 0) {
      yield = hn::Set(d_, law_.stress[0]);
      slope = hn::Zero(d_);
      for (int k = 0; k < law_.n_points; ++k) {
        const double rise = k + 1 < law_.n_points ? (law_.stress[k + 1] - law_.stress[k]) /
                                                        (law_.strain[k + 1] - law_.strain[k])
                                                  : 0;
        const auto behind = hn::Ge(p, hn::Set(d_, law_.strain[k]));
        const V value = hn::MulAdd(hn::Set(d_, rise), hn::Sub(p, hn::Set(d_, law_.strain[k])),
                                   hn::Set(d_, law_.stress[k]));
        yield = hn::IfThenElse(behind, value, yield);
        slope = hn::IfThenElse(behind, hn::Set(d_, rise), slope);
      }
      return;
    }
    yield = hn::MulAdd(hn::Set(d_, law_.hardening), p, hn::Set(d_, law_.yield));
    slope = hn::Set(d_, law_.hardening);
    if (law_.saturation > 0) {
      const V left =
          hn::Mul(hn::Set(d_, law_.saturation), hn::Exp(d_, hn::Mul(hn::Set(d_, -law_.rate), p)));
      yield = hn::Add(yield, hn::Sub(hn::Set(d_, law_.saturation), left));
      slope = hn::MulAdd(hn::Set(d_, law_.rate), left, slope);
    }
  }

  D d_;
  const FlowLaw &law_;
};
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
