// Averaged stresses of vectors of particles, and the bound of the tension of their faces that
// follows from them, theory.md eq. (D12d); compiled once for every instruction set.
#if defined(LIGAMENT_DEM_STRESS_BOUND_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LIGAMENT_DEM_STRESS_BOUND_H
#undef LIGAMENT_DEM_STRESS_BOUND_H
#else
#define LIGAMENT_DEM_STRESS_BOUND_H
#endif

#include "dem/lane_vectors.h"
#include "dem/stress_measure.h"

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
/// Sums of products of levers and forces. Off the diagonal one of two products is summed: the other
/// follows from the sum of the moments a x f, which the kernels have anyway.
template <typename V>
struct StressSum2d
{
  V xx, yy, xy;

  template <typename D>
  HWY_INLINE explicit StressSum2d(D d) : xx(hn::Zero(d)), yy(xx), xy(xx)
  {
  }
  /// Of components in Voigt order.
  template <typename Component>
  static HWY_INLINE StressSum2d of(Component &&component)
  {
    StressSum2d s{hn::DFromV<V>()};
    s.xx = component(0);
    s.yy = component(1);
    s.xy = component(2);
    return s;
  }
  template <typename Visit>
  HWY_INLINE void for_each(Visit &&visit) const
  {
    visit(xx);
    visit(yy);
    visit(xy);
  }
  HWY_INLINE void add(const V *component)
  {
    xx = hn::Add(xx, component[0]);
    yy = hn::Add(yy, component[1]);
    xy = hn::Add(xy, component[2]);
  }
  HWY_INLINE void add(const Pair<V> &a, const Pair<V> &f)
  {
    xx = hn::MulAdd(a.x, f.x, xx);
    yy = hn::MulAdd(a.y, f.y, yy);
    xy = hn::MulAdd(a.x, f.y, xy);
  }
  /// The symmetric part times factor, from the sum of a x f.
  HWY_INLINE void finish(V moment, V factor)
  {
    xy = hn::Mul(factor, hn::NegMulAdd(hn::Set(hn::DFromV<V>(), 0.5), moment, xy));
    xx = hn::Mul(factor, xx);
    yy = hn::Mul(factor, yy);
  }
  HWY_INLINE Pair<V> times(const Pair<V> &n) const
  {
    return {hn::MulAdd(xx, n.x, hn::Mul(xy, n.y)), hn::MulAdd(xy, n.x, hn::Mul(yy, n.y))};
  }
  /// Sum of the squares of all components.
  HWY_INLINE V square() const
  {
    return hn::MulAdd(xx, xx, hn::MulAdd(yy, yy, hn::Mul(hn::Add(xy, xy), xy)));
  }
  HWY_INLINE V trace() const { return hn::Add(xx, yy); }
  HWY_INLINE V smallest_principal() const { return hn::Sub(trace(), largest_principal()); }
  HWY_INLINE V largest_principal() const
  {
    const V half = hn::Set(hn::DFromV<V>(), 0.5);
    const V difference = hn::Mul(half, hn::Sub(xx, yy));
    return hn::MulAdd(half, hn::Add(xx, yy),
                      hn::Sqrt(hn::MulAdd(difference, difference, hn::Mul(xy, xy))));
  }
  /// Unit vector along the largest principal stress, and by how many rad it may be wrong.
  HWY_INLINE Pair<V> principal_direction(V &doubt) const
  {
    const hn::DFromV<V> d;
    const V zero = hn::Zero(d), half = hn::Set(d, 0.5);
    const V difference = hn::Mul(half, hn::Sub(xx, yy));
    const V radius = hn::Sqrt(hn::MulAdd(difference, difference, hn::Mul(xy, xy)));
    const V sum = hn::Add(radius, hn::Abs(difference));
    const auto along_x = hn::Ge(difference, zero);
    const Pair<V> e{hn::IfThenElse(along_x, sum, xy), hn::IfThenElse(along_x, xy, sum)};
    constexpr double round_off = 1e-13;
    doubt = hn::Div(hn::Mul(hn::Set(d, round_off), hn::Sqrt(square())), radius);
    return hn::Div(hn::Set(d, 1.), hn::Sqrt(add_dot(e, e, zero))) * e;
  }
};

template <typename V>
struct StressSum3d
{
  V xx, yy, zz, yz, xz, xy;

