// A particle's own stress, theory.md eqs. (D20), (D21); compiled once for every instruction set.
#if defined(LIGAMENT_DEM_OWN_STRESS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LIGAMENT_DEM_OWN_STRESS_H
#undef LIGAMENT_DEM_OWN_STRESS_H
#else
#define LIGAMENT_DEM_OWN_STRESS_H
#endif

#include "dem/inelastic/tensor_lanes.h"
#include "dem/transpose_lanes.h"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
/// The strains of particles from the motion of all their faces, and what they answer at inelastic
/// strains e; `open`: some of them have open cells.
template <int dim, typename D, bool open>
class OwnStress
{
  using V = hn::Vec<D>;
  using Tensor = SymmetricTensor<dim, V>;

public:
  /// `x`: sum of S/r R^T Du (x) A of the lattice's bonds, m^dim; `trace`: its own;
  /// `lambda_per_volume`: lambda / V.
  template <typename At>
  HWY_INLINE OwnStress(D d, const InelasticSweep<dim> &s, const At &at, const V (&x)[dim][dim],
                       V trace, V lambda_per_volume)
      : d_(d), trace_(trace), lambda_per_volume_(lambda_per_volume),
        is_plane_strain_(s.is_plane_strain)
  {
    for (int a = 0; a < dim; ++a)
      for (int b = 0; b < dim; ++b)
        x_[a][b] = x[a][b];
    if (s.volume) {
      volume_ = at.load(d, s.volume);
      per_volume_ = hn::Div(hn::Set(d, 1.), volume_);
    } else {
      volume_ = hn::Set(d, s.whole_volume);
      per_volume_ = hn::Set(d, s.per_whole_volume);
    }
    if constexpr (open) {
      take_open(s, at);
      per_volume_ = hn::Div(hn::Set(d, 1.), volume_);
    }
  }

  /// lambda theta in Pa.
  HWY_INLINE V elastic_pressure() const { return hn::Mul(lambda_per_volume_, trace_); }
  /// lambda (theta - M:e) in Pa.
  HWY_INLINE V pressure(const Tensor &e) const
  {
    V flowed = hn::Zero(d_);
    if constexpr (open) {
      for (int a = 0; a < dim; ++a)
        for (int b = 0; b < dim; ++b)
          flowed = hn::MulAdd(e(a, b), moment(a, b, a), flowed);
    } else
      for (int a = 0; a < dim; ++a)
        flowed = hn::Add(e.c[a], flowed);
    if (dim == 2 && is_plane_strain_)
      flowed = hn::Add(e.c[2], flowed);
    return hn::Mul(lambda_per_volume_, hn::NegMulAdd(volume_, flowed, trace_));
  }

  /// In Pa, at the pressure of these e.
  HWY_INLINE Tensor stress(const Tensor &e, V pressure, double twice_shear) const
  {
    const V modulus = hn::Set(d_, twice_shear), half = hn::Set(d_, 0.5);
    Tensor t = sheared(modulus);
    for (int a = 0; a < dim; ++a)
      for (int b = a; b < dim; ++b) {
        V &sum = t.c[tensor_place<dim>(a, b)];
        if constexpr (open) {
          const V kept = hn::Mul(half, hn::Add(moved(e, a, b), moved(e, b, a)));
          sum = hn::NegMulAdd(modulus, kept, sum);
        } else
          sum = hn::NegMulAdd(modulus, e(a, b), sum);
      }
    press(pressure, t);
    if constexpr (dim == 2)
      t.c[2] = is_plane_strain_ ? hn::NegMulAdd(modulus, e.c[2], pressure) : hn::Zero(d_);
    return t;
  }
  /// Without e.
  HWY_INLINE Tensor elastic_stress(V pressure, double twice_shear) const
  {
    Tensor t = sheared(hn::Set(d_, twice_shear));
    press(pressure, t);
    if constexpr (dim == 2)
      t.c[2] = is_plane_strain_ ? pressure : hn::Zero(d_);
    return t;
  }

  /// What e changes in the energy beside the pressure's, theory.md eq. (D20b), in J.
  HWY_INLINE V own_energy(const Tensor &e, V twice_shear) const
  {
    V sum = hn::Zero(d_), kept = sum;
    for (int a = 0; a < dim; ++a)
      for (int b = 0; b < dim; ++b) {
        sum = hn::MulAdd(e(a, b), x_[a][b], sum);
        kept = hn::MulAdd(e(a, b), open ? moved(e, a, b) : e(a, b), kept);
      }
    if (dim == 2 && is_plane_strain_)
      kept = hn::MulAdd(e.c[2], e.c[2], kept);
    return hn::Mul(twice_shear, hn::NegMulAdd(sum, hn::Set(d_, 1.),
                                              hn::Mul(hn::Set(d_, 0.5), hn::Mul(volume_, kept))));
  }

