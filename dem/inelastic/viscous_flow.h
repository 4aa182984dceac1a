// The viscous part of the strains of particles, theory.md eqs. (D26) to (D28): one linear step,
// solved at once with the stress that it leaves; compiled once for every instruction set.
#if defined(LIGAMENT_DEM_VISCOUS_FLOW_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LIGAMENT_DEM_VISCOUS_FLOW_H
#undef LIGAMENT_DEM_VISCOUS_FLOW_H
#else
#define LIGAMENT_DEM_VISCOUS_FLOW_H
#endif

#include "dem/inelastic/own_stress.h"

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
template <int dim, typename D, typename At, typename Own>
class ViscousFlow
{
  using V = hn::Vec<D>;
  using Streams = InelasticStreams<dim>;

public:
  using Tensor = SymmetricTensor<dim, V>;

  Tensor strain; // e_v

  /// As the step before left them.
  HWY_INLINE ViscousFlow(D d, const FlowLaw &law, const Streams &streams, const At &at,
                         const Own &own)
      : strain(zero_tensor<dim>(hn::Zero(d))), d_(d), step_(*law.viscous), streams_(streams),
        at_(at), own_(own), still_(own.without_motion()), twice_shear_(2 * law.shear),
        strain_before_(load(Streams::viscous)), driving_before_(load(Streams::driving)),
        rated_before_(step_.has_dashpot ? load(Streams::rated) : strain)
  {
    strain = strain_before_;
    for (int k = 0; k < step_.n_branches; ++k) {
      const BranchStep &b = step_.branches[k];
      for (int c = 0; c < n_tensor<dim>; ++c)
        rest_.c[c] = hn::MulAdd(
            hn::Set(d_, b.share * b.lead), driving_before_.c[c],
            hn::NegMulAdd(hn::Set(d_, b.share * b.kept), at_.load(d_, branch(k, c)), rest_.c[c]));
    }
  }

  /// Beside what flows otherwise, and with the stress that both leave.
  HWY_INLINE void solve(const Tensor &other)
  {
    Tensor rest = rest_;
    for (int c = 0; c < n_tensor<dim>; ++c)
      rest.c[c] = hn::MulAdd(hn::Set(d_, step_.rate), rated_before_.c[c], rest.c[c]);
    follow(other, rest, step_.answer(), own_.is_plane_stress() ? 2 : 0);
    if (HWY_LIKELY(!own_.is_open())) {
      rated_ = driving_;
      return;
    }
    const Tensor whole = strain, whole_driving = driving_;
    strain = zero_tensor<dim>(hn::Zero(d_)); // a deviator
    follow(other, rest_, step_.of_branches, dim == 2 ? 3 : 5);
    const auto incomplete = own_.is_incomplete();
    const Tensor rated = seen_deviator(other);
    for (int c = 0; c < n_tensor<dim>; ++c) {
      const V damped = hn::Mul(hn::Set(d_, -step_.rate), hn::Sub(rated.c[c], rated_before_.c[c]));
      strain.c[c] = hn::IfThenElse(incomplete, hn::Add(strain.c[c], damped), whole.c[c]);
      driving_.c[c] = hn::IfThenElse(incomplete, driving_.c[c], whole_driving.c[c]);
      rated_.c[c] = hn::IfThenElse(incomplete, rated.c[c], driving_.c[c]);
    }
  }

  /// What another solution has, there.
  HWY_INLINE void keep(hn::Mask<D> where, const ViscousFlow &other)
  {
    for (int c = 0; c < n_tensor<dim>; ++c) {
      strain.c[c] = hn::IfThenElse(where, other.strain.c[c], strain.c[c]);
      driving_.c[c] = hn::IfThenElse(where, other.driving_.c[c], driving_.c[c]);
      rated_.c[c] = hn::IfThenElse(where, other.rated_.c[c], rated_.c[c]);
    }
  }

