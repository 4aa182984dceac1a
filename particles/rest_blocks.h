// Which parts of a body are at rest, so that steps pass over them until a wave arrives.
#pragma once

#include "particles/particles.h"

#include <functional>

namespace ligament::particles
{
/// Motion from which on a block moves; zeros: any motion at all.
struct RestLimits
{
  double displacement = 0; // m, of a component
  double velocity = 0;     // m/s
  double rotation = 0;     // rad
  double spin = 0;         // rad/s

  /// Strain `threshold`, in a body with this spacing (m) and speed of waves (m/s).
  static RestLimits of_strain(double threshold, double spacing, double wave_speed);
};

/// Blocks of particles side by side in memory and in space. A block moves as soon as a particle of
/// it does; it is awake when it moves or lies within two bonds of one that does, as far as a force
/// sees (theory.md section 1.11). Blocks only ever wake up. With limits of zero the particles of
/// all other blocks stay where they are to the last bit, whether they are stepped or not.
template <int dim>
class RestBlocks
{
public:
  using VisitPair = std::function<void(int, int)>;

  /// `for_each_pair` visits the pairs of particles that bonds or faces join. Blocks with a particle
  /// that is displaced, turned, in motion or under a force move from the start.
  RestBlocks(const Particles<dim> &particles,
             const std::function<void(const VisitPair &)> &for_each_pair,
             const RestLimits &limits = {});

  /// The blocks of these particles move from now on: something outside acts on them.
  void wake(const std::vector<int> &particles);

  /// Blocks with a particle that is displaced, turned, in motion or under a force move from now on.
  void wake_what_moved(const Particles<dim> &particles);

  /// After ghosts have come from other ranks: those that have begun to move wake what sees them,
  /// before the forces of the same step. Needs limits of zero: other ranks cut other blocks.
  void look_at_ghosts(const Particles<dim> &particles);

  /// Before each drift: wakes what the present velocities reach, counts a step.
  void look(const Particles<dim> &particles);

  /// Those of the part that are awake.
  const AwakeRanges &ranges() const { return ranges_; }
  bool all_awake() const { return n_awake_ == n_particles_; }
  bool is_awake(int particle) const { return nearness(particle) >= awake; }
  bool is_exact() const { return exact_; }

  /// Falls by one from bond to bond, from `moving` to 0: what the blocks' ranges go by.
  int nearness(int particle) const { return nearness_[block_of(particle)]; }
  static constexpr int turned = 1, pressed = 2, awake = 3, moving = 5;

  /// Grows when the ranges do.
  long version() const { return version_; }

  /// Which blocks move, called by their first particles, as the table "blocks", and the counts of
  /// steps. Blocks that this body has more rest until something wakes them.
  void save(core::State &state, const core::Names &names) const;
  void load(const core::State &state, const core::Names &names);

  /// Share of the particle-steps so far that were left out.
  double share_at_rest() const;

private:
  static constexpr int largest_block = 64;

  int n_blocks() const { return int(begin_.size()) - 1; }
  int block_of(int particle) const
  {
    int block = first_block_[particle / largest_block];
    while (begin_[block + 1] <= particle)
      ++block;
    return block;
  }
  void cut(const Particles<dim> &particles);
  void find_neighbours(const std::function<void(const VisitPair &)> &for_each_pair);
  bool is_forced(const Particles<dim> &particles, int block) const;
  bool moves(const Particles<dim> &particles, int block) const;
  bool has_moved_ghost(const Particles<dim> &particles, int block) const;
  void raise(int block, int nearness);
  template <typename Moves>
  void wake_where(Moves &&moves_now);
  void update_ranges();

  int n_particles_;
  RestLimits limits_;
  bool exact_;
  std::vector<int> begin_;                   // first particle of each block, and the end
  std::vector<int> first_block_;             // that holds one of each `largest_block` particles
  std::vector<std::vector<int>> neighbours_; // of each block
  std::vector<std::uint8_t> nearness_;       // of each block
  std::vector<int> raised_;                  // scratch
  std::vector<int> rim_;                     // blocks that are awake and don't move yet
  Part part_;
  AwakeRanges ranges_;
  int n_awake_ = 0;
  long version_ = 0;
  double steps_ = 0, particle_steps_ = 0;
};
} // namespace ligament::particles
