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
/// theory.md eqs. (D6), (D8), (D8b), (D8d) for one bond of each particle in a vector, with
/// (D22) where particles have strains of their own. Couples are summed in the particle's own axes and turned once.
template <bool strained_>
class SliceLaw3d
{
  using D = SliceLanes;
  using V = hn::Vec<D>;
  using V3 = Triple<V>;

public:
  static constexpr bool strained = strained_;
  using Numbers = std::conditional_t<strained, StrainedRecord<D>, Record<D>>;
  static constexpr int n_loaded = 7, n_sums = 6, pressure_place = 7;

  using Strain = SymmetricTensor<3, V>;
  static HWY_INLINE Strain strain_of(const Numbers &r)
  {
    Strain e;
    for (int c = 0; c < n_tensor<3>; ++c)
      e.c[c] = r.strain[c];
    return e;
  }
  /// e a
  static HWY_INLINE V3 moved(const Strain &e, const V3 &a)
  {
    const auto row = [&](int r) HWY_ATTR {
      return hn::MulAdd(e(r, 0), a.x, hn::MulAdd(e(r, 1), a.y, hn::Mul(e(r, 2), a.z)));
    };
    return {row(0), row(1), row(2)};
  }

  /// A particle's numbers and what is made of them once for all its bonds.
  struct Own
  {
    V3 u;
    Quaternion<V> q;
    V3 x, y, z; // columns of R - I
    V pressure;
    Strain strain; // where strained

    HWY_INLINE Own(D, const Numbers &r)
        : u{r.number[0], r.number[1], r.number[2]}, q{r.number[3],
                                                      {r.number[4], r.number[5], r.number[6]}},
          pressure(r.number[7])
    {
      if constexpr (strained)
        strain = strain_of(r);
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
    /// R^T a
    HWY_INLINE V3 turned_back(const V3 &a) const { return a + V3{dot(x, a), dot(y, a), dot(z, a)}; }
    /// R e a
    HWY_INLINE V3 stretch(const V3 &a) const
    {
      const V3 own = moved(strain, a);
      return own + change(own);
    }
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
                                        const Numbers &other, V &sum)
  {
    const Motion m(d, own, bond, other);
    sum = Law{hn::Zero(d), bond.geometry(d, 6)}.add_dilatation(m.du, m.a_i, sum);
  }

  /// S/r Du (x) A.
  template <typename Bonds>
  static HWY_INLINE void add_strain(D d, const Own &own, const Bonds &bond, const Numbers &other,
                                    V (&x)[3][3])
  {
    const Motion m(d, own, bond, other);
    const V3 lever = bond.geometry(d, 6) * m.lever_i;
    const V y[3] = {m.du.x, m.du.y, m.du.z}, a[3] = {lever.x, lever.y, lever.z};
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c)
        x[r][c] = hn::MulAdd(y[r], a[c], x[r][c]);
  }
  /// R^T x
  static HWY_INLINE void turn_back(const Own &own, V (&x)[3][3])
  {
    for (int c = 0; c < 3; ++c) {
      const V3 turned = own.turned_back({x[0][c], x[1][c], x[2][c]});
      x[0][c] = turned.x, x[1][c] = turned.y, x[2][c] = turned.z;
    }
  }

  /// The half of the bond's energy that is the particle's.
  template <typename Bonds>
  static HWY_INLINE void add_energy(D d, const Own &own, const Bonds &bond, const Numbers &other,
                                    V &sum)
  {
    const Motion m(d, own, bond, other);
    const V3 v = relative_turn(own.q.w, own.q.v, m.q.w, m.q.v);
    const V vn = dot(m.lever_i - m.lever_j, v);
    sum = hn::MulAdd(hn::Set(d, 0.25), law_of(d, bond).twice_energy(m.du), sum);
    sum = bending(d, bond).add_half_energy(dot(v, v), hn::Mul(vn, vn), sum);
  }

  template <typename Bonds>
  static HWY_INLINE void add_forces(D d, const Own &own, const Bonds &bond, const Numbers &other,
                                    V limit2, Sums &sums)
  {
    const Motion m(d, own, bond, other);
    const Law law = law_of(d, bond);
    const V3 f = law.force(m.elastic(), own.pressure, m.a_i, other.number[pressure_place], m.a_j);
    sums.force = sums.force + f;
    sums.torque = law.add_torque(f, m.du, own.pressure, m.a_i, sums.torque);
    if constexpr (strained)
      sums.torque = add_cross(m.stretch_i, law.shear * m.du, sums.torque);
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
  static HWY_INLINE Face face(D d, const Own &own, const Bonds &bond, const Numbers &other)
  {
    const Motion m(d, own, bond, other);
    const Law law = law_of(d, bond);
    const V3 n = m.lever_i - m.lever_j;
    return {law.force(m.elastic(), own.pressure, m.a_i, other.number[pressure_place], m.a_j),
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
  static HWY_INLINE Law law_of(D d, const Bonds &bond)
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
    V3 stretch_i, stretch_j; // R e A of both, where strained

    template <typename Bonds>
    HWY_INLINE Motion(D d, const Own &own, const Bonds &bond, const Numbers &r)
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
      if constexpr (strained) {
        stretch_i = own.stretch(lever_i);
        const V3 own_j = moved(strain_of(r), lever_j);
        stretch_j = own_j + change(own_j);
      }
    }
    HWY_INLINE V3 elastic() const
    {
      if constexpr (strained)
        return du - (stretch_i - stretch_j);
      else
        return du;
    }
    /// (R_j - I) a
    HWY_INLINE V3 change(const V3 &a) const
    {
      const V3 half = cross(q.v, a), t = half + half;
      return add_cross(q.v, t, q.w * t);
    }
  };
};

using Slices3d = Slices<SliceLaw3d<false>, 3>;

void load_records_3d(const SliceSweep<3> &sweep)
{
  Slices3d(sweep).load();
}
void add_pressures_3d(const SliceSweep<3> &sweep)
{
  Slices3d(sweep).pressures();
}
void add_strains_3d(const SliceSweep<3> &sweep)
{
  Slices3d(sweep).strains();
}
void load_strains_3d(const SliceSweep<3> &sweep)
{
  Slices3d(sweep).load_strains();
}
void add_slice_forces_3d(const SliceSweep<3> &sweep)
{
  if (sweep.strain_records)
    Slices<SliceLaw3d<true>, 3>(sweep).forces();
  else
    Slices3d(sweep).forces();
}
void add_slice_energies_3d(const SliceSweep<3> &sweep)
{
  Slices3d(sweep).energies();
}
void take_pressures_3d(const LatticeArrays<3> &arrays, const SliceTable<3> &table, double *records,
                       int begin, int end)
{
  take_pressures_of<SliceLaw3d<false>>(arrays, table, records, begin, end);
}
void find_stresses_3d(const StressSweep<3> &sweep)
{
  StressSlices<SliceLaw3d<false>, 3>(sweep).stresses();
}
void find_tensions_3d(const StressSweep<3> &sweep)
{
  StressSlices<SliceLaw3d<false>, 3>(sweep).tensions();
}
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ligament::dem
{
HWY_EXPORT(load_records_3d);
HWY_EXPORT(add_pressures_3d);
HWY_EXPORT(add_strains_3d);
HWY_EXPORT(load_strains_3d);
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
void add_strains(const SliceSweep<3> &sweep)
{
  HWY_DYNAMIC_DISPATCH(add_strains_3d)(sweep);
}
void load_strains(const SliceSweep<3> &sweep)
{
  HWY_DYNAMIC_DISPATCH(load_strains_3d)(sweep);
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