  /// The new state where `where`, and what it dissipated between the stresses before and now: what
  /// e_v took less what branches and dashpots keep, eq. (D28).
  HWY_INLINE void store(hn::Mask<D> where, const Tensor &stress_before, const Tensor &stress) const
  {
    Tensor slid = zero_tensor<dim>(hn::Zero(d_)), slid_before = slid, increment, mean_stress;
    V kept = hn::Zero(d_), kept_before = kept;
    for (int k = 0; k < step_.n_branches; ++k) {
      const BranchStep &b = step_.branches[k];
      Tensor now;
      for (int c = 0; c < n_tensor<dim>; ++c)
        now.c[c] = hn::MulAdd(hn::Set(d_, b.lead), hn::Sub(driving_.c[c], driving_before_.c[c]),
                              hn::Mul(hn::Set(d_, b.kept), at_.load(d_, branch(k, c))));
      add_branch(k, driving_before_, load(Streams::branches + k * n_tensor<dim>), slid_before,
                 kept_before);
      add_branch(k, driving_, now, slid, kept);
      for (int c = 0; c < n_tensor<dim>; ++c)
        at_.store(d_, now.c[c], where, branch(k, c));
    }
    kept = all_kept(kept, slid, strain, stress);
    kept_before = all_kept(kept_before, slid_before, strain_before_, stress_before);
    for (int c = 0; c < n_tensor<dim>; ++c) {
      increment.c[c] = hn::Sub(strain.c[c], strain_before_.c[c]);
      mean_stress.c[c] = hn::Mul(hn::Set(d_, 0.5), hn::Add(stress.c[c], stress_before.c[c]));
    }
    const V taken = hn::Sub(double_dot(mean_stress, increment), hn::Sub(kept, kept_before));
    double *const dissipated = streams_.stream(Streams::dissipated);
    at_.store(d_, hn::MulAdd(own_.volume(), taken, at_.load(d_, dissipated)), where, dissipated);
    for (int c = 0; c < n_tensor<dim>; ++c) {
      at_.store(d_, strain.c[c], where, streams_.stream(Streams::viscous + c));
      at_.store(d_, driving_.c[c], where, streams_.stream(Streams::driving + c));
      if (step_.has_dashpot)
        at_.store(d_, rated_.c[c], where, streams_.stream(Streams::rated + c));
    }
  }

  /// Energy in J/m^3 beside that of eq. (D20b), of the step before: what the springs of the
  /// branches hold, less what (D20b) counts of the dashpot.
  HWY_INLINE V kept_before() const
  {
    Tensor slid = zero_tensor<dim>(hn::Zero(d_));
    V kept = hn::Zero(d_);
    for (int k = 0; k < step_.n_branches; ++k)
      add_branch(k, driving_before_, load(Streams::branches + k * n_tensor<dim>), slid, kept);
    return all_kept(kept, slid, strain_before_, load(Streams::stress));
  }

private:
  HWY_INLINE Tensor load(int stream) const
  {
    Tensor t;
    for (int c = 0; c < n_tensor<dim>; ++c)
      t.c[c] = at_.load(d_, streams_.stream(stream + c));
    return t;
  }
  HWY_INLINE double *branch(int k, int c) const
  {
    return streams_.stream(Streams::branches + k * n_tensor<dim> + c);
  }

  /// dev (e_v + sigma / (2G)): of the strain behind the stress and e_v. Of e_v, too, lest the
  /// dashpot feeds what rounding leaves of its trace.
  HWY_INLINE Tensor driven(const Own &own, const Tensor &other, const Tensor &viscous) const
  {
    Tensor all;
    for (int c = 0; c < n_tensor<dim>; ++c)
      all.c[c] = hn::Add(other.c[c], viscous.c[c]);
    const Tensor stress = own.stress(all, own.pressure(all), twice_shear_);
    for (int c = 0; c < n_tensor<dim>; ++c)
      all.c[c] = hn::MulAdd(hn::Set(d_, 1 / twice_shear_), stress.c[c], viscous.c[c]);
    return deviator(d_, all);
  }

