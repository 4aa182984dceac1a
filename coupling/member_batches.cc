// Compiled once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "coupling/member_batches.cc"
#include "core/dispatch.h"

#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway wants it.
#include "coupling/member_batches.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace ligament::coupling::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<double, lane_array_size>;
using Vector = hn::Vec<Lanes>;

HWY_INLINE Vector load(const LaneArray &lanes, int part)
{
  return hn::Load(Lanes(), lanes.value + part);
}
HWY_INLINE void store(Vector v, LaneArray &lanes, int part)
{
  hn::Store(v, Lanes(), lanes.value + part);
}

template <int dim>
HWY_INLINE Vector gather(const double *field, const typename MemberBatches<dim>::Slot &slot,
                         int part)
{
  const hn::RebindToSigned<Lanes> index;
  const hn::Rebind<std::int32_t, Lanes> half;
  return hn::GatherIndex(Lanes(), field,
                         hn::PromoteTo(index, hn::LoadU(half, slot.particle + part)));
}

HWY_INLINE void scatter(const LaneArray &values, const int *particle, int n, double *field)
{
  if (HWY_LIKELY(n == lane_array_size)) {
#pragma GCC unroll 8
    for (int l = 0; l < lane_array_size; ++l)
      field[particle[l]] = values.value[l];
    return;
  }
  for (int l = 0; l < n; ++l)
    field[particle[l]] = values.value[l];
}

template <int dim>
HWY_INLINE void take_from_nodes(const typename MemberBatches<dim>::Batch &batch,
                                const double *nodal, int c, LaneArray *at_node)
{
  for (int a = 0; a < MemberBatches<dim>::nc; ++a)
    for (int l = 0; l < lane_array_size; ++l)
      at_node[a].value[l] = nodal[batch.node[a][l] * dim + c];
}

/// Share of a kick that a damped motion takes up: 1 - damping/2.
template <int dim>
HWY_INLINE Vector response(const typename MemberBatches<dim>::Slot &slot, int part)
{
  const Lanes d;
  const hn::Rebind<float, Lanes> single;
  return hn::NegMulAdd(hn::Set(d, 0.5), hn::PromoteTo(d, hn::LoadU(single, slot.damping + part)),
                       hn::Set(d, 1));
}

template <int dim>
HWY_INLINE void kick_all(const MemberBatches<dim> &members, const FineKick<dim> &kick)
{
  constexpr int nc = MemberBatches<dim>::nc;
  const Lanes d;
  const Vector dt = hn::Set(d, kick.dt);
  for (std::size_t b = 0; b < members.batches.size(); ++b) {
    const auto &batch = members.batches[b];
    kick.cell_loss[b] = {};
    LaneArray *const sums = kick.sums + b * n_member_sums * dim * nc;
    for (int c = 0; c < dim; ++c) {
      LaneArray *const force = sums + (force_sum * dim + c) * nc,
                       *const momentum = sums + (momentum_sum * dim + c) * nc,
                       *const lost = sums + (loss_sum * dim + c) * nc;
      for (int part = 0; part < lane_array_size; part += int(hn::Lanes(d))) {
        Vector loss = load(kick.cell_loss[b], part);
        Vector f_sum[nc], p_sum[nc], l_sum[nc];
        for (int a = 0; a < nc; ++a)
          f_sum[a] = p_sum[a] = l_sum[a] = hn::Zero(d);
        for (int k = batch.begin; k < batch.end; ++k) {
          const auto &slot = members.slots[k];
          const Vector f = gather<dim>(kick.force[c], slot, part);
          const Vector old = load(kick.motion[k * dim + c], part), mass = load(slot.mass, part);
          const Vector share = response<dim>(slot, part);
          const Vector damping = hn::Mul(hn::Set(d, 2), hn::Sub(hn::Set(d, 1), share));
          const Vector push = hn::IfThenElseZero(hn::Gt(mass, hn::Zero(d)),
                                                 hn::Div(hn::Mul(hn::Mul(dt, share), f), mass));
          const Vector w = hn::Add(push, hn::NegMulAdd(damping, old, old));
          store(w, kick.motion[k * dim + c], part);
          const Vector p = hn::Mul(mass, w), sum = hn::Add(old, w),
                       l = hn::Mul(hn::Mul(mass, damping), sum);
          loss = hn::MulAdd(hn::Div(l, hn::Add(share, share)), sum, loss);
          for (int a = 0; a < nc; ++a) {
            const Vector value = load(slot.value[a], part);
            f_sum[a] = hn::MulAdd(value, f, f_sum[a]);
            p_sum[a] = hn::MulAdd(value, p, p_sum[a]);
            l_sum[a] = hn::MulAdd(value, l, l_sum[a]);
          }
        }
        for (int a = 0; a < nc; ++a) {
          store(f_sum[a], force[a], part);
          store(p_sum[a], momentum[a], part);
          store(l_sum[a], lost[a], part);
        }
        store(loss, kick.cell_loss[b], part);
      }
    }
  }
}

