// What particles answer to their strains: the sweep that finds the pressures flows by their laws
// and books it; compiled once for every instruction set.
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
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
/// What particles answer to their strains.
template <int dim, typename V>
struct Answer
{
  SymmetricTensor<dim, V> strain; // e
  V pressure;                     // Pa
  bool is_strained;

  HWY_INLINE Answer(const SymmetricTensor<dim, V> &e, V p, bool strained)
      : pressure(p), is_strained(strained)
  {
    for (int c = 0; c < n_tensor<dim>; ++c)
      strain.c[c] = e.c[c];
  }
  // Number by number: bytes copied as one block stay in memory.
  HWY_INLINE Answer(const Answer &other) : Answer(other.strain, other.pressure, other.is_strained)
  {
  }
  HWY_INLINE Answer &operator=(const Answer &other)
  {
    for (int c = 0; c < n_tensor<dim>; ++c)
      strain.c[c] = other.strain.c[c];
    pressure = other.pressure;
    is_strained = other.is_strained;
    return *this;
  }
};

/// Finds it; their e follow in memory where flow is allowed. `open`: some of them have open cells;
/// `plain`: all are of one law, which is not viscous, and energies are not asked for.
template <int dim, typename D, typename At, bool open, bool plain>
class Response : public Answer<dim, hn::Vec<D>>
{
  using V = hn::Vec<D>;
  using Streams = InelasticStreams<dim>;
  using Own = OwnStress<dim, D, open>;
  using Base = Answer<dim, V>;
  using Base::is_strained;
  using Base::pressure;
  using Base::strain;

public:
  using Tensor = SymmetricTensor<dim, V>;

  /// Particles flow where `fresh`: those that have done so in this sweep stay as they are. `law`:
  /// that of all where they are plain.
  HWY_INLINE Response(D d, const InelasticSweep<dim> &s, const At &at, hn::Mask<D> fresh,
                      const FlowLaw *law, const Own &own)
      : Base{zero_tensor<dim>(hn::Zero(d)), own.elastic_pressure(), false}, d_(d), s_(s),
        streams_(s.streams), at_(at)
  {
    bool all = true, any = false;
    at.for_each_block([&](long b) HWY_ATTR {
      all = all && s.begun[b];
      any = any || s.begun[b];
    });
    is_strained = any;
    if (HWY_UNLIKELY(all != any) && s.may_flow)
      begin();
    if (is_strained) {
      for (int c = 0; c < n_tensor<dim>; ++c)
        strain.c[c] = at.load(d, streams_.stream(Streams::strain + c));
      pressure = own.pressure(strain);
    }
    if (s.may_flow) {
      if constexpr (plain)
        flow_by(*law, fresh, own);
      else
        for_each_law(fresh, [&](const FlowLaw &of_some, hn::Mask<D> where) HWY_ATTR {
          if (of_some.viscous)
            creep(of_some, where, own);
          else
            flow_by(of_some, where, own);
          pressure = own.pressure(strain);
        });
    }
    if constexpr (!plain)
      if (s.energy != nullptr) {
        at.store(d, own.own_energy(strain, twice_shear()), fresh, s.energy);
        for_each_law(fresh, [&](const FlowLaw &of_some, hn::Mask<D> where)
                                HWY_ATTR { add_kept(of_some, where, own); });
      }
  }

private:
  /// The state of all blocks is kept from now on.
  HWY_INLINE void begin() const
  {
    at_.for_each_block([&](long b) HWY_ATTR { s_.begun[b] = 1; });
  }

  /// visit(law, where) law by law of the lanes.
  template <typename Visit>
  HWY_INLINE void for_each_law(hn::Mask<D> fresh, Visit &&visit) const
  {
    std::uint32_t left = lane_bits(d_, fresh);
    while (left != 0) {
      int first = 0;
      while (!(left >> first & 1))
        ++first;
      const int law = law_of(first);
      HWY_ALIGN double has[At::n];
      for (int l = 0; l < At::n; ++l) {
        const bool same = (left >> l & 1) && law_of(l) == law;
        has[l] = same;
        if (same)
          left &= ~(1u << l);
      }
      visit(s_.laws[law], hn::Gt(hn::Load(d_, has), hn::Zero(d_)));
    }
  }
  int law_of(int lane) const { return s_.law_of ? s_.law_of[at_.particle(lane)] : 0; }

