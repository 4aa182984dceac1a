// Compiled once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dem/slice_kernel_3d.cc"
#include "core/dispatch.h"

#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway wants it.
#include "dem/laws/bending.h"
#include "dem/laws/elastic_bond.h"
#include "dem/slice_loop.h"
#include "dem/stress_loop.h"

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
/// theory.md eqs. (D6), (D8), (D8b), (D8d) for one bond of each particle in a vector. Couples are
/// summed in the particle's own axes and turned once.
class SliceLaw3d
{
  using D = SliceLanes;
  using V = hn::Vec<D>;
  using V3 = Triple<V>;

public:
  static constexpr int n_loaded = 7, n_sums = 6, pressure_place = 7;

  /// A particle's numbers and what is made of them once for all its bonds.
  struct Own
  {
    V3 u;
    Quaternion<V> q;
    V3 x, y, z; // columns of R - I
    V pressure;

    HWY_INLINE Own(D, const Record<D> &r)
        : u{r.number[0], r.number[1], r.number[2]}, q{r.number[3],
                                                      {r.number[4], r.number[5], r.number[6]}},
          pressure(r.number[7])
    {
      const auto &v = q.v;
      const V3 two = v + v;
      const V xx = hn::Mul(two.x, v.x), yy = hn::Mul(two.y, v.y), zz = hn::Mul(two.z, v.z);
      const V xy = hn::Mul(two.x, v.y), xz = hn::Mul(two.x, v.z), yz = hn::Mul(two.y, v.z);
      const V wx = hn::Mul(two.x, q.w), wy = hn::Mul(two.y, q.w), wz = hn::Mul(two.z, q.w);
      x = {hn::Neg(hn::Add(yy, zz)), hn::Add(xy, wz), hn::Sub(xz, wy)};
      y = {hn::Sub(xy, wz), hn::Neg(hn::Add(xx, zz)), hn::Add(yz, wx)};
      z = {hn::Add(xz, wy), hn::Sub(yz, wx), hn::Neg(hn::Add(xx, yy))};
    }
    /// (R - I) a
    HWY_INLINE V3 change(const V3 &a) const { return mul_add(a.x, x, mul_add(a.y, y, a.z * z)); }
  };

  struct Sums
  {
    V3 force, torque, couple;
    V excess; // largest of |force|^2 - limit^2 on a face

    HWY_INLINE Sums()
    {
      const V zero = hn::Zero(D());
      force = torque = couple = {zero, zero, zero};
      excess = zero;
    }
    HWY_INLINE bool exceeds(D d) const { return !hn::AllFalse(d, hn::Gt(excess, hn::Zero(d))); }
    HWY_INLINE std::uint32_t exceeding(D d) const
    {
      return lane_bits(d, hn::Gt(excess, hn::Zero(d)));
    }
    HWY_INLINE void store(D d, const Own &own, double (&to)[n_sums][slice_width], int lane) const
    {
      const V3 body = couple + couple;
      const V3 all = torque + (body + own.change(body));
      hn::Store(force.x, d, to[0] + lane);
      hn::Store(force.y, d, to[1] + lane);
      hn::Store(force.z, d, to[2] + lane);
      hn::Store(all.x, d, to[3] + lane);
      hn::Store(all.y, d, to[4] + lane);
      hn::Store(all.z, d, to[5] + lane);
    }
  };

  static int place(int number) { return number; }
  static const double *source(const LatticeArrays<3> &a, int number)
  {
    return number < 3 ? a.displacement[number] : a.rotation[number - 3];
  }
  static HWY_INLINE void prepare(D, double (&)[record_size][slice_width], int) {}

  template <typename Bonds>
  static HWY_INLINE void add_dilatation(D d, const Own &own, const Bonds &bond,
                                        const Record<D> &other, V &sum)
  {
    const Motion m(d, own, bond, other);
    sum = Law{hn::Zero(d), bond.geometry(d, 6)}.add_dilatation(m.du, m.a_i, sum);
  }

  /// The half of the bond's energy that is the particle's.
  template <typename Bonds>
  static HWY_INLINE void add_energy(D d, const Own &own, const Bonds &bond, const Record<D> &other,
                                    V &sum)
  {
    const Motion m(d, own, bond, other);
    const V3 v = relative_turn(own.q.w, own.q.v, m.q.w, m.q.v);
    const V vn = dot(m.lever_i - m.lever_j, v);
    sum = hn::MulAdd(hn::Set(d, 0.25), law(d, bond).twice_energy(m.du), sum);
    sum = bending(d, bond).add_half_energy(dot(v, v), hn::Mul(vn, vn), sum);
  }

  template <typename Bonds>
  static HWY_INLINE void add_forces(D d, const Own &own, const Bonds &bond, const Record<D> &other,
                                    V limit2, Sums &sums)
  {
    const Motion m(d, own, bond, other);
    const Law law = SliceLaw3d::law(d, bond);
    const V3 f = law.force(m.du, own.pressure, m.a_i, other.number[pressure_place], m.a_j);
    sums.force = sums.force + f;
    sums.torque = law.add_torque(f, m.du, own.pressure, m.a_i, sums.torque);
    const V3 distance = m.lever_i - m.lever_j;
    const V shear_r2 = hn::Mul(hn::Mul(law.shear, law.shear), dot(distance, distance));
    sums.excess = hn::Max(sums.excess, hn::NegMulAdd(limit2, shear_r2, dot(f, f)));

    // The rotation of j as i sees it, and half the couple.
    const V w = dot(own.q, m.q);
    const V3 v = relative_turn(own.q.w, own.q.v, m.q.w, m.q.v);
    sums.couple = bending(d, bond).add_half_couple(distance, w, v, sums.couple);
  }

