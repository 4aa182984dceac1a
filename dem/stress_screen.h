// Which of some particles have a bond that could break by maximum tension: the stresses of all that
// it takes, several particles at a time.
#pragma once

#include "dem/bond_slices.h"

#include <functional>

namespace ligament::dem
{
/// What the search knows of the body. Stresses and tensions count in units of 2G of their material.
template <int dim>
struct ScreenedBody
{
  const BondNetwork<dim> &bonds;
  const LatticeArrays<dim> &arrays; // with the pressures of all particles
  /// The tension at which a bond is looked at more closely, over 2G.
  std::function<double(const Bond<dim> &)> limit;
  /// 1 / (2G V), the energy weight in V; 0 of particles whose stress isn't that of their bonds and
  /// the moments below.
  std::function<double(int)> per_volume;
  /// Calls add(i, lever, force) for each force on a particle that is no bond's.
  using AddMoment = std::function<void(int, const Vector<dim> &, const Vector<dim> &)>;
  std::function<void(const AddMoment &)> for_each_moment;
  double tangent, cone;  // of PrincipalTension, or below 0 and 1
  StressMeasure measure; // of BreakScreen
};

/// What a sweep over the table needs; passed through the run-time dispatch.
template <int dim>
struct StressSweep
{
  const SliceTable<dim> &table; // limits of the bonds in the place of their bending stiffness
  const double *records;
  const double *moments;         // symmetric, over 2G V, beside those of bonds; null: none
  double *stress;                // over 2G, and in the last place whether it is known: by record
  const std::uint8_t *slices;    // those that are wanted
  std::uint8_t *lanes = nullptr; // bits of each slice: those to be cleared, then those that are not
  double *faces = nullptr;       // scratch: face_size x slice_width for each slot of a slice
  double tangent = 0, cone = 1;
  StressMeasure measure = {};

  static constexpr int face_size = 2 * dim + 2; // force, normal, unit, limit
};

/// Copies the pressures of the particles of records [begin, end) into these.
void take_pressures(const LatticeArrays<2> &arrays, const SliceTable<2> &table, double *records,
                    int begin, int end);
void take_pressures(const LatticeArrays<3> &arrays, const SliceTable<3> &table, double *records,
                    int begin, int end);
/// Stresses of the particles of the wanted slices; where `lanes` are given, clears those whose own
/// term of eq. (D12d) stays below the limit on all faces.
void find_stresses(const StressSweep<2> &sweep);
void find_stresses(const StressSweep<3> &sweep);
/// After the stresses of all neighbours: clears the lanes without a face that reaches its limit by
/// eq. (D12).
void find_tensions(const StressSweep<2> &sweep);
void find_tensions(const StressSweep<3> &sweep);

/// Keeps the table of the bonds from one step to the next, in which mostly the same particles are
/// asked for, or some beside them; about 1 kB for each, at most three times as many. None when
/// nothing was asked for some time.
template <int dim>
class StressScreen
{
public:
  /// Of fewer particles the bonds are looked at one by one in less time.
  static constexpr int least = 48;

  /// Those of the `candidates` (ascending) that have a bond which could reach its limit by eq.
  /// (D12); of a bond that does, it is one of the candidates or both. With `own_terms` every bond
  /// that could break has one of those particles among the candidates whose own term of eq. (D12d)
  /// says so.
  std::vector<int> keep(const std::vector<int> &candidates, bool own_terms,
                        const ScreenedBody<dim> &body);

  /// Nothing was to be asked in this step.
  void pass()
  {
    constexpr int patience = 256;
    if (++idle_ > patience)
      clear();
  }

  /// Whether the last step asked.
  bool was_asked() const { return n_candidates_ > 0 && idle_ == 0; }

  /// The bond no longer carries.
  void remove(const Bond<dim> &bond);

  /// Forgets all bonds, for instance because their limits have changed.
  void clear() { *this = StressScreen(); }

private:
  struct Place
  {
    int particle, record;
    friend bool operator<(const Place &a, const Place &b) { return a.particle < b.particle; }
  };

  /// Finds the lanes of the candidates; false when one has none.
  bool find_lanes(const std::vector<int> &candidates);
  void lay_out(std::vector<int> candidates, const ScreenedBody<dim> &body);
  void add_slices(int begin, int end, const std::vector<int> &n_bonds);
  void set_bond(long place, const Bond<dim> &bond, bool is_i, int neighbour, double limit);
  const Place *find(int particle) const;
  bool find_moments(const ScreenedBody<dim> &body);
  void load(const ScreenedBody<dim> &body, int begin, int end);
  /// After find_lanes().
  void add_kept(const std::vector<int> &candidates, bool own_terms, const ScreenedBody<dim> &body,
                std::vector<int> &kept);

  SliceTable<dim> table_;                   // slices of the candidates, then of their neighbours
  std::vector<Place> places_;               // of all records, ascending
  std::vector<int> lane_of_;                // of each record with bonds, -1 of others
  std::vector<int> asked_, lanes_of_asked_; // the candidates of the last time
  int n_candidates_ = 0, n_with_bonds_ = 0, n_first_slices_ = 0, longest_ = 0, idle_ = 0;
  core::LargeArray records_, stress_, faces_;
  std::vector<double> moments_;   // as the sweep wants them
  std::vector<int> with_moments_; // records
};
} // namespace ligament::dem
