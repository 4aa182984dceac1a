// Forces of all lattice bonds, vectorised along rows: no lists, no gather, nothing stored per bond.
#pragma once

#include "core/large_array.h"
#include "dem/bond_network.h"
#include "dem/inelastic/inelastic_sweep.h"
#include "dem/stress_measure.h"
#include "particles/rest_blocks.h"

#include <cmath>

namespace ligament::dem
{
/// The streams that the kernel reads and writes, one array per component.
template <int dim>
struct LatticeArrays
{
  static constexpr int n_rotations = particles::Particles<dim>::n_rotations;

  std::array<const double *, dim> displacement;
  std::array<const double *, n_rotations> rotation; // angle, or unit quaternion
  const std::uint32_t *mask;
  const double *lambda_per_volume;
  /// Ascending: their pressures come in with the parts of what is no lattice bond.
  const std::vector<int> *other_particles;
  double *pressure; // lambda_i theta_i, Pa
  std::array<double *, dim> force;
  std::array<double *, n_spins<dim>> torque;
};

/// What the loops need of the lattice; distance and area are those of all its directions.
template <int dim>
struct LatticeConstants
{
  int n_directions = 0;
  std::array<std::array<double, dim>, max_directions> normal{};
  double half = 0;       // q = r/2, m
  double shear = 0;      // 2G S/r, N/m
  double area_r = 0;     // S/r, m
  double bending = 0;    // k_b, N m
  double twist = 0;      // k_t - k_b, N m
  double strength = 0;   // times S, N: of BreakScreen; infinite when nothing breaks
  double tangent = 0;    // of BreakScreen
  StressMeasure measure; // of BreakScreen
  double limit2 = 0;     // force^2 on a face, N^2: of what is looked for first
};

/// Particles that each stage of the sweep takes at once.
inline constexpr int row_piece = 256;
/// And that a vector holds at most.
inline constexpr int most_lanes = 8;

using RowRange = particles::ParticleRange;

/// Bonds that could break: those under sigma + tangent |tau| >= strength with sigma > 0, the normal
/// and the tangential traction of the face; with a tangent below 0 those under
/// max(sigma, 0)^2 + tau^2 >= strength^2.
struct BreakScreen
{
  double strength = 0; // Pa; 0: nothing breaks
  double tangent = 0;
  /// Whether nothing breaks either that the measure keeps below the strength, eq. (D12d) or (D12f).
  bool by_particle = true;
  StressMeasure measure = {};

  /// 1 over the cosine of the angle with that tangent.
  static double per_cosine(double tangent)
  {
    return tangent < 0 ? 1 : std::sqrt(1 + tangent * tangent);
  }
  /// No traction below this one, in any direction, reaches the strength.
  double least_traction() const { return strength / per_cosine(tangent); }
};

/// State and intermediate results of the rows at work, one stream per number; it slides along the
/// particles and stays in the cache, while the arrays of the body are passed over once.
class RowWindow
{
public:
  /// From one stream to the next. Constants, so that one pointer reaches all streams of a particle,
  /// by an offset that fits the processor's instructions; no multiples of 4096 bytes, so that these
  /// lie in different sets of the cache. Close together they share large pages; the wide one is for
  /// layers with very many particles.
  static constexpr long close = (1L << 16) + 24, wide = (1L << 23) + 24;

  /// Room for at least `least` particles, or for all n of them, from 0 on. Memory is taken as it is
  /// touched. Throws core::InputError when the stride is too short for them.
  void reset(int n_streams, long stride, long least, int n);

  /// Makes room up to `end`, keeping what was written from `keep` on; throws core::InputError when
  /// the room does not suffice.
  void slide(int keep, int end);

