// Compiled once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "coupling/member_lanes.cc"
#include "core/dispatch.h"

#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway wants it.
#include "coupling/member_lanes.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace ligament::coupling::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<double, octet_size>;
using Vector = hn::Vec<Lanes>;

HWY_INLINE Vector load(const Octet &octet, int part)
{
  return hn::Load(Lanes(), octet.value + part);
}
HWY_INLINE void store(Vector v, Octet &octet, int part)
{
  hn::Store(v, Lanes(), octet.value + part);
}

template <int dim>
HWY_INLINE Vector gather(const double *field, const typename MemberLanes<dim>::Slot &slot, int part)
{
  const hn::RebindToSigned<Lanes> index;
  const hn::Rebind<std::int32_t, Lanes> half;
  return hn::GatherIndex(Lanes(), field,
                         hn::PromoteTo(index, hn::LoadU(half, slot.particle + part)));
}

template <int dim>
HWY_INLINE void scatter(const Octet &values, const typename MemberLanes<dim>::Slot &slot,
                        double *field)
{
  if (HWY_LIKELY(slot.n_members == octet_size)) {
#pragma GCC unroll 8
    for (int l = 0; l < octet_size; ++l)
      field[slot.particle[l]] = values.value[l];
    return;
  }
  for (int l = 0; l < slot.n_members; ++l)
    field[slot.particle[l]] = values.value[l];
}

/// nodal += what the lanes have summed for the nodes of their cells, component c.
template <int dim>
HWY_INLINE void add_to_nodes(const typename MemberLanes<dim>::Batch &batch, const Octet *sum, int c,
                             double *nodal)
{
  for (int a = 0; a < MemberLanes<dim>::nc; ++a)
    for (int l = 0; l < batch.n_cells; ++l)
      nodal[batch.node[a][l] * dim + c] += sum[a].value[l];
}

template <int dim>
HWY_INLINE void take_from_nodes(const typename MemberLanes<dim>::Batch &batch, const double *nodal,
                                int c, Octet *at_node)
{
  for (int a = 0; a < MemberLanes<dim>::nc; ++a)
    for (int l = 0; l < octet_size; ++l)
      at_node[a].value[l] = nodal[batch.node[a][l] * dim + c];
}

template <int dim>
HWY_INLINE void kick_all(const MemberLanes<dim> &members, const FineKick<dim> &kick)
{
  constexpr int nc = MemberLanes<dim>::nc;
  const Lanes d;
  const Vector dt = hn::Set(d, kick.dt);
  Octet force[nc], momentum[nc];
  for (const auto &batch : members.batches)
    for (int c = 0; c < dim; ++c) {
      for (int part = 0; part < octet_size; part += int(hn::Lanes(d))) {
        Vector f_sum[nc], p_sum[nc];
        for (int a = 0; a < nc; ++a)
          f_sum[a] = p_sum[a] = hn::Zero(d);
        for (int k = batch.begin; k < batch.end; ++k) {
          const auto &slot = members.slots[k];
          const Vector f = gather<dim>(kick.force[c], slot, part);
          const Vector old = load(kick.old_motion[k * dim + c], part);
          const Vector w = hn::MulAdd(hn::Mul(dt, load(slot.inverse_mass, part)), f,
                                      hn::NegMulAdd(load(slot.damping, part), old, old));
          store(w, kick.motion[k * dim + c], part);
          const Vector p = hn::Mul(load(slot.mass, part), w);
          for (int a = 0; a < nc; ++a) {
            const Vector value = load(slot.value[a], part);
            f_sum[a] = hn::MulAdd(value, f, f_sum[a]);
            p_sum[a] = hn::MulAdd(value, p, p_sum[a]);
          }
        }
        for (int a = 0; a < nc; ++a) {
          store(f_sum[a], force[a], part);
          store(p_sum[a], momentum[a], part);
        }
      }
      add_to_nodes<dim>(batch, force, c, kick.nodal_force);
      add_to_nodes<dim>(batch, momentum, c, kick.nodal_momentum);
    }
}

template <int dim>
HWY_INLINE double split_all(const MemberLanes<dim> &members, const FineSplit<dim> &split)
{
  constexpr int nc = MemberLanes<dim>::nc;
  const Lanes d;
  Octet carried[nc], coarse[nc], velocity;
  Vector loss = hn::Zero(d);
  for (const auto &batch : members.batches)
    for (int c = 0; c < dim; ++c) {
      take_from_nodes<dim>(batch, split.carried, c, carried);
      take_from_nodes<dim>(batch, split.coarse, c, coarse);
      for (int k = batch.begin; k < batch.end; ++k) {
        const auto &slot = members.slots[k];
        for (int part = 0; part < octet_size; part += int(hn::Lanes(d))) {
          Vector from_carried = hn::Zero(d), v = hn::Zero(d);
          for (int a = 0; a < nc; ++a) {
            const Vector value = load(slot.value[a], part);
            from_carried = hn::MulAdd(value, load(carried[a], part), from_carried);
            v = hn::MulAdd(value, load(coarse[a], part), v);
          }
          const Vector mass = load(slot.mass, part),
                       old = load(split.old_motion[k * dim + c], part);
          const Vector w =
              hn::IfThenElseZero(hn::Gt(mass, hn::Zero(d)),
                                 hn::Sub(load(split.motion[k * dim + c], part), from_carried));
          loss = hn::MulAdd(hn::Mul(hn::Mul(load(slot.damping, part), mass), old), hn::Add(old, w),
                            loss);
          store(w, split.motion[k * dim + c], part);
          store(hn::Add(v, w), velocity, part);
        }
        scatter<dim>(velocity, slot, split.velocity[c]);
      }
    }
  return hn::GetLane(hn::SumOfLanes(d, loss));
}

void kick_2d(const MemberLanes<2> &members, const FineKick<2> &kick)
{
  kick_all<2>(members, kick);
}
void kick_3d(const MemberLanes<3> &members, const FineKick<3> &kick)
{
  kick_all<3>(members, kick);
}
double split_2d(const MemberLanes<2> &members, const FineSplit<2> &split)
{
  return split_all<2>(members, split);
}
double split_3d(const MemberLanes<3> &members, const FineSplit<3> &split)
{
  return split_all<3>(members, split);
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
void kick_members(const MemberLanes<dim> &members, const FineKick<dim> &kick)
{
  if constexpr (dim == 2)
    HWY_DYNAMIC_DISPATCH(kick_2d)(members, kick);
  else
    HWY_DYNAMIC_DISPATCH(kick_3d)(members, kick);
}

template <int dim>
double split_members(const MemberLanes<dim> &members, const FineSplit<dim> &split)
{
  if constexpr (dim == 2)
    return HWY_DYNAMIC_DISPATCH(split_2d)(members, split);
  else
    return HWY_DYNAMIC_DISPATCH(split_3d)(members, split);
}

template void kick_members(const MemberLanes<2> &, const FineKick<2> &);
template void kick_members(const MemberLanes<3> &, const FineKick<3> &);
template double split_members(const MemberLanes<2> &, const FineSplit<2> &);
template double split_members(const MemberLanes<3> &, const FineSplit<3> &);
} // namespace ligament::coupling
#endif