  HWY_INLINE void flow_by(const FlowLaw &law, hn::Mask<D> where, const Own &own)
  {
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
  HWY_INLINE void flow_by(const Law &law, double twice_shear, hn::Mask<D> where, const Own &own)
  {
    if (!is_strained) {
      const Tensor stress = own.elastic_stress(pressure, twice_shear);
      if (HWY_LIKELY(hn::AllFalse(d_, hn::And(where, law.is_near(stress)))))
        return;
      is_strained = true;
      begin();
    }
    for (int k = 0; k < Streams::n_streams; ++k)
      at_.prefetch(streams_.stream(k));
    if constexpr (Law::is_radial)
      if (!own.is_plane_stress()) {
        flow_along(law, twice_shear, where, own);
        return;
      }
    Tensor stress = own.stress(strain, pressure, twice_shear);
    double *const history = streams_.stream(Streams::history);
    const V h_before = at_.load(d_, history);
    V h = h_before;
    Tensor increment;
    const auto flows = law.flow(stress, where, h, increment);
    if (!hn::AllFalse(d_, flows)) {
      for (int c = 0; c < n_tensor<dim>; ++c) {
        strain.c[c] = hn::Add(strain.c[c], increment.c[c]);
        at_.store(d_, strain.c[c], where, streams_.stream(Streams::strain + c));
      }
      at_.store(d_, h, where, history);
      pressure = own.pressure(strain);
      stress = own.stress(strain, pressure, twice_shear);
      const Tensor before = load(Streams::stress);
      book(twice_work(stress, before, is_known(law, flows, h_before, before), increment), where,
           own);
    }
    for (int c = 0; c < n_tensor<dim>; ++c)
      at_.store(d_, stress.c[c], where, streams_.stream(Streams::stress + c));
  }

  /// The same where flow is a share of the deviator. In whole cells it takes as much of the stress,
  /// whatever else the vector holds.
  template <typename Law>
  HWY_INLINE void flow_along(const Law &law, double twice_shear, hn::Mask<D> where, const Own &own)
  {
    Tensor stress = own.stress(strain, pressure, twice_shear), increment;
    const Tensor s = deviator(d_, stress);
    const V square = double_dot(s);
    double *const history = streams_.stream(Streams::history);
    const V h_before = at_.load(d_, history);
    V h = h_before, along;
    if (const auto flows = law.find_flow(square, where, h, along); !hn::AllFalse(d_, flows)) {
      at_.store(d_, h, where, history);
      const Tensor before = load(Streams::stress);
      const auto known = is_known(law, flows, h_before, before);
      const V relaxed = hn::Mul(hn::Set(d_, twice_shear), along);
      V work = hn::NegMulAdd(relaxed, square, square); // with the stress after, and before
      work = hn::Add(work, hn::IfThenElse(known, double_dot(s, before), work));
      work = hn::Mul(along, work);
      for (int c = 0; c < n_tensor<dim>; ++c) {
        increment.c[c] = hn::Mul(along, s.c[c]);
        strain.c[c] = hn::Add(strain.c[c], increment.c[c]);
        stress.c[c] = hn::NegMulAdd(relaxed, s.c[c], stress.c[c]);
        at_.store(d_, strain.c[c], where, streams_.stream(Streams::strain + c));
      }
      pressure = own.pressure(strain);
      if constexpr (open) {
        const auto whole = own.is_whole();
        const Tensor other = own.stress(strain, pressure, twice_shear);
        work = hn::IfThenElse(whole, work, twice_work(other, before, known, increment));
        for (int c = 0; c < n_tensor<dim>; ++c)
          stress.c[c] = hn::IfThenElse(whole, stress.c[c], other.c[c]);
      }
      book(work, where, own);
    }
    for (int c = 0; c < n_tensor<dim>; ++c)
      at_.store(d_, stress.c[c], where, streams_.stream(Streams::stress + c));
  }

  HWY_INLINE Tensor load(int stream) const
  {
    Tensor t;
    for (int c = 0; c < n_tensor<dim>; ++c)
      t.c[c] = at_.load(d_, streams_.stream(stream + c));
    return t;
  }

  /// The viscous part first, plastic flow on the stress that is left, then both at once: e is
  /// their sum.
  HWY_NOINLINE void creep(const FlowLaw &law, hn::Mask<D> where, const Own &own)
  {
    const double twice_shear = 2 * law.shear;
    ViscousFlow<dim, D, At, Own> viscous(d_, law, streams_, at_, own);
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
    const Tensor before = load(Streams::stress);
    const auto known = law.viscous->follows
                           ? where
                           : hn::Gt(double_dot(before), hn::Zero(d_)); // of particles that are new
    double *const history = streams_.stream(Streams::history);
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
      const auto first = viscous;
      const Tensor first_stress = stress;
      stress = either(flows, find_stress(), first_stress);
      viscous.keep(hn::Not(flows), first); // solved for once more they are others at the last bit
      for (int c = 0; c < n_tensor<dim>; ++c)
        all.c[c] = hn::Add(plastic.c[c], viscous.strain.c[c]);
      book(twice_work(stress, before, known, increment), flows, own);
    }
    viscous.store(where, either(known, before, stress), stress);
    for (int c = 0; c < n_tensor<dim>; ++c) {
      strain.c[c] = hn::IfThenElse(where, all.c[c], strain.c[c]);
      at_.store(d_, all.c[c], where, streams_.stream(Streams::strain + c));
      at_.store(d_, stress.c[c], where, streams_.stream(Streams::stress + c));
    }
  }