  template <typename D>
  HWY_INLINE explicit StressSum3d(D d) : xx(hn::Zero(d)), yy(xx), zz(xx), yz(xx), xz(xx), xy(xx)
  {
  }
  /// Of components in Voigt order.
  template <typename Component>
  static HWY_INLINE StressSum3d of(Component &&component)
  {
    StressSum3d s{hn::DFromV<V>()};
    s.xx = component(0);
    s.yy = component(1);
    s.zz = component(2);
    s.yz = component(3);
    s.xz = component(4);
    s.xy = component(5);
    return s;
  }
  template <typename Visit>
  HWY_INLINE void for_each(Visit &&visit) const
  {
    visit(xx);
    visit(yy);
    visit(zz);
    visit(yz);
    visit(xz);
    visit(xy);
  }
  HWY_INLINE void add(const V *component)
  {
    xx = hn::Add(xx, component[0]);
    yy = hn::Add(yy, component[1]);
    zz = hn::Add(zz, component[2]);
    yz = hn::Add(yz, component[3]);
    xz = hn::Add(xz, component[4]);
    xy = hn::Add(xy, component[5]);
  }
  HWY_INLINE void add(const Triple<V> &a, const Triple<V> &f)
  {
    xx = hn::MulAdd(a.x, f.x, xx);
    yy = hn::MulAdd(a.y, f.y, yy);
    zz = hn::MulAdd(a.z, f.z, zz);
    yz = hn::MulAdd(a.y, f.z, yz);
    xz = hn::MulAdd(a.x, f.z, xz);
    xy = hn::MulAdd(a.x, f.y, xy);
  }
  HWY_INLINE void finish(const Triple<V> &moment, V factor)
  {
    const V half = hn::Set(hn::DFromV<V>(), 0.5);
    xx = hn::Mul(factor, xx);
    yy = hn::Mul(factor, yy);
    zz = hn::Mul(factor, zz);
    yz = hn::Mul(factor, hn::NegMulAdd(half, moment.x, yz));
    xz = hn::Mul(factor, hn::MulAdd(half, moment.y, xz));
    xy = hn::Mul(factor, hn::NegMulAdd(half, moment.z, xy));
  }
  HWY_INLINE Triple<V> times(const Triple<V> &n) const
  {
    return {hn::MulAdd(xx, n.x, hn::MulAdd(xy, n.y, hn::Mul(xz, n.z))),
            hn::MulAdd(xy, n.x, hn::MulAdd(yy, n.y, hn::Mul(yz, n.z))),
            hn::MulAdd(xz, n.x, hn::MulAdd(yz, n.y, hn::Mul(zz, n.z)))};
  }
  HWY_INLINE V square() const
  {
    const V off = hn::MulAdd(yz, yz, hn::MulAdd(xz, xz, hn::Mul(xy, xy)));
    return hn::MulAdd(xx, xx, hn::MulAdd(yy, yy, hn::MulAdd(zz, zz, hn::Add(off, off))));
  }
  HWY_INLINE V trace() const { return hn::Add(xx, hn::Add(yy, zz)); }
  /// Or a little less.
  HWY_INLINE V smallest_principal() const
  {
    StressSum3d negative{hn::DFromV<V>()};
    negative.xx = hn::Neg(xx);
    negative.yy = hn::Neg(yy);
    negative.zz = hn::Neg(zz);
    negative.yz = hn::Neg(yz);
    negative.xz = hn::Neg(xz);
    negative.xy = hn::Neg(xy);
    return hn::Neg(negative.largest_principal());
  }
  /// Or a little more: the characteristic polynomial is convex above its largest root, which
  /// Newton's steps therefore never pass.
  template <int steps = 3>
  HWY_INLINE V largest_principal() const
  {
    const hn::DFromV<V> d;
    const V mean = hn::Mul(hn::Set(d, 1 / 3.), hn::Add(xx, hn::Add(yy, zz)));
    const V a = hn::Sub(xx, mean), b = hn::Sub(yy, mean), c = hn::Sub(zz, mean);
    const V yz2 = hn::Mul(yz, yz), xz2 = hn::Mul(xz, xz), xy2 = hn::Mul(xy, xy);
    const V squares = hn::MulAdd(a, a, hn::MulAdd(b, b, hn::Mul(c, c)));
    const V j2 = hn::MulAdd(hn::Set(d, 0.5), squares, hn::Add(yz2, hn::Add(xz2, xy2)));
    const V products = hn::MulAdd(a, hn::Mul(b, c), hn::Mul(hn::Add(yz, yz), hn::Mul(xz, xy)));
    const V j3 = hn::NegMulAdd(a, yz2, hn::NegMulAdd(b, xz2, hn::NegMulAdd(c, xy2, products)));
    V x = hn::Sqrt(hn::Mul(hn::Set(d, 4 / 3.), j2));
    for (int step = 0; step < steps; ++step) {
      const V x2 = hn::Mul(x, x);
      const V slope = hn::Max(hn::MulSub(hn::Set(d, 3.), x2, j2), hn::Set(d, 1e-300));
      x = hn::Div(hn::MulAdd(hn::Add(x, x), x2, j3), slope);
    }
    return hn::Add(mean, x);
  }
  /// Unit vector along the largest principal stress, and by how many rad it may be wrong: not a
  /// number, or not positive, where nothing is known of it.
  HWY_INLINE Triple<V> principal_direction(V &doubt) const
  {
    const hn::DFromV<V> d;
    const V zero = hn::Zero(d), one = hn::Set(d, 1.), two = hn::Set(d, 2.);
    const V largest = largest_principal<6>();
    // Rows of S - lambda 1: the longest of their products lies along what they turn to nothing.
    const Triple<V> x{hn::Sub(xx, largest), xy, xz}, y{xy, hn::Sub(yy, largest), yz},
        z{xz, yz, hn::Sub(zz, largest)}, none{zero, zero, zero};
    Triple<V> e = add_cross(x, y, none);
    V longest = add_dot(e, e, zero);
    for (const Triple<V> &other : {add_cross(y, z, none), add_cross(z, x, none)}) {
      const V length2 = add_dot(other, other, zero);
      const auto longer = hn::Gt(length2, longest);
      e = {hn::IfThenElse(longer, other.x, e.x), hn::IfThenElse(longer, other.y, e.y),
           hn::IfThenElse(longer, other.z, e.z)};
      longest = hn::Max(longest, length2);
    }
    e = hn::Div(one, hn::Sqrt(longest)) * e;
    // The angle is at most |S e - lambda e| over the gap to the next principal stress.
    const Triple<V> own = times(e);
    const V lambda = add_dot(own, e, zero);
    const Triple<V> wrong = neg_mul_add(lambda, e, own);
    const V others = hn::Sub(hn::Add(xx, hn::Add(yy, zz)), lambda);
    const V squares = square();
    const V difference2 =
        hn::NegMulAdd(others, others, hn::Mul(two, hn::NegMulAdd(lambda, lambda, squares)));
    const V second =
        hn::Mul(hn::Set(d, 0.5), hn::Add(others, hn::Sqrt(hn::Max(difference2, zero))));
    const V gap = hn::Sub(lambda, second);
    constexpr double round_off = 1e-12;
    const V error = hn::MulAdd(hn::Set(d, round_off), hn::Sqrt(squares),
                               hn::Mul(two, hn::Sqrt(add_dot(wrong, wrong, zero))));
    doubt = hn::IfThenElse(hn::Gt(gap, zero), hn::Div(error, gap), one);
    return e;
  }
};

