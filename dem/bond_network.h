// All bonded faces of a packing: lattice bonds as bits over constant index offsets, irregular ones
// as a table.
#pragma once

#include "dem/bond.h"
#include "dem/materials.h"
#include "dem/periodic_images.h"
#include "packings/packing.h"

#include <algorithm>
#include <cstdint>

namespace ligament::dem
{
/// More directions than any lattice here has (FCC 6, BCC 7).
inline constexpr int max_directions = 7;

/// What all lattice bonds of one direction share.
template <int dim>
struct DirectionData
{
  Vector<dim> normal;
  double area, distance; // S, r
  double bending, twist; // k_b, k_t in N m
};

/// Particles [begin, end) whose neighbours lie at the same index offsets: forward[k] along
/// direction k, backward[k] against it. An offset that no particle of the run needs is 0; every
/// offset stays inside the arrays for the whole run.
struct RowSegment
{
  int begin, end;
  std::array<int, max_directions> forward, backward;
};

/// Names a bond: the forward lattice bond of particle `index`, or entry `index` of the table when
/// direction is -1.
struct BondId
{
  int index;
  int direction;
};

template <int dim>
class BondNetwork
{
public:
  /// Bonds of all faces that aren't cracked. Those of other materials than the first one, and all
  /// bonds of particles that have a bond to another material, are in the table, as are bonds to
  /// images; `images` must outlive the network.
  BondNetwork(const packings::Packing<dim> &packing, const Materials &materials,
              const PeriodicImages<dim> *images = nullptr);

  int n_particles() const { return int(mask_.size()); }
  int n_directions() const { return int(directions_.size()); }
  long n_bonds() const { return n_bonds_; }

  const std::vector<DirectionData<dim>> &directions() const { return directions_; }
  const std::vector<RowSegment> &segments() const { return segments_; }
  /// Bit k: the forward bond of direction k carries; bit n_directions + k: the backward one.
  const std::vector<std::uint32_t> &mask() const { return mask_; }

  Bond<dim> bond(const BondId &id) const;

  /// visit(BondId, const Bond<dim> &) for every bond that carries: lattice ones by particle, then
  /// the table.
  template <typename Visit>
  void for_each_bond(Visit &&visit) const;

  /// Only those of the table, without those between materials.
  template <typename Visit>
  void for_each_irregular(Visit &&visit) const;

  /// Only those between materials.
  template <typename Visit>
  void for_each_interface(Visit &&visit) const;

  /// The same for the bonds of several particles (ascending; null: all), each once, in the same
  /// order.
  template <typename Visit>
  void for_each_bond_of_some(const std::vector<int> *particles, Visit &&visit) const;

  /// The same for the bonds of one particle.
  template <typename Visit>
  void for_each_bond_of(int particle, Visit &&visit) const;

  /// The bond no longer carries.
  void remove(const BondId &id);

  /// Every pair keeps the mean of its particles' weights of its energy. Pairs that lose some leave
  /// the lattice for the table: those that keep theirs cost what they did.
  void set_weights(const std::vector<double> &weights);

  static Bond<dim> make_bond(const packings::Face<dim> &face, const Materials &materials,
                             double thickness);

private:
  /// Of one particle those of the table.
  template <typename Visit>
  void for_each_entry_of(int particle, Visit &&visit) const;
  void find_segments(const std::vector<std::array<int, 2 * max_directions>> &offset);
  void index_table();
  const RowSegment &segment_of(int particle) const;
  Bond<dim> lattice_bond(int i, int j, int direction) const;

  std::vector<DirectionData<dim>> directions_;
  double lattice_shear_modulus_; // Pa
  std::vector<std::uint32_t> mask_;
  std::vector<RowSegment> segments_;
  std::vector<Bond<dim>> irregular_;
  std::vector<char> intact_;
  std::vector<int> between_materials_; // entries of the table
  // Particles with entries in the table, ascending, and the rows of their entries.
  std::vector<int> at_table_, first_irregular_, irregular_of_;
  long n_bonds_ = 0;
};

template <int dim>
template <typename Visit>
void BondNetwork<dim>::for_each_bond(Visit &&visit) const
{
  const int n_dir = n_directions();
  for (const RowSegment &s : segments_)
    for (int i = s.begin; i < s.end; ++i)
      for (int k = 0; k < n_dir; ++k)
        if (mask_[i] >> k & 1)
          visit(BondId{i, k}, lattice_bond(i, i + s.forward[k], k));
  for_each_irregular(visit);
  for_each_interface(visit);
}

template <int dim>
template <typename Visit>
void BondNetwork<dim>::for_each_irregular(Visit &&visit) const
{
  for (std::size_t b = 0; b < irregular_.size(); ++b)
    if (intact_[b] && !irregular_[b].joins_materials)
      visit(BondId{int(b), -1}, irregular_[b]);
}

template <int dim>
template <typename Visit>
void BondNetwork<dim>::for_each_interface(Visit &&visit) const
{
  for (const int b : between_materials_)
    if (intact_[b])
      visit(BondId{b, -1}, irregular_[b]);
}

template <int dim>
template <typename Visit>
void BondNetwork<dim>::for_each_bond_of_some(const std::vector<int> *particles, Visit &&visit) const
{
  if (!particles) {
    for_each_bond(visit);
    return;
  }
  using Place = std::array<int, 3>; // lattice, table, between materials; index; direction
  std::vector<Place> places;
  for (const int i : *particles)
    for_each_bond_of(i, [&](const BondId &id, const Bond<dim> &b) {
      places.push_back({id.direction >= 0 ? 0 : b.joins_materials ? 2 : 1, id.index, id.direction});
    });
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  for (const auto &[kind, index, direction] : places)
    visit(BondId{index, direction}, bond({index, direction}));
}

template <int dim>
template <typename Visit>
void BondNetwork<dim>::for_each_bond_of(int particle, Visit &&visit) const
{
  const int n_dir = n_directions(), i = particle;
  const RowSegment &s = segment_of(i);
  for (int k = 0; k < n_dir; ++k) {
    if (mask_[i] >> k & 1)
      visit(BondId{i, k}, lattice_bond(i, i + s.forward[k], k));
    if (mask_[i] >> (n_dir + k) & 1)
      visit(BondId{i + s.backward[k], k}, lattice_bond(i + s.backward[k], i, k));
  }
  for_each_entry_of(i, visit);
}

template <int dim>
template <typename Visit>
void BondNetwork<dim>::for_each_entry_of(int i, Visit &&visit) const
{
  const auto row = std::lower_bound(at_table_.begin(), at_table_.end(), i) - at_table_.begin();
  if (row == std::ptrdiff_t(at_table_.size()) || at_table_[row] != i)
    return;
  for (int b = first_irregular_[row]; b < first_irregular_[row + 1]; ++b)
    if (intact_[irregular_of_[b]])
      visit(BondId{irregular_of_[b], -1}, irregular_[irregular_of_[b]]);
}
} // namespace ligament::dem
