// Compiled once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dem/slice_kernel_2d.cc"
#include "core/dispatch.h"

#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway wants it.
#include "dem/laws/bending.h"
#include "dem/laws/elastic_bond.h"
#include "dem/sine.h"
#include "dem/slice_loop.h"
#include "dem/stress_loop.h"

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
/// theory.md eqs. (D4), (D6), (D8), (D8b) for one bond of each particle in a vector,
/// with (D22) where particles have strains of their own.
template <bool strained_>
class SliceLaw2d
{
  using D = SliceLanes;
  using V = hn::Vec<D>;
  using V2 = Pair<V>;

public:
  static constexpr bool strained = strained_;
  using Numbers = std::conditional_t<strained, StrainedRecord<D>, Record<D>>;
  static constexpr int n_loaded = 3, n_sums = 3, pressure_place = 5;

  /// A particle's numbers.
  struct Own
  {
    V2 u;
    V cosine_minus_1, sine, angle, pressure;
    SymmetricTensor<2, V> strain; // where strained

    HWY_INLINE Own(D, const Numbers &r)
        : u{r.number[0], r.number[1]}, cosine_minus_1(r.number[2]), sine(r.number[3]),
          angle(r.number[4]), pressure(r.number[5])
    {
      if constexpr (strained)
        for (int c = 0; c < n_tensor<2>; ++c)
          strain.c[c] = r.strain[c];
    }
    /// R e a
    HWY_INLINE V2 stretch(const V2 &a) const
    {
      const V2 own{hn::MulAdd(strain(0, 0), a.x, hn::Mul(strain(0, 1), a.y)),
                   hn::MulAdd(strain(1, 0), a.x, hn::Mul(strain(1, 1), a.y))};
      return own + change(own);
    }
    /// (R - I) a
    HWY_INLINE V2 change(const V2 &a) const
    {
      return {hn::MulSub(cosine_minus_1, a.x, hn::Mul(sine, a.y)),
              hn::MulAdd(cosine_minus_1, a.y, hn::Mul(sine, a.x))};
    }
  };

  struct Sums
  {
    V2 force;
    V torque, excess; // excess: largest of |force|^2 - limit^2 on a face

    HWY_INLINE Sums()
    {
      torque = excess = hn::Zero(D());
      force = {torque, torque};
    }
    HWY_INLINE bool exceeds(D d) const { return !hn::AllFalse(d, hn::Gt(excess, hn::Zero(d))); }
    HWY_INLINE std::uint32_t exceeding(D d) const
    {
      return lane_bits(d, hn::Gt(excess, hn::Zero(d)));
    }
    HWY_INLINE void store(D d, const Own &, double (&to)[n_sums][slice_width], int lane) const
    {
      hn::Store(force.x, d, to[0] + lane);
      hn::Store(force.y, d, to[1] + lane);
      hn::Store(torque, d, to[2] + lane);
    }
  };

  static int place(int number) { return number == 2 ? 4 : number; }
  static const double *source(const LatticeArrays<2> &a, int number)
  {
    return number < 2 ? a.displacement[number] : a.rotation[0];
  }
  static HWY_INLINE void prepare(D d, double (&number)[record_size][slice_width], int lane)
  {
    V c, s;
    cosine_minus_1_and_sine(d, hn::Load(d, number[4] + lane), c, s);
    hn::Store(c, d, number[2] + lane);
    hn::Store(s, d, number[3] + lane);
  }

  template <typename Bonds>
  static HWY_INLINE void add_dilatation(D d, const Own &own, const Bonds &bond,
                                        const Numbers &other, V &sum)
  {
    const Motion m(d, own, bond, other);
    sum = Law{hn::Zero(d), bond.geometry(d, 4)}.add_dilatation(m.du, m.a_i, sum);
  }