  /// To the energy: what viscous particles keep.
  HWY_INLINE void add_kept(const FlowLaw &law, hn::Mask<D> where, const Own &own) const
  {
    if (!law.viscous || !is_strained)
      return;
    const V kept = ViscousFlow<dim, D, At, Own>(d_, law, streams_, at_, own).kept_before();
    at_.store(d_, hn::MulAdd(own.volume(), kept, at_.load(d_, s_.energy)), where, s_.energy);
  }

  /// Where the stress that the step before left is known, of those that flow: particles that have
  /// flowed by then (h_before > 0) or had half of the limit. This is theirs alone, whatever their
  /// block keeps.
  template <typename Law>
  HWY_INLINE hn::Mask<D> is_known(const Law &law, hn::Mask<D> flows, V h_before,
                                  const Tensor &before) const
  {
    const auto flowed = hn::Gt(h_before, hn::Zero(d_));
    if (HWY_LIKELY(hn::AllFalse(d_, hn::AndNot(flowed, flows))))
      return flowed;
    return hn::Or(flowed, law.is_near(before));
  }
  HWY_INLINE Tensor either(hn::Mask<D> where, const Tensor &there, const Tensor &elsewhere) const
  {
    Tensor t;
    for (int c = 0; c < n_tensor<dim>; ++c)
      t.c[c] = hn::IfThenElse(where, there.c[c], elsewhere.c[c]);
    return t;
  }
  /// Of an increment with the stresses after it and before, J/m^3; those whose stress before is not
  /// known come with the one that they leave with.
  HWY_INLINE V twice_work(const Tensor &stress, const Tensor &before, hn::Mask<D> known,
                          const Tensor &increment) const
  {
    Tensor sum = either(known, before, stress);
    for (int c = 0; c < n_tensor<dim>; ++c)
      sum.c[c] = hn::Add(stress.c[c], sum.c[c]);
    return double_dot(sum, increment);
  }
  /// Eq. (D23).
  HWY_INLINE void book(V twice, hn::Mask<D> where, const Own &own) const
  {
    double *const taken = streams_.stream(Streams::taken);
    const V half_volume = hn::Mul(hn::Set(d_, 0.5), own.volume());
    at_.store(d_, hn::MulAdd(half_volume, twice, at_.load(d_, taken)), where, taken);
  }

