#include "dem/lattice_rows.h"

#include <cmath>

namespace ligament::dem
{
namespace
{
using Direction = DirectionConstants<2>;

/// theory.md eqs. (D6), (D8b) for the two neighbours along one direction. The traction of a bond is
/// formed by the same operations in the same order from either end: pair forces cancel exactly.
struct Bonds2d
{
  struct Own
  {
    double ux, uy, c, s, angle, pressure;
  };
  struct Sum
  {
    double fx = 0, fy = 0, torque = 0;
    int exceeded = 0;
  };

  static LIGAMENT_INLINE Own own(const LatticeArrays<2> &a, long i)
  {
    return {a.displacement[0][i], a.displacement[1][i], a.turn[1][i],
            a.turn[2][i],         a.turn[0][i],         a.pressure[i]};
  }

  /// (R - I) n
  static LIGAMENT_INLINE void change(double c, double s, const Direction &d, double &x, double &y)
  {
    x = c * d.normal[0] - s * d.normal[1];
    y = c * d.normal[1] + s * d.normal[0];
  }

  /// Changes h of the normals and relative displacements to the forward (a) and backward (c)
  /// neighbour, zero where the bond doesn't carry.
  struct Motion
  {
    double hx, hy, fx, fy, bx, by, ax, ay, cx, cy;

    template <bool full>
    static LIGAMENT_INLINE Motion of(const LatticeArrays<2> &a, const Direction &d, const Own &o,
                                     const Neighbours &n)
    {
      Motion m;
      change(o.c, o.s, d, m.hx, m.hy);
      change(a.turn[1][n.forward], a.turn[2][n.forward], d, m.fx, m.fy);
      change(a.turn[1][n.backward], a.turn[2][n.backward], d, m.bx, m.by);
      m.ax = (a.displacement[0][n.forward] - o.ux) - d.half * (m.hx + m.fx);
      m.ay = (a.displacement[1][n.forward] - o.uy) - d.half * (m.hy + m.fy);
      m.cx = (o.ux - a.displacement[0][n.backward]) - d.half * (m.bx + m.hx);
      m.cy = (o.uy - a.displacement[1][n.backward]) - d.half * (m.by + m.hy);
      if (!full) {
        m.ax *= n.w_forward, m.ay *= n.w_forward;
        m.cx *= n.w_backward, m.cy *= n.w_backward;
      }
      return m;
    }
  };

  template <bool full>
  static LIGAMENT_INLINE double dilatation(const LatticeArrays<2> &a, const Direction &d,
                                           const Own &o, const Neighbours &n)
  {
    const Motion m = Motion::of<full>(a, d, o, n);
    return d.area_r * d.half *
           ((d.normal[0] + m.hx) * (m.ax + m.cx) + (d.normal[1] + m.hy) * (m.ay + m.cy));
  }

  template <bool full>
  static LIGAMENT_INLINE void force(const LatticeArrays<2> &a, const Direction &d, const Own &o,
                                    const Neighbours &n, Sum &sum)
  {
    const Motion m = Motion::of<full>(a, d, o, n);
    const double hx = d.normal[0] + m.hx, hy = d.normal[1] + m.hy;
    const double fx = d.normal[0] + m.fx, fy = d.normal[1] + m.fy;
    const double bx = d.normal[0] + m.bx, by = d.normal[1] + m.by;
    const double p = o.pressure, pf = a.pressure[n.forward], pb = a.pressure[n.backward];
    const double volumetric = d.area_r * d.half;
    double vf = volumetric, vb = volumetric, kf = d.bending, kb = d.bending;
    if (!full)
      vf *= n.w_forward, vb *= n.w_backward, kf *= n.w_forward, kb *= n.w_backward;
    const double tx = d.shear * m.ax + vf * (p * hx + pf * fx);
    const double ty = d.shear * m.ay + vf * (p * hy + pf * fy);
    const double sx = d.shear * m.cx + vb * (pb * bx + p * hx);
    const double sy = d.shear * m.cy + vb * (pb * by + p * hy);
    sum.fx += tx - sx;
    sum.fy += ty - sy;
    const double kp = d.area_r * p;
    const double gx = (tx + sx) - kp * (m.ax + m.cx), gy = (ty + sy) - kp * (m.ay + m.cy);
    sum.torque += d.half * (hx * gy - hy * gx) +
                  (kf * (a.turn[0][n.forward] - o.angle) - kb * (o.angle - a.turn[0][n.backward]));
    const double mx = hx + fx, my = hy + fy, tension = tx * mx + ty * my;
    sum.exceeded |= tension * std::abs(tension) >= d.limit2 * (mx * mx + my * my) ? 1 : 0;
  }

  static LIGAMENT_INLINE void store(const LatticeArrays<2> &a, const Own &, long i, const Sum &sum)
  {
    a.force[0][i] = sum.fx;
    a.force[1][i] = sum.fy;
    a.torque[0][i] = sum.torque;
  }
};

using Sweep = RowSweep<2>;
LIGAMENT_DISPATCH void dilatation_2(const Sweep &s)
{
  sweep_dilatation<Bonds2d, 2>(s);
}
LIGAMENT_DISPATCH void dilatation_3(const Sweep &s)
{
  sweep_dilatation<Bonds2d, 3>(s);
}
LIGAMENT_DISPATCH void forces_2(const Sweep &s)
{
  sweep_forces<Bonds2d, 2>(s);
}
LIGAMENT_DISPATCH void forces_3(const Sweep &s)
{
  sweep_forces<Bonds2d, 3>(s);
}
} // namespace

template <>
void LatticeKernel<2>::sweep_dilatation_of(const RowSweep<2> &sweep) const
{
  n_directions_ == 2 ? dilatation_2(sweep) : dilatation_3(sweep);
}

template <>
void LatticeKernel<2>::sweep_forces_of(const RowSweep<2> &sweep) const
{
  n_directions_ == 2 ? forces_2(sweep) : forces_3(sweep);
}
} // namespace ligament::dem
