// Bonds that no lattice row holds, laid out for vectors of particles: slices of eight particles,
// the bonds of each one below the other.
#pragma once

#include "core/large_array.h"
#include "dem/bond_network.h"
#include "dem/lattice_kernel.h"
#include "particles/rest_blocks.h"

namespace ligament::dem
{
/// Particles side by side in a slice; a vector holds a part of them or all.
inline constexpr int slice_width = 8;

/// Numbers of a particle that its neighbours read, in one line of the cache: 2D displacement,
/// cos - 1, sin and angle, pressure; 3D displacement, quaternion, pressure.
inline constexpr int record_size = 8;

/// Geometry of a bond as one of its particles sees it: own lever, the other's (m), S/r (m).
template <int dim>
inline constexpr int n_geometry = 2 * dim + 1;

/// Stiffness of a bond: 2G S/r (N/m), k_b (N m), and in 3D (k_t - k_b)/r^2 (N/m), with its weight.
template <int dim>
inline constexpr int n_stiffness = dim;

/// All bonds as the kernel reads them. Lanes and slots without a bond have zeros.
template <int dim>
struct SliceTable
{
  std::vector<int> particle;   // of each record, ascending; then those of images
  std::vector<int> lane;       // record of each lane times record_size; n_slices x slice_width
  std::vector<int> first_slot; // of each slice, and the end
  std::vector<int> neighbour;  // record times record_size: n_slots x slice_width
  core::LargeArray geometry;   // n_slots x n_geometry x slice_width
  core::LargeArray stiffness;  // n_slots x n_stiffness x slice_width
  /// 1 / (2G V), its energy weight in V, of each lane whose particle has all faces here; 0 of
  /// others. Empty when none has.
  std::vector<double> per_volume;

  /// What a bond is to one of its particles, bending aside; returns its numbers from the shear
  /// stiffness on, slice_width apart, for the caller to fill. Neighbours are records times
  /// record_size.
  double *set_bond(long place, const Bond<dim> &bond, bool is_i, int neighbour);

  int n_images = 0; // of the records, the last ones, which are no particle's own

  int n_slices() const { return int(first_slot.size()) - 1; }
  int n_records() const { return int(particle.size()); }
  int n_own() const { return n_records() - n_images; }
};

/// How near each slice, and each eight records in their order, come to particles that move:
/// RestBlocks::nearness of the nearest.
struct SliceNearness
{
  std::vector<std::uint8_t> slice, records;
};

/// What one sweep over the slices needs; passed through the run-time dispatch.
template <int dim>
struct SliceSweep
{
  const SliceTable<dim> &table;
  const LatticeArrays<dim> &arrays; // the mask is not read
  double *records;
  double limit2 = 0; // (traction / 2G)^2 below which no bond breaks
  bool replace;      // forces and torques are overwritten, not added to
  std::vector<int> *exceeded;
  const SliceNearness *nearness = nullptr; // null: all slices are swept
  double *energy = nullptr;                // of the particles, J
  double strain = 0, tangent = 0;        // strength / 2G and angle of BreakScreen
  StressMeasure measure = {};            // of BreakScreen
  int first_record = 0, end_record = -1; // what is loaded, from a multiple of slice_width; -1: all
  bool faces_at_once = false; // faces of all particles are looked at together with their forces
  long *n_reached = nullptr;  // grows by the slices with a traction that reaches the limit
  bool faces_too = true;      // false: notes all particles with a traction that reaches the limit
  bool by_particle = true;    // of BreakScreen
  const InelasticSweep<dim> *inelastic = nullptr; // null: all particles are elastic
  bool responds = false;            // there is no lattice: particles flow in add_strains()
  double *strain_records = nullptr; // e of each record; null: nothing has flowed

