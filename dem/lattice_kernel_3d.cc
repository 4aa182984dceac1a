#include "dem/lattice_rows.h"

#include <cmath>

namespace ligament::dem
{
namespace
{
using Direction = DirectionConstants<3>;

struct V
{
  double x, y, z;
};
LIGAMENT_INLINE V operator+(const V &a, const V &b)
{
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
LIGAMENT_INLINE V operator-(const V &a, const V &b)
{
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
LIGAMENT_INLINE V operator*(double s, const V &a)
{
  return {s * a.x, s * a.y, s * a.z};
}
LIGAMENT_INLINE double dot(const V &a, const V &b)
{
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
LIGAMENT_INLINE V times(const V &a, const V &b)
{
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Unit quaternion (w, v).
struct Q
{
  double w;
  V v;
};

/// theory.md eqs. (D4), (D6), (D8b) for the two neighbours along one direction. The traction of a
/// bond is formed by the same operations in the same order from either end: pair forces cancel
/// exactly.
struct Bonds3d
{
  struct Own
  {
    V u;
    Q q;
    double pressure;
  };
  struct Sum
  {
    V force{0, 0, 0}, torque{0, 0, 0};
    V bending{0, 0, 0}; // in the axes of the particle
    int exceeded = 0;
  };

  static LIGAMENT_INLINE V displacement(const LatticeArrays<3> &a, long i)
  {
    return {a.displacement[0][i], a.displacement[1][i], a.displacement[2][i]};
  }
  static LIGAMENT_INLINE Q quaternion(const LatticeArrays<3> &a, long i)
  {
    return {a.turn[0][i], {a.turn[1][i], a.turn[2][i], a.turn[3][i]}};
  }
  static LIGAMENT_INLINE Own own(const LatticeArrays<3> &a, long i)
  {
    return {displacement(a, i), quaternion(a, i), a.pressure[i]};
  }
  static LIGAMENT_INLINE V normal(const Direction &d)
  {
    return {d.normal[0], d.normal[1], d.normal[2]};
  }
  /// (R - I) n
  static LIGAMENT_INLINE V change(const Q &q, const V &n)
  {
    const V c = times(q.v, n), t = c + c;
    return q.w * t + times(q.v, t);
  }

  /// -(k_b, k_t part of the) torque on the neighbour in the axes of i, halved: w K v + v x K v.
  static LIGAMENT_INLINE V bend(const Q &i, const Q &j, const Direction &d, const V &n)
  {
    const double w = i.w * j.w + dot(i.v, j.v);
    const V v = (i.w * j.v - j.w * i.v) - times(i.v, j.v);
    const double s = d.twist * dot(n, v);
    return (d.bending * w) * v + s * (w * n + times(v, n));
  }

  template <bool full>
  static LIGAMENT_INLINE double dilatation(const LatticeArrays<3> &a, const Direction &d,
                                           const Own &o, const Neighbours &n)
  {
    const V nn = normal(d), h = change(o.q, nn);
    const V hf = change(quaternion(a, n.forward), nn), hb = change(quaternion(a, n.backward), nn);
    V duf = (displacement(a, n.forward) - o.u) - d.half * (h + hf);
    V dub = (o.u - displacement(a, n.backward)) - d.half * (hb + h);
    if (!full)
      duf = n.w_forward * duf, dub = n.w_backward * dub;
    return d.area_r * d.half * dot(nn + h, duf + dub);
  }

  template <bool full>
  static LIGAMENT_INLINE void force(const LatticeArrays<3> &a, const Direction &d, const Own &o,
                                    const Neighbours &n, Sum &sum)
  {
    const V nn = normal(d), h = change(o.q, nn);
    const Q qf = quaternion(a, n.forward), qb = quaternion(a, n.backward);
    const V hf = change(qf, nn), hb = change(qb, nn);
    V duf = (displacement(a, n.forward) - o.u) - d.half * (h + hf);
    V dub = (o.u - displacement(a, n.backward)) - d.half * (hb + h);
    const double volumetric = d.area_r * d.half;
    double vf = volumetric, vb = volumetric;
    V bf = bend(o.q, qf, d, nn), bb = bend(o.q, qb, d, nn);
    if (!full) {
      duf = n.w_forward * duf, dub = n.w_backward * dub;
      bf = n.w_forward * bf, bb = n.w_backward * bb;
      vf *= n.w_forward, vb *= n.w_backward;
    }
    const V ai = nn + h, af = nn + hf, ab = nn + hb;
    const double p = o.pressure;
    const V tf = d.shear * duf + vf * (p * ai + a.pressure[n.forward] * af);
    const V tb = d.shear * dub + vb * (a.pressure[n.backward] * ab + p * ai);
    sum.force = sum.force + (tf - tb);
    const V g = (tf + tb) - (d.area_r * p) * (duf + dub);
    sum.torque = sum.torque + d.half * times(ai, g);
    sum.bending = sum.bending + (bf + bb);
    const V m = ai + af;
    const double tension = dot(tf, m);
    sum.exceeded |= tension * std::abs(tension) >= d.limit2 * dot(m, m) ? 1 : 0;
  }

  static LIGAMENT_INLINE void store(const LatticeArrays<3> &a, const Own &o, long i, const Sum &sum)
  {
    const V body = sum.bending + sum.bending;
    const V t = sum.torque + (body + change(o.q, body));
    a.force[0][i] = sum.force.x;
    a.force[1][i] = sum.force.y;
    a.force[2][i] = sum.force.z;
    a.torque[0][i] = t.x;
    a.torque[1][i] = t.y;
    a.torque[2][i] = t.z;
  }
};

using Sweep = RowSweep<3>;
LIGAMENT_DISPATCH void dilatation_3(const Sweep &s)
{
  sweep_dilatation<Bonds3d, 3>(s);
}
LIGAMENT_DISPATCH void dilatation_6(const Sweep &s)
{
  sweep_dilatation<Bonds3d, 6>(s);
}
LIGAMENT_DISPATCH void forces_3(const Sweep &s)
{
  sweep_forces<Bonds3d, 3>(s);
}
LIGAMENT_DISPATCH void forces_6(const Sweep &s)
{
  sweep_forces<Bonds3d, 6>(s);
}
} // namespace

template <>
void LatticeKernel<3>::sweep_dilatation_of(const RowSweep<3> &sweep) const
{
  n_directions_ == 3 ? dilatation_3(sweep) : dilatation_6(sweep);
}

template <>
void LatticeKernel<3>::sweep_forces_of(const RowSweep<3> &sweep) const
{
  n_directions_ == 3 ? forces_3(sweep) : forces_6(sweep);
}
} // namespace ligament::dem