  /// Where stream 0 of particle 0 would lie; valid for particles in the window until the next
  /// slide().
  double *origin() { return data_.data() - begin_; }

private:
  core::LargeArray data_;
  long stride_ = 0;
  int n_streams_ = 0, length_ = 0, begin_ = 0;
};

/// Particles that the window holds at least where neighbours are at most `reach` apart.
constexpr long window_length_for(long reach)
{
  return 3 * reach + 2 * row_piece + most_lanes;
}

/// Largest offset between neighbours that the kernels can bridge: about a layer of the packing.
inline constexpr long largest_reach = (RowWindow::wide - window_length_for(0)) / 3;

/// Everything one sweep over the segments needs; passed through the run-time dispatch.
template <int dim>
struct RowSweep
{
  LatticeArrays<dim> arrays;
  LatticeConstants<dim> constants;
  const std::vector<RowSegment> *segments;
  int n_particles;
  const particles::AwakeRanges *ranges;
  int reach;       // largest offset between neighbours
  bool volumetric; // nu is not 0
  bool with_forces;
  std::vector<RowRange> *exceeded;
  RowWindow *window;
  double *energy = nullptr; // in place of forces: of each particle's forward bonds, J
  bool by_particle = false; // how bonds that could break are looked for, see LatticeKernel::forces
  bool faces_too = true;    // by particle: faces of what isn't cleared, too
  long *n_looked = nullptr; // grows by the particles that were looked at
  const InelasticSweep<dim> *inelastic = nullptr; // null: all particles are elastic

  /// Particles that the window must hold at least.
  long window_length() const { return window_length_for(reach); }
};

/// cos - 1 and sin of n angles, to round-off for any angle below 1e5.
void cosine_minus_1_and_sine(const double *angle, double *cosine_minus_1, double *sine, int n);

/// The sweep along the rows: pressures run one layer of neighbours ahead of the forces.
void sweep_rows(const RowSweep<2> &sweep);
void sweep_rows(const RowSweep<3> &sweep);

template <int dim>
class LatticeKernel
{
public:
  /// Throws core::InputError when neighbours lie farther apart than largest_reach.
  LatticeKernel(const std::vector<DirectionData<dim>> &directions,
                const std::vector<RowSegment> &segments, int n_particles, double shear_modulus,
                bool volumetric);

  const LatticeConstants<dim> &constants() const { return constants_; }

  /// pressure = lambda_i theta_i of the lattice bonds, on top of what other particles have; left
  /// alone where there is no lattice. With `inelastic` the open cells have what is not the
  /// lattice's, and particles flow.
  void dilatation(const LatticeArrays<dim> &arrays, const std::vector<RowSegment> &segments,
                  RowWindow &window, const InelasticSweep<dim> *inelastic) const;

  /// The same, and force and torque of the lattice bonds; overwrites, but leaves them alone where
  /// there is no lattice. With `ranges` only of the particles that are stepped, and the pressures
  /// that they see; all others must be at rest, or held. Replaces `exceeded` by ranges of particles
  /// among which are those with a bond that could break: its first particle, or one of both; ranges
  /// don't overlap. Returns how many particles it looked at more closely for that. `by_particle` it
  /// looks at the stresses of the particles, not at the tractions on each face: slower where
  /// tractions are small, but it clears bodies under homogeneous stress below the strength. Not
  /// together with `ranges`. Without `faces_too` it leaves what it doesn't clear
  /// by particle to the caller: cells that miss a face are noted where they bear much.
  long forces(const LatticeArrays<dim> &arrays, const std::vector<RowSegment> &segments,
              const BreakScreen &breaking, RowWindow &window, std::vector<RowRange> &exceeded,
              const particles::AwakeRanges *ranges = nullptr, bool by_particle = false,
              bool faces_too = true, const InelasticSweep<dim> *inelastic = nullptr) const;

  /// Pressures as dilatation() has them, and the elastic energy in J of each particle's forward
  /// bonds, bending and twist included, volumes not.
  void energies(const LatticeArrays<dim> &arrays, const std::vector<RowSegment> &segments,
                RowWindow &window, double *energy, const InelasticSweep<dim> *inelastic) const;

private:
  RowSweep<dim> sweep(const LatticeArrays<dim> &arrays, const std::vector<RowSegment> &segments,
                      RowWindow &window) const;

  LatticeConstants<dim> constants_;
  double area_ = 0;
  int n_particles_, reach_ = 0;
  bool volumetric_;
  particles::AwakeRanges everything_;
};
} // namespace ligament::dem