  /// e_v = answer d + rest. Where d depends on e_v: (1 - answer L) x = change of e_v, L symmetric
  /// and below 1. Conjugate gradients are exact after as many steps as L has values.
  HWY_INLINE void follow(const Tensor &other, const Tensor &rest, double by, int n_steps)
  {
    const Tensor first = strain;
    driving_ = driven(own_, other, first);
    const V answer = hn::Set(d_, by);
    for (int c = 0; c < n_tensor<dim>; ++c)
      strain.c[c] = hn::MulAdd(answer, driving_.c[c], rest.c[c]);
    if (n_steps == 0)
      return;
    const Tensor none = zero_tensor<dim>(hn::Zero(d_));
    Tensor residual, along, moved = none;
    for (int c = 0; c < n_tensor<dim>; ++c)
      along.c[c] = residual.c[c] = hn::Sub(strain.c[c], first.c[c]);
    V square = double_dot(residual);
    for (int s = 0; s < n_steps; ++s) {
      const Tensor turned = driven(still_, none, along);
      Tensor product;
      for (int c = 0; c < n_tensor<dim>; ++c)
        product.c[c] = hn::NegMulAdd(answer, turned.c[c], along.c[c]);
      const V length = ratio(square, double_dot(along, product));
      for (int c = 0; c < n_tensor<dim>; ++c) {
        moved.c[c] = hn::MulAdd(length, turned.c[c], moved.c[c]);
        residual.c[c] = hn::NegMulAdd(length, product.c[c], residual.c[c]);
      }
      const V before = square;
      square = double_dot(residual);
      const V turn = ratio(square, before);
      for (int c = 0; c < n_tensor<dim>; ++c)
        along.c[c] = hn::MulAdd(turn, along.c[c], residual.c[c]);
    }
    for (int c = 0; c < n_tensor<dim>; ++c) {
      driving_.c[c] = hn::Add(driving_.c[c], moved.c[c]);
      strain.c[c] = hn::MulAdd(answer, driving_.c[c], rest.c[c]);
    }
  }

  /// Of an open cell: what of the strain E - e M without pressure is across M. Dashpots on it take
  /// energy whatever M is.
  HWY_INLINE Tensor seen_deviator(const Tensor &other) const
  {
    Tensor seen = own_.stress(other, hn::Zero(d_), 1);
    const Tensor moment = still_.stress(zero_tensor<dim>(hn::Zero(d_)), hn::Set(d_, 1.), 1);
    const V along = ratio(double_dot(seen, moment), double_dot(moment));
    for (int c = 0; c < n_tensor<dim>; ++c)
      seen.c[c] = hn::NegMulAdd(along, moment.c[c], seen.c[c]);
    return seen;
  }

  /// `now`: elastic strain of the branch.
  HWY_INLINE void add_branch(int k, const Tensor &driving, const Tensor &now, Tensor &slid,
                             V &kept) const
  {
    const V share = hn::Set(d_, step_.branches[k].share);
    Tensor own;
    for (int c = 0; c < n_tensor<dim>; ++c) {
      own.c[c] = hn::Sub(driving.c[c], now.c[c]);
      slid.c[c] = hn::MulAdd(share, own.c[c], slid.c[c]);
    }
    kept = hn::MulAdd(share, double_dot(own), kept);
  }

  /// `kept`: sum of share a:a, a = d - h; `slid`: sum of share a.
  HWY_INLINE V all_kept(V kept, const Tensor &slid, const Tensor &viscous,
                        const Tensor &stress) const
  {
    V sum = hn::Sub(kept, double_dot(slid));
    const V shear = hn::Set(d_, 0.5 * twice_shear_);
    if (!step_.has_dashpot)
      return hn::Mul(shear, sum);
    Tensor damped;
    for (int c = 0; c < n_tensor<dim>; ++c)
      damped.c[c] = hn::Sub(viscous.c[c], slid.c[c]);
    V square = double_dot(damped);
    if constexpr (Own::is_open()) {
      V of_open = hn::Neg(double_dot(damped, still_.stress(damped, hn::Zero(d_), 1)));
      if (own_.is_plane_stress())
        of_open = hn::MulAdd(damped.c[2], damped.c[2], of_open);
      // The same in whole cells, but for the last bit: it must not depend on who lies beside them.
      square = hn::IfThenElse(own_.is_whole(), square, of_open);
    }
    return hn::MulAdd(shear, hn::Add(sum, square), double_dot(damped, stress));
  }

  /// 0 where nothing is left to divide.
  HWY_INLINE V ratio(V a, V b) const
  {
    const V least = hn::Set(d_, 1e-290);
    return hn::IfThenElseZero(hn::Gt(b, least), hn::Div(a, hn::Max(b, least)));
  }

  D d_;
  const ViscousStep &step_;
  const Streams &streams_;
  At at_;
  const Own &own_;
  Own still_;
  double twice_shear_;
  Tensor strain_before_, driving_before_, rated_before_;
  Tensor driving_ = zero_tensor<dim>(hn::Zero(d_)); // d
  Tensor rated_ = driving_;                         // what the dashpot resists
  Tensor rest_ = driving_; // of e_v: what of the branches does not answer d
};
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
