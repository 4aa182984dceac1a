// Ghosts: particles that a rank sees and another one steps. Their motion is sent after each drift.
#pragma once

#include "core/ranks.h"
#include "particles/particles.h"

namespace ligament::particles
{
/// Whose each particle at hand is. One process owns all of them.
struct Owners
{
  core::Ranks ranks;
  std::vector<int> of; // empty: all are one's own

  bool is_own(int i) const { return of.empty() || of[i] == ranks.rank(); }
};

/// Who sends what to whom, found once: each rank asks the owners for its ghosts by name. Ghosts may
/// lie anywhere in the order.
template <int dim>
class Halo
{
public:
  /// Nothing is sent.
  Halo() = default;
  /// Of what is at hand from index `first` on, by `owners`. Throws core::InputError on all ranks
  /// where an owner doesn't have what it is asked for.
  Halo(const Owners &owners, const Particles<dim> &particles, int first = 0);

  /// Overwrites displacement and orientation of the ghosts by those that their owners have.
  void update(Particles<dim> &particles);

  int n_ghosts() const;
  /// Ranks from or to which something is sent.
  int n_neighbours() const { return int(sides_.size()); }
  /// Bytes that one update sends from here.
  std::size_t bytes(const Particles<dim> &particles) const;

private:
  struct Side
  {
    int rank;
    std::vector<int> sent, ghosts; // here, in the order of their names
    std::vector<double> out, in;
  };
  /// visit(array) for every component that is sent.
  template <typename P, typename Visit>
  static void for_each_sent(P &particles, Visit &&visit);

  core::Ranks ranks_;
  std::vector<Side> sides_; // by rank
};
} // namespace ligament::particles