/// Of a stress, or a little more.
template <typename Stress>
HWY_INLINE auto value_of(const StressMeasure &m, const Stress &stress)
{
  using V = decltype(stress.trace());
  if (m.sided)
    return stress.largest_principal();
  const hn::DFromV<V> d;
  const V trace = stress.trace();
  const V largest = m.largest != 0 || m.cut != 0 ? stress.largest_principal() : hn::Zero(d);
  V value = hn::Mul(hn::Set(d, m.trace), trace);
  if (m.largest != 0)
    value = hn::MulAdd(hn::Set(d, m.largest), largest, value);
  if (m.opposite != 0)
    value = hn::NegMulAdd(hn::Set(d, m.opposite), stress.smallest_principal(), value);
  if (m.square != 0) {
    constexpr double round_off = 1e-14; // of the difference of two squares
    const V square = stress.square(), trace2 = hn::Mul(trace, trace);
    const V root2 =
        hn::MulAdd(hn::Set(d, m.square + round_off * (m.square + std::abs(m.trace_square))), square,
                   hn::Mul(hn::Set(d, m.trace_square), trace2));
    value = hn::Add(value, hn::Sqrt(hn::Max(root2, hn::Zero(d))));
  }
  return m.cut != 0 ? hn::Max(value, hn::Mul(hn::Set(d, m.cut), largest)) : value;
}

/// Where eq. (D12d), or (D12f), with this stress, whose measure is given, lets the tension of a
/// face reach `limit`; everything over 2G. With t = S n + r (D12d) takes r.n + tan |r - (r.n) n|,
/// which is at most |r| / cos. What is no number reaches it.
template <typename D, typename Face, typename Stress, typename V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> bound_reaches(D d, const Face &face, const Stress &stress, V value, V limit,
                                     double tangent, const StressMeasure &measure)
{
  const V zero = hn::Zero(d);
  const V length2 = add_dot(face.normal, face.normal, zero), length = hn::Sqrt(length2);
  const auto rest = length * face.force - face.unit * stress.times(face.normal);
  const V room = hn::Mul(hn::Sub(limit, value), hn::Mul(length2, face.unit));
  const V rest2 = hn::Mul(add_dot(rest, rest, zero), length2);
  if (!measure.sided)
    return hn::Not(hn::Lt(hn::Mul(hn::Set(d, measure.residual), hn::Sqrt(rest2)), room));
  const V along = add_dot(rest, face.normal, zero);
  const V across2 = hn::NegMulAdd(along, along, rest2);
  const V excess = hn::MulAdd(hn::Set(d, tangent), hn::Sqrt(hn::Max(across2, zero)), along);
  return hn::Not(hn::Lt(excess, room));
}

/// Eq. (D12d) or (D12f) of particles whose faces differ from S n by residual2 in the square and
/// turn by at most `turn` against the normals of the criterion.
template <typename Stress, typename V>
HWY_INLINE V tension_bound(const Stress &stress, V residual2, double turn,
                           const StressMeasure &measure)
{
  const hn::DFromV<V> d;
  const V square = stress.square();
  constexpr double round_off = 1e-12; // of a residual that is the difference of squares
  const V deviation = hn::MulAdd(
      hn::Set(d, turn), hn::Sqrt(square),
      hn::Sqrt(hn::MulAdd(hn::Set(d, round_off), square, hn::Max(residual2, hn::Zero(d)))));
  return hn::MulAdd(hn::Set(d, measure.residual), deviation, value_of(measure, stress));
}
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