  static constexpr double never = 1e200; // the square of a strain that no bond reaches
};

/// Fills the records, without pressures.
void load_records(const SliceSweep<2> &sweep);
void load_records(const SliceSweep<3> &sweep);
/// Adds lambda theta of the bonds to arrays.pressure.
void add_pressures(const SliceSweep<2> &sweep);
void add_pressures(const SliceSweep<3> &sweep);
/// In place of it where particles may flow: what the bonds add to the strains of the open cells;
/// without a lattice the particles' response at once.
void add_strains(const SliceSweep<2> &sweep);
void add_strains(const SliceSweep<3> &sweep);
/// Fills the strain records.
void load_strains(const SliceSweep<2> &sweep);
void load_strains(const SliceSweep<3> &sweep);
/// Forces and torques at arrays.pressure; notes the particles with a bond that could break.
void add_slice_forces(const SliceSweep<2> &sweep);
void add_slice_forces(const SliceSweep<3> &sweep);
/// Adds to each particle's energy its half of every bond's, bending and twist included.
void add_slice_energies(const SliceSweep<2> &sweep);
void add_slice_energies(const SliceSweep<3> &sweep);

/// The table's bonds of a network in slices.
template <int dim>
class BondSlices
{
public:
  /// With `all_particles` those without bonds have a place as well, and forces are overwritten.
  BondSlices(const BondNetwork<dim> &bonds, double shear_modulus, bool all_particles);

  /// Volumes in m^3 and energy weights (empty: 1) of all particles of the network: bonds of cells
  /// that are closed by bonds here are then looked at more closely before they count as exceeded.
  void set_volumes(const BondNetwork<dim> &bonds, const std::vector<double> &volume,
                   const std::vector<double> &weights);

  bool empty() const { return table_.n_records() == 0; }

  /// For the three sweeps below, which with it leave out what is at rest.
  SliceNearness nearness(const particles::AwakeRanges &ranges) const;
  const std::vector<int> &particles() const { return table_.particle; }

  /// Bond `index` of the network's table no longer carries.
  void remove(int index);

  /// Reads the state into `records`, the scratch of all three; first of the three.
  void load(const LatticeArrays<dim> &arrays, core::LargeArray &records,
            const SliceNearness *nearness = nullptr) const;

  /// Adds lambda theta of the bonds to arrays.pressure.
  void add_pressures(const LatticeArrays<dim> &arrays, core::LargeArray &records,
                     const SliceNearness *nearness = nullptr) const;

  /// In place of it where particles may flow; see the function beside SliceSweep.
  void add_strains(const LatticeArrays<dim> &arrays, core::LargeArray &records,
                   const InelasticSweep<dim> &inelastic,
                   const SliceNearness *nearness = nullptr) const;

  /// Adds the forces at arrays.pressure. Replaces `exceeded` by particles among which are those of
  /// all bonds that could break; its strength is that of a bond of the base material. Without
  /// `faces_too` it looks at nothing but the size of the tractions. `strained`: the strains of their
  /// own that particles have; null: none has any.
  void forces(const LatticeArrays<dim> &arrays, const BreakScreen &breaking,
              core::LargeArray &records, std::vector<int> &exceeded,
              const SliceNearness *nearness = nullptr, bool faces_too = true,
              const InelasticSweep<dim> *strained = nullptr) const;

  /// Adds to each particle's energy (J) its half of every bond's, as if it had no strain of its own.
  void add_energies(const LatticeArrays<dim> &arrays, core::LargeArray &records,
                    double *energy) const;

private:
  void lay_out(const std::vector<int> &n_bonds_of);
  void add_jumps(core::LargeArray &records, const SliceNearness *nearness) const;
  void set_bond(long place, const Bond<dim> &bond, bool is_i, int neighbour);

  SliceTable<dim> table_;
  mutable core::LargeArray strain_records_; // scratch
  mutable bool faces_at_once_ = false; // many slices had such tractions the last time
  double shear_modulus_;
  bool all_particles_;
  std::vector<const PeriodicImage<dim> *> images_; // of the records of images
  std::vector<std::array<long, 2>> places_; // slot x slice_width + lane of both sides of each bond
};
} // namespace ligament::dem
