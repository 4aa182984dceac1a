// The return to the surface of Drucker and Prager with Nikolaevskiy's dilatancy, theory.md
// eq. (D25); compiled once for every instruction set.
#if defined(LIGAMENT_DEM_DRUCKER_PRAGER_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LIGAMENT_DEM_DRUCKER_PRAGER_H
#undef LIGAMENT_DEM_DRUCKER_PRAGER_H
#else
#define LIGAMENT_DEM_DRUCKER_PRAGER_H
#endif

#include "dem/inelastic/tensor_lanes.h"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
template <int dim, typename D>
class DruckerPragerReturn
{
  using V = hn::Vec<D>;
  using Tensor = SymmetricTensor<dim, V>;

public:
  static constexpr bool is_radial = false;

  HWY_INLINE DruckerPragerReturn(D d, const FlowLaw &law) : d_(d), law_(law) {}

  /// Whether no strain E with these E:E of a whole cell has a stress that is near: sigma_m is at
  /// most K sqrt(3 E:E), and sqrt(1/2 s:s) at most G sqrt(2 E:E).
  HWY_INLINE bool is_far(V square) const
  {
    constexpr double root_3 = 1.7320508075688773, root_2 = 1.4142135623730951, round_off = 1e-9;
    const double most = root_3 * law_.friction * law_.bulk + root_2 * law_.shear;
    const V limit = hn::Set(d_, (0.25 - round_off) * law_.yield * law_.yield);
    return hn::AllTrue(d_, hn::Lt(hn::Mul(hn::Set(d_, most * most), square), limit));
  }

  /// Where the stress is at least half as large as the first one that flows.
  HWY_INLINE hn::Mask<D> is_near(const Tensor &stress) const
  {
    const V reached =
        hn::MulAdd(hn::Set(d_, law_.friction), mean(d_, stress), shear(deviator(d_, stress)));
    return hn::Ge(reached, hn::Set(d_, 0.5 * law_.yield));
  }

  /// The increment of e, 0 where nothing flows or not `where`; the history follows. Returns where
  /// anything flows.
  HWY_INLINE hn::Mask<D> flow(const Tensor &stress, hn::Mask<D> where, V &history,
                              Tensor &increment) const
  {
    const V friction = hn::Set(d_, law_.friction), shear_modulus = hn::Set(d_, law_.shear);
    const V middle = mean(d_, stress);
    const Tensor s = deviator(d_, stress);
    const V tau = shear(s);
    const V yield = yield_at(history);
    const V borne = hn::MulAdd(friction, middle, tau), excess = hn::Sub(borne, yield);
    const auto flows = hn::And(where, hn::Gt(excess, hn::Zero(d_)));
    if (hn::AllFalse(d_, flows))
      return flows;
    const V stiffness = stiffness_at(s, tau);
    V cone = hn::Div(excess, hn::Add(stiffness, hn::Set(d_, law_.hardening)));
    if (HWY_UNLIKELY(law_.hardening < 0)) // the cohesion does not fall below 0
      cone = hn::Min(cone, hn::Div(borne, stiffness));
    V shear_strain = cone, volume = hn::Mul(hn::Set(d_, law_.dilatancy), cone);
    if (!is_plane_stress() && law_.friction > 0) {
      // Past the apex the shear stress would turn round: there it vanishes, and the mean stress is
      // the largest that the material bears. Plane stress has no apex, the deviator out of the
      // plane is minus the mean stress; its cut through the cone is convex, so that a step along
      // the tangent ends on it or outside.
      const auto apex = hn::Gt(hn::Mul(shear_modulus, cone), tau);
      shear_strain = hn::IfThenElse(apex, hn::Div(tau, shear_modulus), cone);
      const V largest = hn::Div(yield_at(hn::Add(history, shear_strain)), friction);
      volume = hn::IfThenElse(apex, hn::Mul(hn::Sub(middle, largest), hn::Set(d_, 1 / law_.bulk)),
                              volume);
    }
    const V along = hn::IfThenElseZero(
        flows, hn::Div(hn::Mul(hn::Set(d_, 0.5), shear_strain), hn::Max(tau, hn::Set(d_, 1e-300))));
    const V third = hn::IfThenElseZero(flows, hn::Mul(hn::Set(d_, 1 / 3.), volume));
    history = hn::Add(history, hn::IfThenElseZero(flows, shear_strain));
    for (int c = 0; c < n_tensor<dim>; ++c)
      increment.c[c] = c < 3 ? hn::MulAdd(along, s.c[c], third) : hn::Mul(along, s.c[c]);
    return flows;
  }

private:
  HWY_INLINE bool is_plane_stress() const { return dim == 2 && law_.is_plane_stress; }

  /// How much of f an increment of the plastic shear strain takes, Pa: M:C:N, theory.md
  /// eqs. (D25), (D25b).
  HWY_INLINE V stiffness_at(const Tensor &s, V tau) const
  {
    if (!is_plane_stress())
      return hn::Set(d_, law_.shear + law_.bulk * law_.dilatancy * law_.friction);
    const double b = law_.friction / 3, dilatancy = law_.dilatancy / 3;
    const double lambda = law_.bulk - 2. / 3 * law_.shear;
    const V per_tau = hn::Div(hn::Set(d_, 0.5), hn::Max(tau, hn::Set(d_, 1e-300)));
    const V trace = hn::Mul(per_tau, hn::Add(s.c[0], s.c[1]));
    // The deviator's part out of the plane is minus the trace in it: half of a square is M's.
    const V square = hn::NegMulAdd(trace, trace, hn::Set(d_, 0.5));
    const V both = hn::MulAdd(hn::Set(d_, b + dilatancy), trace,
                              hn::Add(hn::Set(d_, 2 * b * dilatancy), square));
    const V traces =
        hn::Mul(hn::Add(hn::Set(d_, 2 * b), trace), hn::Add(hn::Set(d_, 2 * dilatancy), trace));
    const V sum = hn::MulAdd(hn::Set(d_, lambda / (lambda + 2 * law_.shear)), traces, both);
    // Where hardly any of the flow lies in the plane the return is left to the steps to come.
    const double least = std::max(0.1 * law_.shear, -1.25 * law_.hardening);
    return hn::Max(hn::Mul(hn::Set(d_, 2 * law_.shear), sum), hn::Set(d_, least));
  }

  HWY_INLINE V yield_at(V history) const
  {
    return hn::Max(hn::MulAdd(hn::Set(d_, law_.hardening), history, hn::Set(d_, law_.yield)),
                   hn::Zero(d_));
  }

  HWY_INLINE V shear(const Tensor &s) const
  {
    return hn::Sqrt(hn::Mul(hn::Set(d_, 0.5), double_dot(s)));
  }

  D d_;
  const FlowLaw &law_;
};
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