  using Stress = StressSum3d<V>;
  using Moment = V3;
  static HWY_INLINE Moment no_moment(D d)
  {
    const V zero = hn::Zero(d);
    return {zero, zero, zero};
  }

  /// What the criterion asks of a bond: force, present normal (of any length), lever, and the force
  /// of a traction of 2G.
  struct Face
  {
    V3 force, normal, lever;
    V unit;
  };
  template <typename Bonds>
  static HWY_INLINE Face face(D d, const Own &own, const Bonds &bond, const Record<D> &other)
  {
    const Motion m(d, own, bond, other);
    const Law law = SliceLaw3d::law(d, bond);
    const V3 n = m.lever_i - m.lever_j;
    return {law.force(m.du, own.pressure, m.a_i, other.number[pressure_place], m.a_j),
            (n + n) + (own.change(n) + m.change(n)), m.a_i,
            hn::Mul(law.shear, hn::Sqrt(dot(n, n)))};
  }

  /// visit(number) of what the stress loop keeps of a face.
  template <typename OfFace, typename Visit>
  static HWY_INLINE void for_each_number(OfFace &face, Visit &&visit)
  {
    for (auto *const v : {&face.force, &face.normal}) {
      visit(v->x);
      visit(v->y);
      visit(v->z);
    }
    visit(face.unit);
  }

private:
  using Law = ElasticBond<V, V3>;
  template <typename Bonds>
  static HWY_INLINE Law law(D d, const Bonds &bond)
  {
    return {bond.stiffness(d, 0), bond.geometry(d, 6)};
  }
  template <typename Bonds>
  static HWY_INLINE SpaceBending<V> bending(D d, const Bonds &bond)
  {
    return {bond.stiffness(d, 1), bond.stiffness(d, 2)};
  }
  static HWY_INLINE V3 cross(const V3 &a, const V3 &b)
  {
    return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
            hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
  }
  struct Motion
  {
    Quaternion<V> q; // of j
    V3 lever_i, lever_j, a_i, a_j, du;

    template <typename Bonds>
    HWY_INLINE Motion(D d, const Own &own, const Bonds &bond, const Record<D> &r)
        : q{r.number[3], {r.number[4], r.number[5], r.number[6]}}, lever_i{bond.geometry(d, 0),
                                                                           bond.geometry(d, 1),
                                                                           bond.geometry(d, 2)},
          lever_j{bond.geometry(d, 3), bond.geometry(d, 4), bond.geometry(d, 5)}
    {
      const V3 change_i = own.change(lever_i), change_j = change(lever_j);
      const V3 u{r.number[0], r.number[1], r.number[2]};
      a_i = lever_i + change_i;
      a_j = lever_j + change_j;
      du = (u - own.u) + (change_j - change_i);
    }
    /// (R_j - I) a
    HWY_INLINE V3 change(const V3 &a) const
    {
      const V3 half = cross(q.v, a), t = half + half;
      return add_cross(q.v, t, q.w * t);
    }
  };
};

using Slices3d = Slices<SliceLaw3d, 3>;

void load_records_3d(const SliceSweep<3> &sweep)
{
  Slices3d(sweep).load();
}
void add_pressures_3d(const SliceSweep<3> &sweep)
{
  Slices3d(sweep).pressures();
}
void add_slice_forces_3d(const SliceSweep<3> &sweep)
{
  Slices3d(sweep).forces();
}
void add_slice_energies_3d(const SliceSweep<3> &sweep)
{
  Slices3d(sweep).energies();
}
void take_pressures_3d(const LatticeArrays<3> &arrays, const SliceTable<3> &table, double *records,
                       int begin, int end)
{
  take_pressures_of<SliceLaw3d>(arrays, table, records, begin, end);
}
void find_stresses_3d(const StressSweep<3> &sweep)
{
  StressSlices<SliceLaw3d, 3>(sweep).stresses();
}
void find_tensions_3d(const StressSweep<3> &sweep)
{
  StressSlices<SliceLaw3d, 3>(sweep).tensions();
}
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ligament::dem
{
HWY_EXPORT(load_records_3d);
HWY_EXPORT(add_pressures_3d);
HWY_EXPORT(add_slice_forces_3d);
HWY_EXPORT(add_slice_energies_3d);
HWY_EXPORT(take_pressures_3d);
HWY_EXPORT(find_stresses_3d);
HWY_EXPORT(find_tensions_3d);

void load_records(const SliceSweep<3> &sweep)
{
  HWY_DYNAMIC_DISPATCH(load_records_3d)(sweep);
}
void add_pressures(const SliceSweep<3> &sweep)
{
  HWY_DYNAMIC_DISPATCH(add_pressures_3d)(sweep);
}
void add_slice_forces(const SliceSweep<3> &sweep)
{
  HWY_DYNAMIC_DISPATCH(add_slice_forces_3d)(sweep);
}
void add_slice_energies(const SliceSweep<3> &sweep)
{
  HWY_DYNAMIC_DISPATCH(add_slice_energies_3d)(sweep);
}
void take_pressures(const LatticeArrays<3> &arrays, const SliceTable<3> &table, double *records,
                    int begin, int end)
{
  HWY_DYNAMIC_DISPATCH(take_pressures_3d)(arrays, table, records, begin, end);
}
void find_stresses(const StressSweep<3> &sweep)
{
  HWY_DYNAMIC_DISPATCH(find_stresses_3d)(sweep);
}
void find_tensions(const StressSweep<3> &sweep)
{
  HWY_DYNAMIC_DISPATCH(find_tensions_3d)(sweep);
}
} // namespace ligament::dem
#endif
