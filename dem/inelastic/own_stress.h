// A particle's own stress and the return to its law, theory.md eqs. (D20), (D21): closed form, in
// the sweep that finds the pressures; compiled once for every instruction set.
#if defined(LIGAMENT_DEM_OWN_STRESS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LIGAMENT_DEM_OWN_STRESS_H
#undef LIGAMENT_DEM_OWN_STRESS_H
#else
#define LIGAMENT_DEM_OWN_STRESS_H
#endif

#include "dem/inelastic/drucker_prager.h"
#include "dem/inelastic/von_mises.h"

#include <hwy/cache_control.h>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
/// Particles that lie side by side, from i on.
template <int dim, typename D>
struct InARow
{
  using V = hn::Vec<D>;
  static constexpr int n = int(hn::MaxLanes(D()));
  long i;

  long particle(int lane) const { return i + lane; }
  HWY_INLINE bool any_open(const int *open) const
  {
    const hn::CappedTag<std::int32_t, n> d;
    return !hn::AllTrue(d, hn::Lt(hn::LoadU(d, open + i), hn::Zero(d)));
  }
  /// Asks for what streams hold some vectors after these: they are too many for the processor to
  /// follow by itself.
  HWY_INLINE void prefetch(const double *stream) const { hwy::Prefetch(stream + i + 64); }
  /// visit(block) of all that they lie in.
  template <typename Visit>
  HWY_INLINE void for_each_block(Visit &&visit) const
  {
    const long first = i / inelastic_block, last = (i + n - 1) / inelastic_block;
    visit(first);
    if (HWY_UNLIKELY(last != first))
      visit(last);
  }
  HWY_INLINE V load(D d, const double *stream) const { return hn::LoadU(d, stream + i); }
  HWY_INLINE void store(D d, V value, hn::Mask<D> where, double *stream) const
  {
    if constexpr (n > 1)
      hn::BlendedStore(value, where, d, stream + i);
    else if (lane_bits(d, where) & 1) // a masked store would look at lanes behind the first one, too
      stream[i] = hn::GetLane(value);
  }
};

/// Particles anywhere in one block.
template <int dim, typename D>
struct Scattered
{
  using V = hn::Vec<D>;
  static constexpr int n = int(hn::MaxLanes(D()));
  int of[n];

  long particle(int lane) const { return of[lane]; }
  template <typename Visit>
  HWY_INLINE void for_each_block(Visit &&visit) const
  {
    visit(of[0] / inelastic_block);
  }
  HWY_INLINE bool any_open(const int *open) const
  {
    int any = -1;
    for (int l = 0; l < n; ++l)
      any = std::max(any, open[of[l]]);
    return any >= 0;
  }
  HWY_INLINE void prefetch(const double *) const {}
  HWY_INLINE V load(D d, const double *stream) const
  {
    HWY_ALIGN double value[n];
    for (int l = 0; l < n; ++l)
      value[l] = stream[of[l]];
    return hn::Load(d, value);
  }
  HWY_INLINE void store(D d, V value, hn::Mask<D> where, double *stream) const
  {
    HWY_ALIGN double values[n];
    hn::Store(value, d, values);
    const std::uint32_t lanes = lane_bits(d, where);
    for (int l = 0; l < n; ++l)
      if (lanes >> l & 1)
        stream[of[l]] = values[l];
  }
};

/// The strains of particles from the motion of all their faces, and what they answer at inelastic
/// strains e.
template <int dim, typename D>
class OwnStress
{
  using V = hn::Vec<D>;
  using Tensor = SymmetricTensor<dim, V>;

public:
  /// `x`: sum of S/r R^T Du (x) A of the lattice's bonds, m^dim; `lambda_per_volume`: lambda / V.
  template <typename At>
  HWY_INLINE OwnStress(D d, const InelasticSweep<dim> &s, const At &at, const V (&x)[dim][dim],
                       V lambda_per_volume)
      : d_(d), lambda_per_volume_(lambda_per_volume), is_plane_strain_(s.is_plane_strain)
  {
    for (int a = 0; a < dim; ++a)
      for (int b = 0; b < dim; ++b)
        x_[a][b] = x[a][b];
    is_open_ = at.any_open(s.open);
    if (s.volume) {
      volume_ = at.load(d, s.volume);
      per_volume_ = hn::Div(hn::Set(d, 1.), volume_);
    } else {
      volume_ = hn::Set(d, s.whole_volume);
      per_volume_ = hn::Set(d, s.per_whole_volume);
    }
    if (HWY_UNLIKELY(is_open_)) {
      int cell[At::n];
      for (int l = 0; l < At::n; ++l)
        cell[l] = s.open[at.particle(l)];
      take_open(s, cell);
      per_volume_ = hn::Div(hn::Set(d, 1.), volume_);
    }
  }

  /// lambda (theta - M:e) in Pa.
  HWY_INLINE V pressure(const Tensor &e) const
  {
    V trace = x_[0][0], flowed = hn::Zero(d_);
    for (int a = 1; a < dim; ++a)
      trace = hn::Add(trace, x_[a][a]);
    if (HWY_UNLIKELY(is_open_)) {
      for (int a = 0; a < dim; ++a)
        for (int b = 0; b < dim; ++b)
          flowed = hn::MulAdd(e(a, b), moment(a, b, a), flowed);
    } else
      for (int a = 0; a < dim; ++a)
        flowed = hn::Add(e.c[a], flowed);
    if (dim == 2 && is_plane_strain_)
      flowed = hn::Add(e.c[2], flowed);
    return hn::Mul(lambda_per_volume_, hn::NegMulAdd(volume_, flowed, trace));
  }

