// The loops over slices that both dimensions share, compiled once for every instruction set; the
// law of a bond comes in as a policy.
#if defined(LIGAMENT_DEM_SLICE_LOOP_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LIGAMENT_DEM_SLICE_LOOP_H
#undef LIGAMENT_DEM_SLICE_LOOP_H
#else
#define LIGAMENT_DEM_SLICE_LOOP_H
#endif

#include "dem/bond_slices.h"
#include "dem/inelastic/response.h"
#include "dem/lane_vectors.h"
#include "dem/stress_bound.h"
#include "dem/transpose_lanes.h"

#include <hwy/cache_control.h>

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
using SliceLanes = hn::CappedTag<double, slice_width>;

/// The numbers of a record, each for all lanes.
template <typename D>
using Record = EightNumbers<D>;
static_assert(record_size == 8);

/// The same with the strain of their own.
template <typename D>
struct StrainedRecord : Record<D>
{
  hn::Vec<D> strain[record_size];
};

/// The bonds of a vector of particles, one below the other.
template <int dim, bool with_stiffness>
class BondColumn
{
public:
  HWY_INLINE BondColumn(const SliceTable<dim> &table, int slice, int lane)
  {
    const long slot = table.first_slot[slice];
    geometry_ = table.geometry.data() + slot * geometry_stride + lane;
    stiffness_ = table.stiffness.data() + slot * stiffness_stride + lane;
    neighbour_ = table.neighbour.data() + slot * slice_width + lane;
    end_ = neighbour_ + (table.first_slot[slice + 1] - slot) * slice_width;
  }
  HWY_INLINE bool has_more() const { return neighbour_ != end_; }
  HWY_INLINE void next()
  {
    prefetch<n_geometry<dim>>(geometry_);
    if (with_stiffness)
      prefetch<n_stiffness<dim>>(stiffness_);
    hwy::Prefetch(neighbour_ + ahead * slice_width);
    geometry_ += geometry_stride;
    stiffness_ += stiffness_stride;
    neighbour_ += slice_width;
  }
  const int *neighbour() const { return neighbour_; }
  template <typename D>
  HWY_INLINE hn::Vec<D> geometry(D d, int k) const
  {
    return hn::Load(d, geometry_ + k * slice_width);
  }
  template <typename D>
  HWY_INLINE hn::Vec<D> stiffness(D d, int k) const
  {
    return hn::Load(d, stiffness_ + k * slice_width);
  }

private:
  static constexpr long geometry_stride = n_geometry<dim> * slice_width,
                        stiffness_stride = n_stiffness<dim> * slice_width;
  static constexpr int ahead = 8; // slots: about the time that memory takes to answer

  template <int n>
  static HWY_INLINE void prefetch(const double *now)
  {
    for (int k = 0; k < n; ++k)
      hwy::Prefetch(now + (ahead * n + k) * slice_width);
  }

  const double *geometry_, *stiffness_;
  const int *neighbour_, *end_;
};

/// Sweeps of the `Law`: what a bond adds to the sums of the particles in a vector.
template <typename Law, int dim>
class Slices
{
public:
  HWY_INLINE explicit Slices(const SliceSweep<dim> &sweep) : sweep_(sweep), table_(sweep.table) {}

  HWY_INLINE void load() const
  {
    const SliceLanes d;
    constexpr int n = n_lanes;
    HWY_ALIGN double number[record_size][slice_width] = {};
    const int n_records = sweep_.end_record < 0 ? table_.n_records() : sweep_.end_record;
    for (int first = sweep_.first_record; first < n_records; first += slice_width) {
      if (sweep_.nearness && sweep_.nearness->records[first / slice_width] < Rest::turned)
        continue;
      const int size = std::min(slice_width, n_records - first);
      const int *const particle = table_.particle.data() + first;
      for (int f = 0; f < Law::n_loaded; ++f)
        for (int l = 0; l < size; ++l)
          number[Law::place(f)][l] = Law::source(sweep_.arrays, f)[particle[l]];
      for (int l = 0; l < slice_width; l += n)
        Law::prepare(d, number, l);
      double *const records = sweep_.records + long(first) * record_size;
      for (int c = 0; c < record_size; c += n) {
        const auto of_record = [&](int l0) HWY_ATTR {
          return transpose(d, [&](int k) { return number[c + k] + l0; });
        };
        const auto numbers = of_record(0);
        for (int l = 0; l < slice_width; ++l)
          hn::StoreU(numbers.number[l], d, records + l * record_size + c);
      }
    }
  }