template <int dim>
HWY_INLINE void split_all(const MemberBatches<dim> &members, const FineSplit<dim> &split)
{
  constexpr int nc = MemberBatches<dim>::nc;
  const Lanes d;
  LaneArray carried[nc], coarse[nc], velocity;
  for (const auto &batch : members.batches)
    for (int c = 0; c < dim; ++c) {
      take_from_nodes<dim>(batch, split.carried, c, carried);
      take_from_nodes<dim>(batch, split.coarse, c, coarse);
      for (int k = batch.begin; k < batch.end; ++k) {
        const auto &slot = members.slots[k];
        for (int part = 0; part < lane_array_size; part += int(hn::Lanes(d))) {
          Vector from_carried = hn::Zero(d), v = hn::Zero(d);
          for (int a = 0; a < nc; ++a) {
            const Vector value = load(slot.value[a], part);
            from_carried = hn::MulAdd(value, load(carried[a], part), from_carried);
            v = hn::MulAdd(value, load(coarse[a], part), v);
          }
          const Vector w = hn::IfThenElseZero(hn::Gt(load(slot.mass, part), hn::Zero(d)),
                                              hn::NegMulAdd(response<dim>(slot, part), from_carried,
                                                            load(split.motion[k * dim + c], part)));
          store(w, split.motion[k * dim + c], part);
          store(hn::Add(v, w), velocity, part);
        }
        scatter(velocity, slot.particle, members.n_members[k], split.velocity[c]);
      }
    }
}

void kick_2d(const MemberBatches<2> &members, const FineKick<2> &kick)
{
  kick_all<2>(members, kick);
}
void kick_3d(const MemberBatches<3> &members, const FineKick<3> &kick)
{
  kick_all<3>(members, kick);
}
void split_2d(const MemberBatches<2> &members, const FineSplit<2> &split)
{
  split_all<2>(members, split);
}
void split_3d(const MemberBatches<3> &members, const FineSplit<3> &split)
{
  split_all<3>(members, split);
}
} // namespace ligament::coupling::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ligament::coupling
{
HWY_EXPORT(kick_2d);
HWY_EXPORT(kick_3d);
HWY_EXPORT(split_2d);
HWY_EXPORT(split_3d);

template <int dim>
void kick_members(const MemberBatches<dim> &members, const FineKick<dim> &kick)
{
  if constexpr (dim == 2)
    HWY_DYNAMIC_DISPATCH(kick_2d)(members, kick);
  else
    HWY_DYNAMIC_DISPATCH(kick_3d)(members, kick);
}

template <int dim>
void split_members(const MemberBatches<dim> &members, const FineSplit<dim> &split)
{
  if constexpr (dim == 2)
    HWY_DYNAMIC_DISPATCH(split_2d)(members, split);
  else
    HWY_DYNAMIC_DISPATCH(split_3d)(members, split);
}

template void kick_members(const MemberBatches<2> &, const FineKick<2> &);
template void kick_members(const MemberBatches<3> &, const FineKick<3> &);
template void split_members(const MemberBatches<2> &, const FineSplit<2> &);
template void split_members(const MemberBatches<3> &, const FineSplit<3> &);
} // namespace ligament::coupling
#endif