  /// In Pa, at the pressure of these e.
  HWY_INLINE Tensor stress(const Tensor &e, V pressure, double twice_shear) const
  {
    const V modulus = hn::Set(d_, twice_shear), half = hn::Set(d_, 0.5);
    const V per_volume = hn::Mul(modulus, per_volume_);
    Tensor t;
    for (int a = 0; a < dim; ++a)
      for (int b = a; b < dim; ++b) {
        V &sum = t.c[tensor_place<dim>(a, b)];
        sum = hn::Mul(per_volume, a == b ? x_[a][a]
                                         : hn::Mul(half, hn::Add(x_[a][b], x_[b][a])));
        if (HWY_UNLIKELY(is_open_)) {
          const V kept = hn::Mul(half, hn::Add(moved(e, a, b), moved(e, b, a)));
          const V pressed = hn::Mul(half, hn::Add(moment(a, a, b), moment(b, b, a)));
          sum = hn::MulAdd(pressure, pressed, hn::NegMulAdd(modulus, kept, sum));
        } else {
          sum = hn::NegMulAdd(modulus, e(a, b), sum);
          if (a == b)
            sum = hn::Add(sum, pressure);
        }
      }
    if constexpr (dim == 2)
      t.c[2] = is_plane_strain_ ? hn::NegMulAdd(modulus, e.c[2], pressure) : hn::Zero(d_);
    return t;
  }

  /// What e changes in the energy beside the pressure's, theory.md eq. (D20b), in J.
  HWY_INLINE V own_energy(const Tensor &e, V twice_shear) const
  {
    V sum = hn::Zero(d_), kept = sum;
    for (int a = 0; a < dim; ++a)
      for (int b = 0; b < dim; ++b) {
        sum = hn::MulAdd(e(a, b), x_[a][b], sum);
        kept = hn::MulAdd(e(a, b), is_open_ ? moved(e, a, b) : e(a, b), kept);
      }
    if (dim == 2 && is_plane_strain_)
      kept = hn::MulAdd(e.c[2], e.c[2], kept);
    return hn::Mul(twice_shear, hn::NegMulAdd(sum, hn::Set(d_, 1.),
                                              hn::Mul(hn::Set(d_, 0.5), hn::Mul(volume_, kept))));
  }

  V volume() const { return volume_; }

private:
  using Cell = OpenCell<dim>;

  /// M_ab as row `row` of e M has it.
  HWY_INLINE V moment(int row, int a, int b) const
  {
    return moment_[row][in_plane_place<dim>(a, b)];
  }
  /// (e M)_ab
  HWY_INLINE V moved(const Tensor &e, int a, int b) const
  {
    V sum = hn::Zero(d_);
    for (int c = 0; c < dim; ++c)
      sum = hn::MulAdd(e(a, c), moment(a, c, b), sum);
    return sum;
  }

  template <int n>
  HWY_NOINLINE void take_open(const InelasticSweep<dim> &s, const int (&cell)[n])
  {
    Cell whole; // of lanes without an open cell
    for (int row = 0; row < dim; ++row)
      for (int a = 0; a < dim; ++a)
        whole.number[Cell::moment + row * n_in_plane<dim> + in_plane_place<dim>(a, a)] = 1;
    HWY_ALIGN double volumes[n];
    hn::Store(volume_, d_, volumes);
    HWY_ALIGN double number[Cell::size][n];
    for (int l = 0; l < n; ++l) {
      const Cell &of = cell[l] >= 0 ? s.cells[cell[l]] : whole;
      for (int k = 0; k < Cell::size; ++k)
        number[k][l] = of.number[k];
      if (cell[l] < 0)
        number[Cell::volume][l] = volumes[l];
    }
    for (int a = 0; a < dim; ++a)
      for (int b = 0; b < dim; ++b)
        x_[a][b] = hn::Add(x_[a][b], hn::Load(d_, number[Cell::strain + dim * a + b]));
    volume_ = hn::Load(d_, number[Cell::volume]);
    for (int row = 0; row < dim; ++row)
      for (int k = 0; k < n_in_plane<dim>; ++k)
        moment_[row][k] = hn::Load(d_, number[Cell::moment + row * n_in_plane<dim> + k]);
  }

  D d_;
  V x_[dim][dim];
  V lambda_per_volume_, volume_, per_volume_;
  V moment_[dim][n_in_plane<dim>];
  bool is_plane_strain_, is_open_ = false;
};

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
      flow(fresh, own);
    pressure = own.pressure(strain);
    if (HWY_UNLIKELY(s.energy != nullptr))
      at.store(d, own.own_energy(strain, twice_shear()), fresh, s.energy);
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

  /// Law by law of the lanes.
  HWY_INLINE void flow(hn::Mask<D> fresh, const OwnStress<dim, D> &own)
  {
    if (!s_.law_of) {
      flow_by(s_.laws[0], fresh, own);
      return;
    }
    const int of_first = s_.law_of[at_.particle(0)];
    bool differ = false;
    for (int l = 1; l < At::n; ++l)
      differ = differ || s_.law_of[at_.particle(l)] != of_first;
    if (HWY_LIKELY(!differ)) {
      flow_by(s_.laws[of_first], fresh, own);
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
      flow_by(s_.laws[law], hn::Gt(hn::Load(d_, has), hn::Zero(d_)), own);
    }
  }

  HWY_INLINE void flow_by(const FlowLaw &law, hn::Mask<D> where, const OwnStress<dim, D> &own)
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
