#include "particles/rest_blocks.h"

#include "core/check.h"
#include "core/sums.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ligament::particles
{
RestLimits RestLimits::of_strain(double threshold, double spacing, double wave_speed)
{
  return {threshold * spacing, threshold * wave_speed, threshold, threshold * wave_speed / spacing};
}

template <int dim>
RestBlocks<dim>::RestBlocks(const Particles<dim> &p,
                            const std::function<void(const VisitPair &)> &for_each_pair,
                            const RestLimits &limits)
    : n_particles_(p.size()), limits_(limits),
      exact_(limits.displacement == 0 && limits.velocity == 0 && limits.rotation == 0 &&
             limits.spin == 0),
      part_(p.part)
{
  cut(p);
  find_neighbours(for_each_pair);
  update_ranges();
  wake_what_moved(p);
}

template <int dim>
template <typename Moves>
void RestBlocks<dim>::wake_where(Moves &&moves_now)
{
  const long before = version_;
  for (int b = 0; b < n_blocks(); ++b)
    if (nearness_[b] < moving && moves_now(b))
      raise(b, moving);
  if (version_ != before)
    update_ranges();
}

// A block that ends one row and begins the next would wake both sides of the body.
template <int dim>
void RestBlocks<dim>::cut(const Particles<dim> &p)
{
  constexpr int smallest_row = 16;
  const auto way = [&](int i) { return (get(p.reference, i + 1) - get(p.reference, i)).norm(); };
  const double sum = core::exact_sum(std::max(n_particles_ - 1, 0), way).value();
  const double jump = 4 * sum / n_particles_; // rows of a lattice: 8 spacings
  begin_ = {0};
  for (int i = 0; i < n_particles_; ++i) {
    const int begin = begin_.back(), n = i + 1 - begin;
    const bool ends = i + 1 == n_particles_ || (n >= smallest_row && way(i) > jump);
    if (!ends)
      continue;
    const int pieces = (n + largest_block - 1) / largest_block;
    for (int k = 1; k <= pieces; ++k)
      begin_.push_back(begin + int(long(n) * k / pieces));
  }
  nearness_.assign(n_blocks(), 0);
  for (int b = 0; b < n_blocks(); ++b)
    while (int(first_block_.size()) * largest_block < begin_[b + 1])
      first_block_.push_back(b);
}

template <int dim>
void RestBlocks<dim>::find_neighbours(const std::function<void(const VisitPair &)> &for_each_pair)
{
  neighbours_.resize(n_blocks());
  const auto join = [&](int a, int b) {
    auto &list = neighbours_[a];
    if (std::find(list.rbegin(), list.rend(), b) == list.rend())
      list.push_back(b);
  };
  for_each_pair([&](int i, int j) {
    const int a = block_of(i), b = block_of(j);
    if (a == b)
      return;
    join(a, b);
    join(b, a);
  });
}

template <int dim>
bool RestBlocks<dim>::is_forced(const Particles<dim> &p, int block) const
{
  const auto acts = [&](const std::vector<double> &values) {
    return !values.empty() && // else nothing turns
           std::any_of(values.begin() + begin_[block], values.begin() + begin_[block + 1],
                       [](double f) { return f != 0; });
  };
  return std::any_of(p.force.begin(), p.force.end(), acts) ||
         std::any_of(p.torque.begin(), p.torque.end(), acts);
}

template <int dim>
bool RestBlocks<dim>::moves(const Particles<dim> &p, int block) const
{
  const auto exceeds = [&](const std::vector<double> &values, double limit) {
    double largest = 0;
    for (int i = begin_[block]; i < begin_[block + 1] && !values.empty(); ++i)
      largest = std::max(largest, std::abs(values[i]));
    return largest > limit;
  };
  bool found = false;
  for (int c = 0; c < dim; ++c)
    found = found || exceeds(p.velocity[c], limits_.velocity) ||
            exceeds(p.displacement[c], limits_.displacement);
  for (const auto &spin : p.spin)
    found = found || exceeds(spin, limits_.spin);
  // Vector part of the quaternion: half the rotation.
  for (int c = dim == 2 ? 0 : 1; c < Particles<dim>::n_rotations; ++c)
    found = found || exceeds(p.rotation[c], dim == 2 ? limits_.rotation : limits_.rotation / 2);
  return found;
}

template <int dim>
bool RestBlocks<dim>::has_moved_ghost(const Particles<dim> &p, int block) const
{
  for (int i = begin_[block]; i < begin_[block + 1]; ++i) {
    if (p.part.owns(i))
      continue;
    bool moved = false;
    for (const auto &u : p.displacement)
      moved = moved || u[i] != 0;
    for (int c = dim == 2 ? 0 : 1; c < Particles<dim>::n_rotations && p.turns; ++c)
      moved = moved || p.rotation[c][i] != 0;
    if (moved)
      return true;
  }
  return false;
}

template <int dim>
void RestBlocks<dim>::look_at_ghosts(const Particles<dim> &p)
{
  core::require(exact_, "blocks of parts rest without a threshold only");
  if (all_awake())
    return;
  wake_where([&](int b) { return has_moved_ghost(p, b); });
}

template <int dim>
void RestBlocks<dim>::raise(int block, int nearness)
{
  if (nearness_[block] >= nearness)
    return;
  nearness_[block] = std::uint8_t(nearness);
  raised_ = {block};
  for (std::size_t k = 0; k < raised_.size(); ++k) { // in the order of their nearness
    const int next = nearness_[raised_[k]] - 1;
    for (const int b : neighbours_[raised_[k]])
      if (nearness_[b] < next) {
        nearness_[b] = std::uint8_t(next);
        raised_.push_back(b);
      }
  }
  ++version_;
}

template <int dim>
void RestBlocks<dim>::wake(const std::vector<int> &particles)
{
  const long before = version_;
  for (const int i : particles)
    raise(block_of(i), moving);
  if (version_ != before)
    update_ranges();
}

template <int dim>
void RestBlocks<dim>::wake_what_moved(const Particles<dim> &p)
{
  wake_where([&](int b) { return moves(p, b) || is_forced(p, b); });
}

template <int dim>
void RestBlocks<dim>::look(const Particles<dim> &p)
{
  if (!all_awake()) {
    const long before = version_;
    for (const int b : rim_)
      if (moves(p, b))
        raise(b, moving);
    if (version_ != before)
      update_ranges();
  }
  ++steps_;
  particle_steps_ += n_awake_;
}

template <int dim>
void RestBlocks<dim>::update_ranges()
{
  const auto collect = [&](std::vector<ParticleRange> &ranges, int least) {
    ranges.clear();
    for (int b = 0; b < n_blocks(); ++b) {
      if (nearness_[b] < least)
        continue;
      if (!ranges.empty() && ranges.back().end == begin_[b])
        ranges.back().end = begin_[b + 1];
      else
        ranges.push_back({begin_[b], begin_[b + 1]});
    }
  };
  collect(ranges_.stepped, awake);
  collect(ranges_.pressed, pressed);
  collect(ranges_.turned, turned);
  n_awake_ = 0;
  for (const auto &range : ranges_.stepped)
    n_awake_ += range.end - range.begin;
  if (!part_.is_whole(n_particles_))
    ranges_ = ranges_.within(part_);
  rim_.clear();
  for (int b = 0; b < n_blocks(); ++b)
    if (nearness_[b] >= awake && nearness_[b] < moving)
      rim_.push_back(b);
}

template <int dim>
void RestBlocks<dim>::save(core::State &state, const core::Names &names) const
{
  std::map<std::int64_t, std::int64_t> nearness;
  for (int b = 0; b < n_blocks(); ++b)
    nearness[names.name(begin_[b])] = nearness_[b];
  std::vector<std::int64_t> keys, values;
  for (const auto &[key, value] : nearness) {
    keys.push_back(key);
    values.push_back(value);
  }
  core::Table table(std::move(keys));
  table.add("nearness", values);
  state["blocks"] = std::move(table);
  core::save_value(state, "rest", "steps", steps_);
  core::save_value(state, "rest", "particle_steps", particle_steps_);
}

template <int dim>
void RestBlocks<dim>::load(const core::State &state, const core::Names &names)
{
  const core::Table &table = core::table(state, "blocks");
  const auto nearness = table.integers("nearness");
  std::fill(nearness_.begin(), nearness_.end(), 0);
  for (std::size_t r = 0; r < table.n_rows(); ++r) {
    const int i = names.index(table.keys()[r]);
    if (i >= 0 && nearness[r] == moving)
      raise(block_of(i), moving);
  }
  steps_ = core::load_real(state, "rest", "steps");
  particle_steps_ = core::load_real(state, "rest", "particle_steps");
  ++version_;
  update_ranges();
}

template <int dim>
double RestBlocks<dim>::share_at_rest() const
{
  return steps_ > 0 && n_particles_ > 0 ? 1 - particle_steps_ / (steps_ * n_particles_) : 0;
}

template class RestBlocks<2>;
template class RestBlocks<3>;
} // namespace ligament::particles
