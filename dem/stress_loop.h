// Stresses and tensions of the particles in slices, for the search for bonds that could break;
// compiled once for every instruction set, the law of a bond comes in as a policy.
#if defined(LIGAMENT_DEM_STRESS_LOOP_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LIGAMENT_DEM_STRESS_LOOP_H
#undef LIGAMENT_DEM_STRESS_LOOP_H
#else
#define LIGAMENT_DEM_STRESS_LOOP_H
#endif

#include "dem/slice_loop.h"
#include "dem/stress_screen.h"

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
template <typename Law, int dim>
class StressSlices
{
public:
  HWY_INLINE explicit StressSlices(const StressSweep<dim> &sweep)
      : sweep_(sweep), table_(sweep.table)
  {
  }

  HWY_INLINE void stresses() const
  {
    HWY_ALIGN double number[record_size][slice_width] = {};
    for (int s = 0; s < table_.n_slices(); ++s) {
      if (!sweep_.slices[s])
        continue;
      for (int lane = 0; lane < slice_width; lane += n_lanes)
        stresses(s, lane, number);
      store(s, number);
    }
  }

  HWY_INLINE void tensions() const
  {
    for (int s = 0; s < table_.n_slices(); ++s) {
      if (!sweep_.slices[s])
        continue;
      std::uint32_t reached = 0;
      for (int lane = 0; lane < slice_width; lane += n_lanes)
        if (sweep_.lanes[s] >> lane & all_lanes)
          reached |= tensions(s, lane) << lane;
      sweep_.lanes[s] &= std::uint8_t(reached);
    }
  }

private:
  using D = SliceLanes;
  using V = hn::Vec<D>;
  using Stress = typename Law::Stress;
  using Face = typename Law::Face;
  using Bonds = BondColumn<dim, true>;
  static constexpr int n_lanes = int(hn::MaxLanes(D())), known_place = record_size - 1;
  static constexpr std::uint32_t all_lanes = (1u << n_lanes) - 1;

  HWY_INLINE Record<D> record(const double *from, const int *places) const
  {
    return transpose(D(), [&](int n) { return from + places[n]; });
  }
  HWY_INLINE const int *places(int s, int lane) const
  {
    return table_.lane.data() + s * slice_width + lane;
  }

  HWY_INLINE void stresses(int s, int lane, double (&number)[record_size][slice_width]) const
  {
    const D d;
    const typename Law::Own own(d, record(sweep_.records, places(s, lane)));
    const bool tests = sweep_.lanes && (sweep_.lanes[s] >> lane & all_lanes) != 0;
    Stress stress(d);
    auto moment = Law::no_moment(d);
    double *at = sweep_.faces;
    for (Bonds b(table_, s, lane); b.has_more(); b.next()) {
      const Face face = Law::face(d, own, b, record(sweep_.records, b.neighbour()));
      stress.add(face.lever, face.force);
      moment = add_cross(face.lever, face.force, moment);
      if (tests) {
        Law::for_each_number(face, [&](const V &v) HWY_ATTR {
          hn::Store(v, d, at);
          at += slice_width;
        });
        hn::Store(b.stiffness(d, 1), d, at);
        at += slice_width;
      }
    }
    const V per_volume = hn::LoadU(d, table_.per_volume.data() + s * slice_width + lane);
    stress.finish(moment, per_volume);
    if (sweep_.moments)
      stress.add(record(sweep_.moments, places(s, lane)).number);
    int c = 0;
    stress.for_each([&](const V &v) HWY_ATTR { hn::Store(v, d, number[c++] + lane); });
    const auto unknown = hn::Eq(per_volume, hn::Zero(d));
    hn::Store(hn::IfThenZeroElse(unknown, hn::Set(d, 1.)), d, number[known_place] + lane);
    if (tests) {
      const double *const end = at;
      const V value = value_of(sweep_.measure, stress);
      auto found = unknown;
      Face face;
      for (at = sweep_.faces; at != end; at += slice_width) {
        Law::for_each_number(face, [&](V &v) HWY_ATTR {
          v = hn::Load(d, at);
          at += slice_width;
        });
        const V limit = hn::Load(d, at);
        const auto bound =
            bound_reaches(d, face, stress, value, limit, sweep_.tangent, sweep_.measure);
        if (HWY_UNLIKELY(!hn::AllFalse(d, bound)))
          found = hn::Or(found, hn::And(bound, bears(d, face, limit)));
      }
      sweep_.lanes[s] &= std::uint8_t(~(all_lanes << lane) | lane_bits(d, found) << lane);
    }
  }