  V volume() const { return volume_; }
  static constexpr bool is_open() { return open; }
  /// Of open vectors: where M is not the identity.
  HWY_INLINE hn::Mask<D> is_incomplete() const
  {
    V most = hn::Zero(d_);
    for (int row = 0; row < dim; ++row)
      for (int a = 0; a < dim; ++a)
        for (int b = a; b < dim; ++b)
          most = hn::Max(most, hn::Abs(hn::Sub(moment(row, a, b), hn::Set(d_, double(a == b)))));
    constexpr double round_off = 1e-9;
    return hn::Gt(most, hn::Set(d_, round_off));
  }
  /// Of open vectors: lanes without an open cell.
  HWY_INLINE hn::Mask<D> is_whole() const { return hn::Le(open_volume_, hn::Zero(d_)); }
  bool is_plane_stress() const { return dim == 2 && !is_plane_strain_; }
  /// What e alone does.
  HWY_INLINE OwnStress without_motion() const
  {
    OwnStress still = *this;
    for (auto &row : still.x_)
      for (V &x : row)
        x = hn::Zero(d_);
    still.trace_ = hn::Zero(d_);
    return still;
  }

private:
  using Cell = OpenCell<dim>;

  /// 2G E
  HWY_INLINE Tensor sheared(V modulus) const
  {
    const V per_volume = hn::Mul(modulus, per_volume_);
    const V half = hn::Mul(hn::Set(d_, 0.5), per_volume);
    Tensor t;
    for (int a = 0; a < dim; ++a)
      for (int b = a; b < dim; ++b)
        t.c[tensor_place<dim>(a, b)] =
            a == b ? hn::Mul(per_volume, x_[a][a]) : hn::Mul(half, hn::Add(x_[a][b], x_[b][a]));
    return t;
  }
  /// Adds p sym M.
  HWY_INLINE void press(V pressure, Tensor &t) const
  {
    if constexpr (open) {
      const V half = hn::Mul(hn::Set(d_, 0.5), pressure);
      for (int a = 0; a < dim; ++a)
        for (int b = a; b < dim; ++b) {
          V &sum = t.c[tensor_place<dim>(a, b)];
          sum = hn::MulAdd(half, hn::Add(moment(a, a, b), moment(b, b, a)), sum);
        }
    } else
      for (int a = 0; a < dim; ++a)
        t.c[a] = hn::Add(t.c[a], pressure);
  }

  /// M_ab as row `row` of e M has it.
  HWY_INLINE V moment(int row, int a, int b) const
  {
    return moment_[row][in_plane_place<dim>(a, b)];
  }
  /// (e M)_ab
  HWY_INLINE V moved(const Tensor &e, int a, int b) const
  {
    V sum = hn::Zero(d_);
    for (int c = 0; c < dim; ++c)
      sum = hn::MulAdd(e(a, c), moment(a, c, b), sum);
    return sum;
  }

  static constexpr Cell whole_cell()
  {
    Cell whole; // its volume is 0: that of the lane stays
    for (int row = 0; row < dim; ++row)
      for (int a = 0; a < dim; ++a)
        whole.number[Cell::moment + row * n_in_plane<dim> + in_plane_place<dim>(a, a)] = 1;
    return whole;
  }

  template <typename At>
  HWY_INLINE void take_open(const InelasticSweep<dim> &s, const At &at)
  {
    static constexpr Cell whole = whole_cell();
    const double *cell[At::n];
    for (int l = 0; l < At::n; ++l) {
      const int open_cell = s.open[at.particle(l)];
      cell[l] = (open_cell >= 0 ? s.cells[open_cell] : whole).number;
    }
    V number[Cell::size];
    for (int c = 0; c < Cell::size; c += 8) {
      const int first = std::min(c, Cell::size - 8);
      const auto eight = transpose(d_, [&](int l) HWY_ATTR { return cell[l] + first; });
      for (int k = 0; k < 8; ++k)
        number[first + k] = eight.number[k];
    }
    for (int a = 0; a < dim; ++a)
      for (int b = 0; b < dim; ++b)
        x_[a][b] = hn::Add(x_[a][b], number[Cell::strain + dim * a + b]);
    for (int a = 0; a < dim; ++a)
      trace_ = hn::Add(trace_, number[Cell::strain + dim * a + a]);
    open_volume_ = number[Cell::volume];
    volume_ = hn::IfThenElse(is_whole(), volume_, open_volume_);
    for (int row = 0; row < dim; ++row)
      for (int k = 0; k < n_in_plane<dim>; ++k)
        moment_[row][k] = number[Cell::moment + row * n_in_plane<dim> + k];
  }

  D d_;
  V x_[dim][dim];
  V trace_, lambda_per_volume_, volume_, per_volume_;
  V open_volume_; // of open vectors: m^3, 0 without an open cell
  V moment_[dim][n_in_plane<dim>];
  bool is_plane_strain_;
};
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