  HWY_INLINE void pressures() const
  {
    const SliceLanes d;
    HWY_ALIGN double theta[slice_width];
    for (int s = 0; s < table_.n_slices(); ++s) {
      if (is_left_out(s, Rest::pressed))
        continue;
      for (int lane = 0; lane < slice_width; lane += n_lanes) {
        const typename Law::Own own(d, read(s, lane));
        auto sum = hn::Zero(d);
        for (BondColumn<dim, false> b(table_, s, lane); b.has_more(); b.next())
          Law::add_dilatation(d, own, b, read(b.neighbour()), sum);
        hn::Store(sum, d, theta + lane);
      }
      for_each_lane(s, [&](int l, int i) {
        sweep_.arrays.pressure[i] += sweep_.arrays.lambda_per_volume[i] * theta[l];
      });
    }
  }

  /// Of what Law::add_strain sums and Law::turn_back takes to the particles' axes, what the
  /// particles answer; or into their open cells, with those whose faces are the lattice's.
  HWY_INLINE void strains() const
  {
    const SliceLanes d;
    for (int s = 0; s < table_.n_slices(); ++s) {
      if (is_left_out(s, Rest::pressed))
        continue;
      const int size = std::min(slice_width, table_.n_own() - s * slice_width);
      for (int lane = 0; lane < size; lane += n_lanes) {
        const typename Law::Own own(d, read(s, lane));
        hn::Vec<SliceLanes> x[dim][dim];
        for (auto &row : x)
          for (auto &number : row)
            number = hn::Zero(d);
        for (BondColumn<dim, false> b(table_, s, lane); b.has_more(); b.next())
          Law::add_strain(d, own, b, read(b.neighbour()), x);
        Law::turn_back(own, x);
        if (sweep_.responds)
          respond(s, lane, size, x);
        else
          keep(s, lane, size, x);
      }
    }
  }

  /// e of the records, from the streams.
  HWY_INLINE void load_strains() const
  {
    const auto &streams = sweep_.inelastic->streams;
    for (int r = 0; r < table_.n_records(); ++r) {
      const int i = table_.particle[r];
      double *const to = sweep_.strain_records + long(r) * record_size;
      if (!sweep_.inelastic->begun[i / inelastic_block])
        std::fill(to, to + record_size, 0.);
      else
        for (int c = 0; c < n_tensor<dim>; ++c)
          to[c] = streams.stream(InelasticStreams<dim>::strain + c)[i];
    }
  }

  HWY_INLINE void energies() const
  {
    const SliceLanes d;
    HWY_ALIGN double energy[slice_width];
    for (int s = 0; s < table_.n_slices(); ++s) {
      for (int lane = 0; lane < slice_width; lane += n_lanes) {
        const typename Law::Own own(d, read(s, lane));
        auto sum = hn::Zero(d);
        for (BondColumn<dim, true> b(table_, s, lane); b.has_more(); b.next())
          Law::add_energy(d, own, b, read(b.neighbour()), sum);
        hn::Store(sum, d, energy + lane);
      }
      for_each_lane(s, [&](int l, int i) { sweep_.energy[i] += energy[l]; });
    }
  }

  HWY_INLINE void forces() const
  {
    take_pressures();
    if (sweep_.faces_at_once)
      forces<true>();
    else
      forces<false>();
  }

private:
  using Rest = particles::RestBlocks<dim>;
  static constexpr int n_lanes = int(hn::MaxLanes(SliceLanes()));

  HWY_INLINE bool is_left_out(int slice, int least) const
  {
    return sweep_.nearness && sweep_.nearness->slice[slice] < least;
  }

  /// What the law reads of the particles with records at these places.
  HWY_INLINE typename Law::Numbers read(const int *places) const
  {
    const auto of_records =
        transpose(SliceLanes(), [&](int n) { return sweep_.records + places[n]; });
    // A copy of eight vectors goes through memory where there are sixteen registers: half the speed.
    if constexpr (!Law::strained)
      return of_records;
    else {
      typename Law::Numbers numbers;
      static_cast<Record<SliceLanes> &>(numbers) = of_records;
      const auto strain =
          transpose(SliceLanes(), [&](int n) { return sweep_.strain_records + places[n]; });
      for (int c = 0; c < record_size; ++c)
        numbers.strain[c] = strain.number[c];
      return numbers;
    }
  }
  HWY_INLINE typename Law::Numbers read(int s, int lane) const
  {
    return read(table_.lane.data() + s * slice_width + lane);
  }

