#include "dem/bond_slices.h"

#include "dem/bond_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace ligament::dem
{
namespace
{
/// Particles are sorted by their number of bonds within groups of so many, so that slices have few
/// empty places and neighbours still lie near each other in memory.
constexpr int sorted_group = 32 * slice_width;
/// An array of so many numbers is worth large pages.
constexpr int several_pages = 4096;
} // namespace

template <int dim>
BondSlices<dim>::BondSlices(const BondNetwork<dim> &bonds, double shear_modulus, bool all_particles)
    : shear_modulus_(shear_modulus), all_particles_(all_particles)
{
  const int n = bonds.n_particles();
  std::vector<int> n_bonds_of(n, 0);
  long n_bonds = 0;
  bonds.for_each_irregular([&](BondId id, const Bond<dim> &b) {
    ++n_bonds_of[b.i], ++n_bonds_of[b.j];
    n_bonds = id.index + 1;
  });
  std::vector<int> record_of(n, -1);
  for (int i = 0; i < n; ++i)
    if (all_particles || n_bonds_of[i] > 0) {
      record_of[i] = table_.n_records();
      table_.particle.push_back(i);
    }
  core::require(
      table_.n_records() < std::numeric_limits<int>::max() / record_size / 2,
      fmt::format("/discrete_zone: a rank has {} particles with bonds off the lattice, more "
                  "than can be numbered there; share the body among more ranks (-n)",
                  table_.n_records()));
  lay_out(n_bonds_of);

  // A neighbour beyond a joined side has a record of its own: its displacement is another.
  std::map<std::pair<const PeriodicImage<dim> *, int>, int> image_record;
  const auto neighbour = [&](int particle, const PeriodicImage<dim> *image) {
    if (!image)
      return record_of[particle];
    const auto [place, is_new] = image_record.insert({{image, particle}, table_.n_records()});
    if (is_new) {
      table_.particle.push_back(particle);
      images_.push_back(image);
      ++table_.n_images;
    }
    return place->second;
  };
  std::vector<long> next(table_.n_records());
  for (std::size_t l = 0; l < table_.lane.size() && long(l) < table_.n_records(); ++l)
    next[table_.lane[l] / record_size] =
        long(table_.first_slot[l / slice_width]) * slice_width + long(l % slice_width);
  places_.resize(n_bonds);
  bonds.for_each_irregular([&](BondId id, const Bond<dim> &b) {
    for (const bool is_i : {true, false}) {
      const int own = record_of[is_i ? b.i : b.j];
      const int other =
          is_i ? neighbour(b.j, b.image) : neighbour(b.i, b.image ? b.image->opposite : nullptr);
      places_[id.index][is_i ? 0 : 1] = next[own];
      set_bond(next[own], b, is_i, other * record_size);
      next[own] += slice_width;
    }
  });
}

template <int dim>
void BondSlices<dim>::set_volumes(const BondNetwork<dim> &bonds, const std::vector<double> &volume,
                                  const std::vector<double> &weights)
{
  std::vector<double> covered(volume.size(), 0), shear_modulus(volume.size(), 0);
  bonds.for_each_irregular([&](BondId, const Bond<dim> &b) {
    covered[b.i] += b.area * b.lever_i.dot(b.normal) / dim;
    covered[b.j] -= b.area * b.lever_j.dot(b.normal) / dim;
    shear_modulus[b.i] = shear_modulus[b.j] = b.shear_i;
  });
  table_.per_volume.assign(table_.lane.size(), 0);
  for (int l = 0; l < table_.n_own(); ++l) {
    const int i = table_.particle[table_.lane[l] / record_size];
    if (std::abs(covered[i] - volume[i]) < 1e-9 * volume[i])
      table_.per_volume[l] =
          1 / (2 * shear_modulus[i] * volume[i] * (weights.empty() ? 1 : weights[i]));
  }
}

/// Places of all particles; empty slots refer to the particle itself and have no stiffness.
template <int dim>
void BondSlices<dim>::lay_out(const std::vector<int> &n_bonds_of)
{
  const int n = table_.n_records();
  const auto count = [&](int record) { return n_bonds_of[table_.particle[record]]; };
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  for (int first = 0; first < n; first += sorted_group)
    std::stable_sort(order.begin() + first, order.begin() + std::min(first + sorted_group, n),
                     [&](int a, int b) { return count(a) > count(b); });
  table_.first_slot = {0};
  for (int first = 0; first < n; first += slice_width) {
    int longest = 0;
    for (int l = first; l < first + slice_width; ++l) {
      table_.lane.push_back(record_size * (l < n ? order[l] : 0));
      longest = std::max(longest, l < n ? count(order[l]) : 0);
    }
    table_.first_slot.push_back(table_.first_slot.back() + longest);
    for (int slot = 0; slot < longest; ++slot)
      table_.neighbour.insert(table_.neighbour.end(), table_.lane.end() - slice_width,
                              table_.lane.end());
  }
  const long places = long(table_.neighbour.size());
  table_.geometry = core::LargeArray(places * n_geometry<dim>, places > several_pages);
  table_.stiffness = core::LargeArray(places * n_stiffness<dim>, places > several_pages);
}

template <int dim>
double *SliceTable<dim>::set_bond(long place, const Bond<dim> &b, bool is_i, int neighbour)
{
  const Vector<dim> &own = is_i ? b.lever_i : b.lever_j, &other = is_i ? b.lever_j : b.lever_i;
  const BondLaw<dim> law = law_of(b);
  const long slot = place / slice_width, lane = place % slice_width;
  double *const g = geometry.data() + slot * n_geometry<dim> * slice_width + lane;
  double *const k = stiffness.data() + slot * n_stiffness<dim> * slice_width + lane;
  for (int c = 0; c < dim; ++c) {
    g[c * slice_width] = own[c];
    g[(dim + c) * slice_width] = other[c];
  }
  g[2 * dim * slice_width] = law.area_r;
  k[0] = law.shear;
  this->neighbour[place] = neighbour;
  return k;
}

template <int dim>
void BondSlices<dim>::set_bond(long place, const Bond<dim> &b, bool is_i, int neighbour)
{
  double *const k = table_.set_bond(place, b, is_i, neighbour);
  k[slice_width] = b.bending;
  if (dim == 3)
    k[2 * slice_width] = (b.twist - b.bending) / (b.distance * b.distance);
}

template <int dim>
void BondSlices<dim>::remove(int index)
{
  const Vector<dim> zero = Vector<dim>::Zero();
  for (const long place : places_[index]) {
    set_bond(place, {0, 0, zero, zero, zero, 0, 1, 0, 0}, true, table_.neighbour[place]);
    if (table_.per_volume.empty())
      continue;
    const auto &first = table_.first_slot;
    const auto after = std::upper_bound(first.begin(), first.end(), int(place / slice_width));
    const long slice = after - first.begin() - 1;
    table_.per_volume[slice * slice_width + place % slice_width] = 0;
  }
}

template <int dim>
SliceNearness BondSlices<dim>::nearness(const particles::AwakeRanges &ranges) const
{
  using Rest = particles::RestBlocks<dim>;
  std::vector<std::uint8_t> of(table_.n_records(), 0);
  const auto set = [&](const particles::ParticleRanges &some, int value) {
    auto range = some.begin();
    for (int r = 0; r < table_.n_own(); ++r) {
      const int i = table_.particle[r];
      while (range != some.end() && range->end <= i)
        ++range;
      if (range != some.end() && range->begin <= i)
        of[r] = std::uint8_t(value);
    }
  };
  set(ranges.turned, Rest::turned);
  set(ranges.pressed, Rest::pressed);
  set(ranges.stepped, Rest::awake);
  const auto own_end = table_.particle.begin() + table_.n_own();
  for (int r = table_.n_own(); r < table_.n_records(); ++r)
    of[r] = of[std::lower_bound(table_.particle.begin(), own_end, table_.particle[r]) -
               table_.particle.begin()];
  SliceNearness nearness;
  nearness.slice.assign(table_.n_slices(), 0);
  nearness.records.assign((table_.n_records() + slice_width - 1) / slice_width, 0);
  const auto raise = [&](std::uint8_t &to, int record) { to = std::max(to, of[record]); };
  for (int l = 0; l < table_.n_own(); ++l)
    raise(nearness.slice[l / slice_width], table_.lane[l] / record_size);
  for (int r = 0; r < table_.n_records(); ++r)
    raise(nearness.records[r / slice_width], r);
  return nearness;
}

template <int dim>
void BondSlices<dim>::load(const LatticeArrays<dim> &arrays, core::LargeArray &records,
                           const SliceNearness *nearness) const
{
  if (empty())
    return;
  if (!records.data()) {
    const long n = table_.n_records();
    records = core::LargeArray((n + slice_width) * record_size, n > several_pages / record_size);
  }
  load_records({table_, arrays, records.data(), 0, false, nullptr, nearness});
  add_jumps(records, nearness);
}

template <int dim>
void BondSlices<dim>::add_jumps(core::LargeArray &records, const SliceNearness *nearness) const
{
  for (int k = 0; k < table_.n_images; ++k) {
    const int r = table_.n_own() + k;
    if (nearness && nearness->records[r / slice_width] < particles::RestBlocks<dim>::turned)
      continue;
    for (int c = 0; c < dim; ++c) // displacements come first
      records.data()[long(r) * record_size + c] += images_[k]->jump[c];
  }
}

template <int dim>
void BondSlices<dim>::add_pressures(const LatticeArrays<dim> &arrays, core::LargeArray &records,
                                    const SliceNearness *nearness) const
{
  if (empty())
    return;
  ligament::dem::add_pressures({table_, arrays, records.data(), 0, false, nullptr, nearness});
}

template <int dim>
void BondSlices<dim>::add_strains(const LatticeArrays<dim> &arrays, core::LargeArray &records,
                                  const InelasticSweep<dim> &inelastic,
                                  const SliceNearness *nearness) const
{
  if (empty())
    return;
  SliceSweep<dim> sweep{table_, arrays, records.data(), 0, false, nullptr, nearness};
  sweep.inelastic = &inelastic;
  sweep.responds = all_particles_;
  ligament::dem::add_strains(sweep);
}

template <int dim>
void BondSlices<dim>::forces(const LatticeArrays<dim> &arrays, const BreakScreen &breaking,
                             core::LargeArray &records, std::vector<int> &exceeded,
                             const SliceNearness *nearness, bool faces_too,
                             const InelasticSweep<dim> *strained) const
{
  exceeded.clear();
  if (empty())
    return;
  constexpr double round_off = 1e-9;
  const auto squared = [&](double traction) {
    const double least_strain = traction / (2 * shear_modulus_) * (1 - round_off);
    return traction > 0 ? least_strain * least_strain : SliceSweep<dim>::never;
  };
  SliceSweep<dim> sweep{table_,
                        arrays,
                        records.data(),
                        squared(breaking.least_traction()),
                        all_particles_,
                        &exceeded,
                        nearness};
  sweep.strain = breaking.strength / (2 * shear_modulus_);
  sweep.tangent = breaking.tangent;
  sweep.measure = breaking.measure;
  long n_reached = 0;
  sweep.n_reached = &n_reached;
  sweep.faces_too = faces_too;
  sweep.by_particle = breaking.by_particle;
  sweep.faces_at_once = faces_at_once_ && faces_too && breaking.strength > 0;
  if (strained) {
    const long n = table_.n_records();
    if (!strain_records_.data())
      strain_records_ =
          core::LargeArray((n + slice_width) * record_size, n > several_pages / record_size);
    sweep.inelastic = strained;
    sweep.strain_records = strain_records_.data();
    load_strains(sweep);
  }
  add_slice_forces(sweep);
  if (breaking.strength > 0)
    faces_at_once_ = 2 * n_reached > table_.n_slices();
}

template <int dim>
void BondSlices<dim>::add_energies(const LatticeArrays<dim> &arrays, core::LargeArray &records,
                                   double *energy) const
{
  if (!empty())
    add_slice_energies({table_, arrays, records.data(), 0, false, nullptr, nullptr, energy});
}

template struct SliceTable<2>;
template struct SliceTable<3>;
template class BondSlices<2>;
template class BondSlices<3>;
} // namespace ligament::dem