  HWY_INLINE hn::Mask<D> bears(D d, const Face &face, V limit) const
  {
    return reaches(d, face.force, face.normal, hn::Mul(limit, face.unit), sweep_.tangent);
  }

  HWY_INLINE void store(int s, const double (&number)[record_size][slice_width]) const
  {
    const D d;
    for (int c = 0; c < record_size; c += n_lanes)
      for (int l0 = 0; l0 < slice_width; l0 += record_size) {
        const auto numbers = transpose(d, [&](int k) { return number[c + k] + l0; });
        for (int l = 0; l < record_size; ++l)
          hn::StoreU(numbers.number[l], d, sweep_.stress + places(s, l0)[l] + c);
      }
  }

  HWY_INLINE std::uint32_t tensions(int s, int lane) const
  {
    const D d;
    const typename Law::Own own(d, record(sweep_.records, places(s, lane)));
    const Record<D> own_stress = record(sweep_.stress, places(s, lane));
    auto found = hn::Lt(hn::Zero(d), hn::Zero(d));
    for (Bonds b(table_, s, lane); b.has_more(); b.next()) {
      const Face face = Law::face(d, own, b, record(sweep_.records, b.neighbour()));
      const Record<D> other_stress = record(sweep_.stress, b.neighbour());
      const auto mean = [&](int c) HWY_ATTR {
        return hn::Mul(hn::Set(d, 0.5), hn::Add(own_stress.number[c], other_stress.number[c]));
      };
      const auto stress = Stress::of(mean);
      const V limit = b.stiffness(d, 1);
      const auto bears_much = bears(d, face, limit);
      const auto bound = bound_reaches(d, face, stress, value_of(sweep_.measure, stress), limit,
                                       sweep_.tangent, sweep_.measure);
      const auto unknown = hn::Lt(mean(known_place), hn::Set(d, 1.));
      auto reached = hn::And(bears_much, hn::Or(unknown, bound));
      if (sweep_.measure.sided && HWY_UNLIKELY(!hn::AllFalse(d, reached)))
        reached = hn::And(reached, hn::Or(unknown, tension_reaches(d, face, stress, limit)));
      found = hn::Or(found, reached);
    }
    return lane_bits(d, found);
  }

  /// Eq. (D12) itself, but for what the direction isn't sure of.
  HWY_INLINE hn::Mask<D> tension_reaches(D d, const Face &face, const Stress &stress, V limit) const
  {
    const V zero = hn::Zero(d), one = hn::Set(d, 1.);
    V doubt; // rad
    const auto e = stress.principal_direction(doubt);
    const V length = hn::Sqrt(add_dot(face.normal, face.normal, zero));
    const V cosine = hn::Abs(hn::Div(add_dot(face.normal, e, zero), length));
    const V force = hn::Sqrt(add_dot(face.force, face.force, zero));
    const V along =
        hn::CopySign(add_dot(face.force, e, zero),
                     hn::Mul(add_dot(face.force, e, zero), add_dot(face.normal, e, zero)));
    // s = along / cosine, which changes by at most (|t| + |s|) / cosine for each radian.
    const V wanted = hn::Mul(hn::Mul(limit, face.unit), cosine);
    const V margin =
        hn::Mul(hn::Mul(hn::Set(d, 4.), doubt), hn::Add(force, hn::Div(hn::Abs(along), cosine)));
    const auto below = hn::Lt(hn::Add(along, margin), wanted);
    const auto inclined =
        hn::Lt(hn::Add(cosine, hn::Add(doubt, hn::Set(d, 1e-9))), hn::Set(d, sweep_.cone));
    const auto sure = hn::Lt(doubt, hn::Mul(hn::Set(d, 1e-3), one));
    return hn::Not(hn::And(sure, hn::Or(below, inclined)));
  }

  const StressSweep<dim> &sweep_;
  const SliceTable<dim> &table_;
};

template <typename Law, int dim>
HWY_INLINE void take_pressures_of(const LatticeArrays<dim> &arrays, const SliceTable<dim> &table,
                                  double *records, int begin, int end)
{
  for (int r = begin; r < end; ++r)
    records[long(r) * record_size + Law::pressure_place] = arrays.pressure[table.particle[r]];
}
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