  using Strains = hn::Vec<SliceLanes>[dim][dim];

  HWY_INLINE int particle(int s, int lane) const
  {
    return table_.particle[table_.lane[s * slice_width + lane] / record_size];
  }

  HWY_INLINE void respond(int s, int lane, int size, const Strains &x) const
  {
    const SliceLanes d;
    const auto &a = sweep_.arrays;
    Scattered<dim, SliceLanes> place;
    HWY_ALIGN double lambda_per_volume[n_lanes], pressure[n_lanes];
    for (int l = 0; l < n_lanes; ++l) {
      place.of[l] = particle(s, lane + l < size ? lane + l : lane);
      lambda_per_volume[l] = a.lambda_per_volume[place.of[l]];
    }
    const auto used = hn::Lt(hn::Iota(d, double(lane)), hn::Set(d, double(size)));
    auto trace = x[0][0];
    for (int a = 1; a < dim; ++a)
      trace = hn::Add(trace, x[a][a]);
    const auto response = dem::HWY_NAMESPACE::respond<dim>(d, *sweep_.inelastic, place, used, x,
                                                           trace, hn::Load(d, lambda_per_volume));
    hn::Store(response.pressure, d, pressure);
    for (int l = 0; l < n_lanes && lane + l < size; ++l)
      a.pressure[place.of[l]] = pressure[l];
  }

  HWY_INLINE void keep(int s, int lane, int size, const Strains &x) const
  {
    HWY_ALIGN double number[dim * dim][n_lanes];
    for (int k = 0; k < dim * dim; ++k)
      hn::Store(x[k / dim][k % dim], SliceLanes(), number[k]);
    for (int l = 0; l < n_lanes && lane + l < size; ++l) {
      auto &cell = sweep_.inelastic->cells[sweep_.inelastic->open[particle(s, lane + l)]];
      for (int k = 0; k < dim * dim; ++k)
        cell.number[OpenCell<dim>::strain + k] += number[k][l];
    }
  }

  HWY_INLINE void take_pressures() const
  {
    for (int r = 0; r < table_.n_records(); ++r)
      sweep_.records[long(r) * record_size + Law::pressure_place] =
          sweep_.arrays.pressure[table_.particle[r]];
  }

  /// visit(lane, particle) for the lanes of the slice that hold one.
  template <typename Visit>
  HWY_INLINE void for_each_lane(int s, Visit &&visit) const
  {
    const int size = std::min(slice_width, table_.n_own() - s * slice_width);
    for (int l = 0; l < size; ++l)
      visit(l, table_.particle[table_.lane[s * slice_width + l] / record_size]);
  }

  /// visit(face) of each bond of a vector of particles.
  template <typename Visit>
  HWY_INLINE void for_each_face(int s, int lane, Visit &&visit) const
  {
    const SliceLanes d;
    const typename Law::Own own(d, read(s, lane));
    for (BondColumn<dim, true> b(table_, s, lane); b.has_more(); b.next())
      visit(Law::face(d, own, b, read(b.neighbour())));
  }

  template <bool faces_at_once>
  HWY_INLINE void forces() const
  {
    const SliceLanes d;
    HWY_ALIGN double sums[Law::n_sums][slice_width];
    const auto limit2 = hn::Set(d, sweep_.limit2);
    for (int s = 0; s < table_.n_slices(); ++s) {
      if (is_left_out(s, Rest::awake))
        continue;
      bool reached = false;
      std::uint32_t breaking = 0; // bits of lanes
      for (int lane = 0; lane < slice_width; lane += n_lanes) {
        const typename Law::Own own(d, read(s, lane));
        typename Law::Sums sum;
        Look look(*this, s, lane);
        for (BondColumn<dim, true> b(table_, s, lane); b.has_more(); b.next()) {
          const auto other = read(b.neighbour());
          Law::add_forces(d, own, b, other, limit2, sum);
          if constexpr (faces_at_once)
            look.add(Law::face(d, own, b, other));
        }
        sum.store(d, own, sums, lane);
        if (HWY_UNLIKELY(sum.exceeds(d))) {
          reached = true;
          if (faces_at_once)
            breaking |= look.found() << lane;
          else if (sweep_.limit2 < sweep_.never)
            breaking |= (sweep_.faces_too ? could_break(s, lane) : sum.exceeding(d)) << lane;
        }
      }
      finish_forces(s, sums);
      *sweep_.n_reached += reached;
      if (HWY_UNLIKELY(breaking != 0))
        for_each_lane(s, [&](int l, int i) {
          if (breaking >> l & 1)
            sweep_.exceeded->push_back(i);
        });
    }
  }

