#include "dem/stress_screen.h"

#include "dem/tensors.h"

#include <algorithm>
#include <numeric>

namespace ligament::dem
{
namespace
{
/// Particles are sorted by their number of bonds within groups of so many.
constexpr int sorted_group = 64 * slice_width;
/// An array of so many numbers is worth large pages.
constexpr int several_pages = 4096;
/// Candidates in one table, or a quarter of all particles: more of them are looked at table by
/// table, and none is kept.
constexpr int most_at_once = 1 << 15;

/// Ascending. Where a wave or a crack runs, those beside the ones of a step come next.
template <int dim>
std::vector<int> with_neighbours(const std::vector<int> &particles, const BondNetwork<dim> &bonds)
{
  std::vector<int> all = particles;
  for (const int i : particles)
    bonds.for_each_bond_of(
        i, [&](BondId, const Bond<dim> &b) { all.push_back(b.i == i ? b.j : b.i); });
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}
} // namespace

template <int dim>
std::vector<int> StressScreen<dim>::keep(const std::vector<int> &candidates, bool own_terms,
                                         const ScreenedBody<dim> &body)
{
  idle_ = 0;
  std::vector<int> kept;
  const int n = int(candidates.size());
  const int most = std::max(most_at_once, body.bonds.n_particles() / 4);
  if (n <= most) {
    constexpr int slack = 1024;
    const bool mostly_others = n_candidates_ > 4 * n + slack;
    if (mostly_others || !find_lanes(candidates)) {
      std::vector<int> all = with_neighbours(candidates, body.bonds);
      constexpr int most_neighbours = 3;
      if (int(all.size()) > most_neighbours * n)
        all = candidates;
      if (!mostly_others && n_candidates_ < 2 * n) // those of before are likely to come again
        all.insert(all.end(), table_.particle.begin(), table_.particle.begin() + n_candidates_);
      lay_out(std::move(all), body);
      find_lanes(candidates);
    }
    add_kept(candidates, own_terms, body, kept);
    return kept;
  }
  for (int first = 0; first < n; first += most) {
    const std::vector<int> some(candidates.begin() + first,
                                candidates.begin() + std::min(n, first + most));
    lay_out(some, body);
    find_lanes(some);
    add_kept(some, own_terms, body, kept);
  }
  clear();
  return kept;
}

template <int dim>
bool StressScreen<dim>::find_lanes(const std::vector<int> &candidates)
{
  if (n_candidates_ > 0 && candidates == asked_)
    return true;
  asked_.clear();
  std::vector<int> lanes;
  const auto begin = table_.particle.begin(), end = begin + n_candidates_;
  auto known = begin; // ascending, as the candidates
  for (const int i : candidates) {
    while (known != end && *known < i)
      ++known;
    if (known == end || *known != i)
      return false;
    lanes.push_back(lane_of_[known - begin]);
  }
  asked_ = candidates;
  lanes_of_asked_ = std::move(lanes);
  return true;
}

template <int dim>
void StressScreen<dim>::lay_out(std::vector<int> candidates, const ScreenedBody<dim> &body)
{
  clear();
  std::sort(candidates.begin(), candidates.end());
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
  n_candidates_ = int(candidates.size());
  std::vector<int> record_of(body.bonds.n_particles(), -1);
  std::vector<int> &particle = table_.particle;
  for (const int i : candidates) {
    record_of[i] = table_.n_records();
    particle.push_back(i);
  }
  std::vector<int> n_bonds;
  const auto add_neighbours = [&](int begin, int end) {
    for (int r = begin; r < end; ++r) {
      n_bonds.push_back(0);
      body.bonds.for_each_bond_of(particle[r], [&](BondId, const Bond<dim> &b) {
        if (b.joins_materials)
          return;
        ++n_bonds[r];
        const int j = b.i == particle[r] ? b.j : b.i;
        if (record_of[j] < 0) {
          record_of[j] = table_.n_records();
          particle.push_back(j);
        }
      });
    }
  };
  add_neighbours(0, n_candidates_);
  const int n_with_bonds = n_with_bonds_ = table_.n_records();
  add_neighbours(n_candidates_, n_with_bonds);
  for (int r = 0; r < table_.n_records(); ++r)
    places_.push_back({particle[r], r});
  std::sort(places_.begin(), places_.end());
  particle.push_back(particle[0]); // of lanes without a particle

  lane_of_.assign(table_.n_records(), -1);
  table_.first_slot = {0};
  add_slices(0, n_candidates_, n_bonds);
  n_first_slices_ = table_.n_slices();
  add_slices(n_candidates_, n_with_bonds, n_bonds);
  const long places = long(table_.neighbour.size());
  table_.geometry = core::LargeArray(places * n_geometry<dim>, places > several_pages);
  table_.stiffness = core::LargeArray(places * n_stiffness<dim>, places > several_pages);
  for (int r = 0; r < n_with_bonds; ++r) {
    const int i = particle[r], lane = lane_of_[r];
    table_.per_volume[lane] = body.per_volume(i);
    long place = long(table_.first_slot[lane / slice_width]) * slice_width + lane % slice_width;
    body.bonds.for_each_bond_of(i, [&](BondId, const Bond<dim> &b) {
      if (b.joins_materials)
        return;
      set_bond(place, b, b.i == i, record_of[b.i == i ? b.j : b.i] * record_size, body.limit(b));
      place += slice_width;
    });
  }
  const long n = table_.n_records() + slice_width;
  records_ = core::LargeArray(n * record_size, n > several_pages / record_size);
  stress_ = core::LargeArray(n * record_size, n > several_pages / record_size);
  faces_ = core::LargeArray(long(longest_) * StressSweep<dim>::face_size * slice_width, false);
}

/// Of the records [begin, end); empty slots refer to the particle itself and have no stiffness.
template <int dim>
void StressScreen<dim>::add_slices(int begin, int end, const std::vector<int> &n_bonds)
{
  std::vector<int> order(end - begin);
  std::iota(order.begin(), order.end(), begin);
  const int n = int(order.size()), nobody = table_.n_records() - 1;
  for (int first = 0; first < n; first += sorted_group)
    std::stable_sort(order.begin() + first, order.begin() + std::min(first + sorted_group, n),
                     [&](int a, int b) { return n_bonds[a] > n_bonds[b]; });
  for (int first = 0; first < n; first += slice_width) {
    int longest = 0;
    for (int l = first; l < first + slice_width; ++l) {
      const int record = l < n ? order[l] : nobody;
      lane_of_[record] = int(table_.lane.size());
      table_.lane.push_back(record_size * record);
      longest = std::max(longest, l < n ? n_bonds[record] : 0);
    }
    longest_ = std::max(longest_, longest);
    table_.first_slot.push_back(table_.first_slot.back() + longest);
    for (int slot = 0; slot < longest; ++slot)
      table_.neighbour.insert(table_.neighbour.end(), table_.lane.end() - slice_width,
                              table_.lane.end());
  }
  lane_of_[nobody] = -1;
  table_.per_volume.resize(table_.lane.size(), 0.);
}

template <int dim>
void StressScreen<dim>::set_bond(long place, const Bond<dim> &b, bool is_i, int neighbour,
                                 double limit)
{
  table_.set_bond(place, b, is_i, neighbour)[slice_width] = limit;
}

template <int dim>
auto StressScreen<dim>::find(int particle) const -> const Place *
{
  const auto at = std::lower_bound(places_.begin(), places_.end(), Place{particle, 0});
  return at == places_.end() || at->particle != particle ? nullptr : &*at;
}

template <int dim>
void StressScreen<dim>::remove(const Bond<dim> &bond)
{
  if (bond.joins_materials)
    return; // the table has none of them
  const Vector<dim> zero = Vector<dim>::Zero();
  for (const auto &[i, j] : {std::pair(bond.i, bond.j), std::pair(bond.j, bond.i)}) {
    const Place *const own = find(i), *const other = find(j);
    if (!own || lane_of_[own->record] < 0)
      continue;
    const int lane = lane_of_[own->record], slice = lane / slice_width;
    int found = 0;
    for (int slot = table_.first_slot[slice]; slot < table_.first_slot[slice + 1]; ++slot) {
      const long place = long(slot) * slice_width + lane % slice_width;
      if (!other || table_.neighbour[place] != other->record * record_size)
        continue;
      ++found;
      set_bond(place, {i, i, zero, zero, zero, 0, 1, 0, 0}, true, own->record * record_size, 0);
    }
    if (found != 1) { // more than one bond between the two
      clear();
      return;
    }
  }
}

/// False where there are none.
template <int dim>
bool StressScreen<dim>::find_moments(const ScreenedBody<dim> &body)
{
  for (const int r : with_moments_)
    std::fill_n(moments_.begin() + long(r) * record_size, record_size, 0.);
  with_moments_.clear();
  body.for_each_moment([&](int i, const Vector<dim> &lever, const Vector<dim> &force) {
    const Place *const place = find(i);
    if (!place || lane_of_[place->record] < 0)
      return;
    if (moments_.empty())
      moments_.assign(std::size_t(table_.n_records()) * record_size, 0.);
    const Strain<dim> product =
        table_.per_volume[lane_of_[place->record]] * symmetric_product<dim>(lever, force);
    for (int c = 0; c < n_strains<dim>; ++c)
      moments_[long(place->record) * record_size + c] += product[c];
    with_moments_.push_back(place->record);
  });
  return !with_moments_.empty();
}

template <int dim>
void StressScreen<dim>::load(const ScreenedBody<dim> &body, int begin, int end)
{
  SliceSweep<dim> sweep{table_, body.arrays, records_.data(), 0, false, nullptr};
  sweep.first_record = begin;
  sweep.end_record = end;
  load_records(sweep);
  take_pressures(body.arrays, table_, records_.data(), begin, end);
}

template <int dim>
void StressScreen<dim>::add_kept(const std::vector<int> &candidates, bool own_terms,
                                 const ScreenedBody<dim> &body, std::vector<int> &kept)
{
  load(body, 0, n_with_bonds_);
  std::vector<std::uint8_t> slices(table_.n_slices(), 0), lanes = slices;
  for (const int lane : lanes_of_asked_)
    lanes[lane / slice_width] |= std::uint8_t(1 << lane % slice_width);
  const auto want_where_lanes_are_left = [&] {
    for (std::size_t s = 0; s < slices.size(); ++s)
      slices[s] = lanes[s] != 0;
  };
  StressSweep<dim> sweep{
      table_,         records_.data(), find_moments(body) ? moments_.data() : nullptr,
      stress_.data(), slices.data(),   lanes.data(),
      faces_.data(),  body.tangent,    body.cone,
      body.measure};
  std::vector<std::uint8_t> done(slices.size(), 0);
  if (own_terms) {
    want_where_lanes_are_left();
    find_stresses(sweep);
    done = slices;
    if (std::all_of(lanes.begin(), lanes.end(), [](std::uint8_t bits) { return bits == 0; }))
      return;
  }
  load(body, n_with_bonds_ / slice_width * slice_width, table_.n_records());
  want_where_lanes_are_left();
  for (int s = 0; s < n_first_slices_; ++s)
    for (int slot = table_.first_slot[s]; lanes[s] != 0 && slot < table_.first_slot[s + 1]; ++slot)
      for (int l = 0; l < slice_width; ++l)
        if (lanes[s] >> l & 1) {
          const int neighbour = table_.neighbour[long(slot) * slice_width + l] / record_size;
          slices[lane_of_[neighbour] / slice_width] = 1;
        }
  for (std::size_t s = 0; s < slices.size(); ++s)
    slices[s] = slices[s] && !done[s];
  sweep.lanes = nullptr;
  find_stresses(sweep);
  want_where_lanes_are_left();
  sweep.lanes = lanes.data();
  find_tensions(sweep);
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const int lane = lanes_of_asked_[k];
    if (lanes[lane / slice_width] >> (lane % slice_width) & 1)
      kept.push_back(candidates[k]);
  }
}

template class StressScreen<2>;
template class StressScreen<3>;
} // namespace ligament::dem