  /// 2G of the lanes.
  HWY_INLINE V twice_shear() const
  {
    HWY_ALIGN double value[At::n];
    for (int l = 0; l < At::n; ++l)
      value[l] = 2 * s_.laws[law_of(l)].shear;
    return hn::Load(d_, value);
  }

  D d_;
  const InelasticSweep<dim> &s_;
  const Streams streams_;
  At at_;
};

/// The law of all particles of a vector where that is all there is to know of them, else null.
template <int dim, typename At>
HWY_INLINE const FlowLaw *plain_law(const InelasticSweep<dim> &s, const At &at)
{
  if (s.energy || (s.law_of && !at.is_same(s.law_of)))
    return nullptr;
  const FlowLaw *const law = s.laws + (s.law_of ? s.law_of[at.particle(0)] : 0);
  return law->viscous ? nullptr : law;
}

/// Whether particles whose strains E have these E:E have none of their own, keep nothing and stay
/// below what laws look at, whatever the directions of E.
template <int dim, typename D, typename At, typename V = hn::Vec<D>>
HWY_INLINE bool is_quiet(D d, const InelasticSweep<dim> &s, const At &at, V square)
{
  const FlowLaw *const law = plain_law(s, at);
  if (HWY_UNLIKELY(!law || at.any_open(s.open) || (dim == 2 && !s.is_plane_strain)))
    return false;
  bool any = false;
  at.for_each_block([&](long b) HWY_ATTR { any = any || s.begun[b]; });
  if (any)
    return false;
  switch (law->kind) {
  case FlowLaw::Kind::elastic:
    return true;
  case FlowLaw::Kind::von_mises:
    return VonMisesReturn<dim, D>(d, *law).is_far(square);
  case FlowLaw::Kind::drucker_prager:
    return DruckerPragerReturn<dim, D>(d, *law).is_far(square);
  }
  return false;
}

/// Of any particles.
template <int dim, typename D, typename At, typename V = hn::Vec<D>>
HWY_NOINLINE void respond_apart(D d, const InelasticSweep<dim> &s, const At &at, hn::Mask<D> fresh,
                                const V (&x)[dim][dim], V trace, V lambda_per_volume,
                                Answer<dim, V> &answer)
{
  const FlowLaw *const law = plain_law(s, at);
  const auto respond_with = [&](auto open, auto plain) HWY_ATTR {
    answer = Response<dim, D, At, open(), plain()>(
        d, s, at, fresh, law, OwnStress<dim, D, open()>(d, s, at, x, trace, lambda_per_volume));
  };
  if (!at.any_open(s.open))
    respond_with(std::false_type(), std::false_type());
  else if (law)
    respond_with(std::true_type(), std::true_type());
  else
    respond_with(std::true_type(), std::false_type());
}

/// What particles with these X (OwnStress) answer; they flow where `fresh`.
template <int dim, typename D, typename At, typename V = hn::Vec<D>>
HWY_INLINE Answer<dim, V> respond(D d, const InelasticSweep<dim> &s, const At &at,
                                  hn::Mask<D> fresh, const V (&x)[dim][dim], V trace,
                                  V lambda_per_volume)
{
  if constexpr (At::n > 1) {
    const FlowLaw *const law = plain_law(s, at);
    if (HWY_LIKELY(law && !at.any_open(s.open)))
      return Response<dim, D, At, false, true>(
          d, s, at, fresh, law, OwnStress<dim, D, false>(d, s, at, x, trace, lambda_per_volume));
  }
  // Copies, lest all else is kept in memory, too.
  V copy[dim][dim];
  for (int a = 0; a < dim; ++a)
    for (int b = 0; b < dim; ++b)
      copy[a][b] = x[a][b];
  Answer<dim, V> answer(zero_tensor<dim>(hn::Zero(d)), hn::Zero(d), false);
  respond_apart<dim>(d, s, at, fresh, copy, trace, lambda_per_volume, answer);
  return answer;
}
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