  /// Which particles of a vector have a bond that could break: by eq. (D12c), and where the stress
  /// of a particle is known, by its own term of (D12d) or (D12f).
  class Look
  {
    using V = hn::Vec<SliceLanes>;

  public:
    HWY_INLINE Look(const Slices &slices, int s, int lane)
        : sweep_(slices.sweep_), table_(slices.table_), first_lane_(s * slice_width + lane),
          knows_stress_(sweep_.by_particle && !table_.per_volume.empty() && !sweep_.nearness &&
                        table_.first_slot[s + 1] - table_.first_slot[s] <= most_faces),
          strain_(hn::Set(SliceLanes(), sweep_.strain)),
          found_(hn::Lt(strain_, hn::Zero(SliceLanes()))), stress_(SliceLanes()),
          moment_(Law::no_moment(SliceLanes())), end_(kept_)
    {
    }
    HWY_INLINE void add(const typename Law::Face &face)
    {
      const SliceLanes d;
      found_ = hn::Or(found_, reached(face));
      if (!knows_stress_)
        return;
      stress_.add(face.lever, face.force);
      moment_ = add_cross(face.lever, face.force, moment_);
      Law::for_each_number(face, [&](const V &number) HWY_ATTR {
        hn::Store(number, d, end_);
        end_ += n_lanes;
      });
    }
    /// Bits of the lanes.
    HWY_INLINE std::uint32_t found()
    {
      const SliceLanes d;
      if (!knows_stress_ || hn::AllFalse(d, found_))
        return lane_bits(d, found_);
      const V per_volume = hn::LoadU(d, table_.per_volume.data() + first_lane_);
      stress_.finish(moment_, per_volume);
      const V value = value_of(sweep_.measure, stress_);
      auto not_cleared = hn::Eq(per_volume, hn::Zero(d));
      for (const double *at = kept_; at != end_;) {
        typename Law::Face face;
        Law::for_each_number(face, [&](V &number) HWY_ATTR {
          number = hn::Load(d, at);
          at += n_lanes;
        });
        const auto bound =
            bound_reaches(d, face, stress_, value, strain_, sweep_.tangent, sweep_.measure);
        if (HWY_UNLIKELY(!hn::AllFalse(d, bound)))
          not_cleared = hn::Or(not_cleared, hn::And(bound, reached(face)));
      }
      return lane_bits(d, hn::And(found_, not_cleared));
    }

  private:
    static constexpr int most_faces = 40, face_size = 2 * dim + 1;

    HWY_INLINE hn::Mask<SliceLanes> reached(const typename Law::Face &face) const
    {
      return reaches(SliceLanes(), face.force, face.normal, hn::Mul(strain_, face.unit),
                     sweep_.tangent);
    }

    const SliceSweep<dim> &sweep_;
    const SliceTable<dim> &table_;
    int first_lane_;
    bool knows_stress_;
    V strain_;
    hn::Mask<SliceLanes> found_;
    typename Law::Stress stress_;
    typename Law::Moment moment_;
    double *end_;
    HWY_ALIGN double kept_[most_faces * face_size * n_lanes];
  };

  HWY_NOINLINE std::uint32_t could_break(int s, int lane) const
  {
    Look look(*this, s, lane);
    for_each_face(s, lane, [&](const auto &face) HWY_ATTR { look.add(face); });
    return look.found();
  }

  HWY_INLINE void finish_forces(int s, const double (&sums)[Law::n_sums][slice_width]) const
  {
    const auto &a = sweep_.arrays;
    const auto array = [&](int c) { return c < dim ? a.force[c] : a.torque[c - dim]; };
    for (int c = 0; c < Law::n_sums; ++c) {
      double *const to = array(c);
      if (sweep_.replace)
        for_each_lane(s, [&](int l, int i) { to[i] = sums[c][l]; });
      else
        for_each_lane(s, [&](int l, int i) { to[i] += sums[c][l]; });
    }
  }

  const SliceSweep<dim> &sweep_;
  const SliceTable<dim> &table_;
};
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
