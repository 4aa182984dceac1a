// What particles answer to their strains: the sweep that finds the pressures flows by their laws and
// books it; compiled once for every instruction set.
#if defined(LIGAMENT_DEM_RESPONSE_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LIGAMENT_DEM_RESPONSE_H
#undef LIGAMENT_DEM_RESPONSE_H
#else
#define LIGAMENT_DEM_RESPONSE_H
#endif

#include "dem/inelastic/drucker_prager.h"
#include "dem/inelastic/particle_places.h"
#include "dem/inelastic/viscous_flow.h"
#include "dem/inelastic/von_mises.h"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
/// What particles answer to their strains: their e follow in memory where flow is allowed.
template <int dim, typename D, typename At>
class Response
{
  using V = hn::Vec<D>;
  using Streams = InelasticStreams<dim>;

public:
  using Tensor = SymmetricTensor<dim, V>;

  Tensor strain; // e
  V pressure;    // Pa
  bool is_strained;

  /// Particles flow where `fresh`: those that have done so in this sweep stay as they are.
  HWY_INLINE Response(D d, const InelasticSweep<dim> &s, const At &at, hn::Mask<D> fresh,
                      const OwnStress<dim, D> &own)
      : strain(zero_tensor<dim>(hn::Zero(d))), d_(d), s_(s), at_(at)
  {
    std::uint8_t youngest = lasting, oldest = untouched;
    at.for_each_block([&](long b) HWY_ATTR {
      youngest = std::min(youngest, s.age[b]);
      oldest = std::max(oldest, s.age[b]);
    });
    is_strained = oldest > untouched;
    knows_before_ = youngest == lasting;
    if (HWY_UNLIKELY(youngest != oldest) && s.may_flow)
      begin();
    if (is_strained)
      for (int c = 0; c < n_tensor<dim>; ++c)
        strain.c[c] = at.load(d, s.streams.stream(Streams::strain + c));
    if (s.may_flow)
      for_each_law(fresh, [&](const FlowLaw &law, hn::Mask<D> where)
                              HWY_ATTR { flow_by(law, where, own); });
    pressure = own.pressure(strain);
    if (HWY_UNLIKELY(s.energy != nullptr)) {
      at.store(d, own.own_energy(strain, twice_shear()), fresh, s.energy);
      for_each_law(fresh, [&](const FlowLaw &law, hn::Mask<D> where)
                              HWY_ATTR { add_kept(law, where, own); });
    }
  }

private:
  /// The state of all blocks is kept from now on.
  HWY_INLINE void begin() const
  {
    at_.for_each_block([&](long b) HWY_ATTR {
      if (s_.age[b] == untouched)
        s_.age[b] = begun;
    });
  }

  /// visit(law, where) law by law of the lanes.
  template <typename Visit>
  HWY_INLINE void for_each_law(hn::Mask<D> fresh, Visit &&visit) const
  {
    if (!s_.law_of) {
      visit(s_.laws[0], fresh);
      return;
    }
    const int of_first = s_.law_of[at_.particle(0)];
    bool differ = false;
    for (int l = 1; l < At::n; ++l)
      differ = differ || s_.law_of[at_.particle(l)] != of_first;
    if (HWY_LIKELY(!differ)) {
      visit(s_.laws[of_first], fresh);
      return;
    }
    std::uint32_t left = lane_bits(d_, fresh);
    while (left != 0) {
      int first = 0;
      while (!(left >> first & 1))
        ++first;
      const int law = s_.law_of[at_.particle(first)];
      HWY_ALIGN double has[At::n];
      for (int l = 0; l < At::n; ++l) {
        const bool same = (left >> l & 1) && s_.law_of[at_.particle(l)] == law;
        has[l] = same;
        if (same)
          left &= ~(1u << l);
      }
      visit(s_.laws[law], hn::Gt(hn::Load(d_, has), hn::Zero(d_)));
    }
  }

  HWY_INLINE void flow_by(const FlowLaw &law, hn::Mask<D> where, const OwnStress<dim, D> &own)
  {
    if (HWY_UNLIKELY(law.viscous != nullptr)) {
      creep(law, where, own);
      return;
    }
    switch (law.kind) {
    case FlowLaw::Kind::elastic:
      break;
    case FlowLaw::Kind::von_mises:
      flow_by(VonMisesReturn<dim, D>(d_, law), 2 * law.shear, where, own);
      break;
    case FlowLaw::Kind::drucker_prager:
      flow_by(DruckerPragerReturn<dim, D>(d_, law), 2 * law.shear, where, own);
      break;
    }
  }