  /// S/r Du (x) A.
  template <typename Bonds>
  static HWY_INLINE void add_strain(D d, const Own &own, const Bonds &bond, const Numbers &other,
                                    V (&x)[2][2])
  {
    const Motion m(d, own, bond, other);
    const V2 lever = bond.geometry(d, 4) * m.lever_i;
    const V y[2] = {m.du.x, m.du.y}, a[2] = {lever.x, lever.y};
    for (int r = 0; r < 2; ++r)
      for (int c = 0; c < 2; ++c)
        x[r][c] = hn::MulAdd(y[r], a[c], x[r][c]);
  }
  /// R^T x
  static HWY_INLINE void turn_back(const Own &own, V (&x)[2][2])
  {
    for (int c = 0; c < 2; ++c) {
      const V a = x[0][c], b = x[1][c];
      x[0][c] = hn::Add(a, hn::MulAdd(own.cosine_minus_1, a, hn::Mul(own.sine, b)));
      x[1][c] = hn::Add(b, hn::MulSub(own.cosine_minus_1, b, hn::Mul(own.sine, a)));
    }
  }

  /// The half of the bond's energy that is the particle's.
  template <typename Bonds>
  static HWY_INLINE void add_energy(D d, const Own &own, const Bonds &bond, const Numbers &other,
                                    V &sum)
  {
    const Motion m(d, own, bond, other);
    const V turn = hn::Sub(m.other.angle, own.angle);
    const V twice =
        bending(d, bond).add_twice_energy(hn::Mul(turn, turn), law_of(d, bond).twice_energy(m.du));
    sum = hn::MulAdd(hn::Set(d, 0.25), twice, sum);
  }

  template <typename Bonds>
  static HWY_INLINE void add_forces(D d, const Own &own, const Bonds &bond, const Numbers &other,
                                    V limit2, Sums &sums)
  {
    const Motion m(d, own, bond, other);
    const Law law = law_of(d, bond);
    const V2 f = law.force(m.elastic(), own.pressure, m.a_i, m.other.pressure, m.a_j);
    sums.force = sums.force + f;
    sums.torque = law.add_torque(f, m.du, own.pressure, m.a_i, sums.torque);
    if constexpr (strained)
      sums.torque = add_cross(m.stretch_i, law.shear * m.du, sums.torque);
    sums.torque = bending(d, bond).add_torque(hn::Sub(m.other.angle, own.angle), sums.torque);
    const V2 distance = m.lever_i - m.lever_j;
    const V shear_r2 = hn::Mul(hn::Mul(law.shear, law.shear), dot(distance, distance));
    sums.excess = hn::Max(sums.excess, hn::NegMulAdd(limit2, shear_r2, dot(f, f)));
  }

  using Stress = StressSum2d<V>;
  using Moment = V;
  static HWY_INLINE Moment no_moment(D d)
  {
    const V zero = hn::Zero(d);
    return zero;
  }

  /// What the criterion asks of a bond: force, present normal (of any length), lever, and the force
  /// of a traction of 2G.
  struct Face
  {
    V2 force, normal, lever;
    V unit;
  };
  template <typename Bonds>
  static HWY_INLINE Face face(D d, const Own &own, const Bonds &bond, const Numbers &other)
  {
    const Motion m(d, own, bond, other);
    const Law law = law_of(d, bond);
    const V2 n = m.lever_i - m.lever_j;
    return {law.force(m.elastic(), own.pressure, m.a_i, m.other.pressure, m.a_j),
            (n + n) + (own.change(n) + m.other.change(n)), m.a_i,
            hn::Mul(law.shear, hn::Sqrt(dot(n, n)))};
  }

  /// visit(number) of what the stress loop keeps of a face.
  template <typename OfFace, typename Visit>
  static HWY_INLINE void for_each_number(OfFace &face, Visit &&visit)
  {
    for (auto *const v : {&face.force, &face.normal}) {
      visit(v->x);
      visit(v->y);
    }
    visit(face.unit);
  }

private:
  using Law = ElasticBond<V, V2>;
  template <typename Bonds>
  static HWY_INLINE Law law_of(D d, const Bonds &bond)
  {
    return {bond.stiffness(d, 0), bond.geometry(d, 4)};
  }
  template <typename Bonds>
  static HWY_INLINE PlaneBending<V> bending(D d, const Bonds &bond)
  {
    return {bond.stiffness(d, 1)};
  }

  struct Motion
  {
    Own other;
    V2 lever_i, lever_j, a_i, a_j, du;
    V2 stretch_i, stretch_j; // R e A of both, where strained