  template <typename Law>
  HWY_INLINE void flow_by(const Law &law, double twice_shear, hn::Mask<D> where,
                          const OwnStress<dim, D> &own)
  {
    Tensor stress = own.stress(strain, own.pressure(strain), twice_shear);
    if (!is_strained) {
      if (HWY_LIKELY(hn::AllFalse(d_, hn::And(where, law.is_near(stress)))))
        return;
      is_strained = true;
      begin();
    }
    for (int k = 0; k < Streams::n_streams; ++k)
      at_.prefetch(s_.streams.stream(k));
    double *const history = s_.streams.stream(Streams::history);
    V h = at_.load(d_, history);
    Tensor increment;
    const auto flows = law.flow(stress, where, h, increment);
    if (!hn::AllFalse(d_, flows)) {
      for (int c = 0; c < n_tensor<dim>; ++c) {
        strain.c[c] = hn::Add(strain.c[c], increment.c[c]);
        at_.store(d_, strain.c[c], flows, s_.streams.stream(Streams::strain + c));
      }
      at_.store(d_, h, flows, history);
      stress = own.stress(strain, own.pressure(strain), twice_shear);
      book(stress, increment, flows, own);
    }
    for (int c = 0; c < n_tensor<dim>; ++c)
      at_.store(d_, stress.c[c], where, s_.streams.stream(Streams::stress + c));
  }

  /// The viscous part first, plastic flow on the stress that is left, then both at once: e is
  /// their sum.
  HWY_NOINLINE void creep(const FlowLaw &law, hn::Mask<D> where, const OwnStress<dim, D> &own)
  {
    const double twice_shear = 2 * law.shear;
    ViscousFlow<dim, D, At> viscous(d_, law, s_.streams, at_, own);
    Tensor plastic, all, increment = zero_tensor<dim>(hn::Zero(d_));
    for (int c = 0; c < n_tensor<dim>; ++c)
      plastic.c[c] = hn::Sub(strain.c[c], viscous.strain.c[c]);
    const auto find_stress = [&]() HWY_ATTR {
      viscous.solve(plastic);
      for (int c = 0; c < n_tensor<dim>; ++c)
        all.c[c] = hn::Add(plastic.c[c], viscous.strain.c[c]);
      return own.stress(all, own.pressure(all), twice_shear);
    };
    Tensor stress = find_stress();
    double *const history = s_.streams.stream(Streams::history);
    V h = at_.load(d_, history);
    FlowLaw stiffened = law; // what flows plastically no longer drives the viscous part
    stiffened.shear *= 1 - law.viscous->answer();
    auto flows = hn::FirstN(d_, 0);
    if (law.kind == FlowLaw::Kind::von_mises)
      flows = VonMisesReturn<dim, D>(d_, stiffened).flow(stress, where, h, increment);
    if (law.kind == FlowLaw::Kind::drucker_prager)
      flows = DruckerPragerReturn<dim, D>(d_, stiffened).flow(stress, where, h, increment);
    const bool any_flows = !hn::AllFalse(d_, flows);
    if (any_flows) {
      at_.store(d_, h, flows, history);
      for (int c = 0; c < n_tensor<dim>; ++c) {
        increment.c[c] = hn::IfThenElseZero(flows, increment.c[c]);
        plastic.c[c] = hn::Add(plastic.c[c], increment.c[c]);
      }
      stress = find_stress();
      book(stress, increment, flows, own);
    }
    Tensor before = stress;
    if (knows_before_)
      for (int c = 0; c < n_tensor<dim>; ++c)
        before.c[c] = at_.load(d_, s_.streams.stream(Streams::stress + c));
    viscous.store(where, before, stress);
    for (int c = 0; c < n_tensor<dim>; ++c) {
      strain.c[c] = hn::IfThenElse(where, all.c[c], strain.c[c]);
      at_.store(d_, all.c[c], where, s_.streams.stream(Streams::strain + c));
      at_.store(d_, stress.c[c], where, s_.streams.stream(Streams::stress + c));
    }
  }

  /// To the energy: what viscous particles keep.
  HWY_INLINE void add_kept(const FlowLaw &law, hn::Mask<D> where,
                           const OwnStress<dim, D> &own) const
  {
    if (!law.viscous || !is_strained)
      return;
    const V kept = ViscousFlow<dim, D, At>(d_, law, s_.streams, at_, own).kept_before();
    at_.store(d_, hn::MulAdd(own.volume(), kept, at_.load(d_, s_.energy)), where, s_.energy);
  }

  /// Eq. (D23).
  HWY_INLINE void book(const Tensor &stress, const Tensor &increment, hn::Mask<D> flows,
                       const OwnStress<dim, D> &own) const
  {
    Tensor sum = stress;
    for (int c = 0; c < n_tensor<dim>; ++c)
      sum.c[c] = hn::Add(
          sum.c[c], knows_before_ ? at_.load(d_, s_.streams.stream(Streams::stress + c)) : sum.c[c]);
    double *const taken = s_.streams.stream(Streams::taken);
    const V half_volume = hn::Mul(hn::Set(d_, 0.5), own.volume());
    at_.store(d_, hn::MulAdd(half_volume, double_dot(sum, increment), at_.load(d_, taken)), flows,
              taken);
  }

  /// 2G of the lanes.
  HWY_INLINE V twice_shear() const
  {
    HWY_ALIGN double value[At::n];
    for (int l = 0; l < At::n; ++l)
      value[l] = 2 * s_.laws[s_.law_of ? s_.law_of[at_.particle(l)] : 0].shear;
    return hn::Load(d_, value);
  }

  D d_;
  const InelasticSweep<dim> &s_;
  At at_;
  bool knows_before_;
};
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