    template <typename Bonds>
    HWY_INLINE Motion(D d, const Own &own, const Bonds &bond, const Numbers &r)
        : other(d, r), lever_i{bond.geometry(d, 0), bond.geometry(d, 1)}, lever_j{
                                                                              bond.geometry(d, 2),
                                                                              bond.geometry(d, 3)}
    {
      const V2 change_i = own.change(lever_i), change_j = other.change(lever_j);
      a_i = lever_i + change_i;
      a_j = lever_j + change_j;
      du = (other.u - own.u) + (change_j - change_i);
      if constexpr (strained) {
        stretch_i = own.stretch(lever_i);
        stretch_j = other.stretch(lever_j);
      }
    }
    HWY_INLINE V2 elastic() const
    {
      if constexpr (strained)
        return du - (stretch_i - stretch_j);
      else
        return du;
    }
  };
};

using Slices2d = Slices<SliceLaw2d<false>, 2>;

void load_records_2d(const SliceSweep<2> &sweep)
{
  Slices2d(sweep).load();
}
void add_pressures_2d(const SliceSweep<2> &sweep)
{
  Slices2d(sweep).pressures();
}
void add_strains_2d(const SliceSweep<2> &sweep)
{
  Slices2d(sweep).strains();
}
void load_strains_2d(const SliceSweep<2> &sweep)
{
  Slices2d(sweep).load_strains();
}
void add_slice_forces_2d(const SliceSweep<2> &sweep)
{
  if (sweep.strain_records)
    Slices<SliceLaw2d<true>, 2>(sweep).forces();
  else
    Slices2d(sweep).forces();
}
void add_slice_energies_2d(const SliceSweep<2> &sweep)
{
  Slices2d(sweep).energies();
}
void take_pressures_2d(const LatticeArrays<2> &arrays, const SliceTable<2> &table, double *records,
                       int begin, int end)
{
  take_pressures_of<SliceLaw2d<false>>(arrays, table, records, begin, end);
}
void find_stresses_2d(const StressSweep<2> &sweep)
{
  StressSlices<SliceLaw2d<false>, 2>(sweep).stresses();
}
void find_tensions_2d(const StressSweep<2> &sweep)
{
  StressSlices<SliceLaw2d<false>, 2>(sweep).tensions();
}
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ligament::dem
{
HWY_EXPORT(load_records_2d);
HWY_EXPORT(add_pressures_2d);
HWY_EXPORT(add_strains_2d);
HWY_EXPORT(load_strains_2d);
HWY_EXPORT(add_slice_forces_2d);
HWY_EXPORT(add_slice_energies_2d);
HWY_EXPORT(take_pressures_2d);
HWY_EXPORT(find_stresses_2d);
HWY_EXPORT(find_tensions_2d);

void load_records(const SliceSweep<2> &sweep)
{
  HWY_DYNAMIC_DISPATCH(load_records_2d)(sweep);
}
void add_pressures(const SliceSweep<2> &sweep)
{
  HWY_DYNAMIC_DISPATCH(add_pressures_2d)(sweep);
}
void add_strains(const SliceSweep<2> &sweep)
{
  HWY_DYNAMIC_DISPATCH(add_strains_2d)(sweep);
}
void load_strains(const SliceSweep<2> &sweep)
{
  HWY_DYNAMIC_DISPATCH(load_strains_2d)(sweep);
}
void add_slice_forces(const SliceSweep<2> &sweep)
{
  HWY_DYNAMIC_DISPATCH(add_slice_forces_2d)(sweep);
}
void add_slice_energies(const SliceSweep<2> &sweep)
{
  HWY_DYNAMIC_DISPATCH(add_slice_energies_2d)(sweep);
}
void take_pressures(const LatticeArrays<2> &arrays, const SliceTable<2> &table, double *records,
                    int begin, int end)
{
  HWY_DYNAMIC_DISPATCH(take_pressures_2d)(arrays, table, records, begin, end);
}
void find_stresses(const StressSweep<2> &sweep)
{
  HWY_DYNAMIC_DISPATCH(find_stresses_2d)(sweep);
}
void find_tensions(const StressSweep<2> &sweep)
{
  HWY_DYNAMIC_DISPATCH(find_tensions_2d)(sweep);
}
} // namespace ligament::dem
#endif
