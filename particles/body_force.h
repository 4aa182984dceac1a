// A force on every mass, such as gravity: acceleration times mass, and the work that it does.
#pragma once

#include "core/exact_sum.h"
#include "core/load.h"
#include "core/state.h"
#include "particles/particles.h"

namespace ligament::particles
{
template <int dim>
class BodyForce
{
public:
  BodyForce() = default;
  /// Those of the loads that accelerate.
  explicit BodyForce(const std::vector<core::BoundaryLoad<dim>> &loads);

  bool is_empty() const { return loads_.empty(); }
  /// In m/s^2, at a time in s.
  Vector<dim> acceleration(double time) const;
  /// To the forces of a time in s.
  void add_forces(Particles<dim> &particles, double time) const;
  /// Adds to work() what it did since the last call on every block of one's own particles: the mean
  /// of the accelerations times the change of sum m u. Blocks are those of sums over particles,
  /// which no cut of the body divides.
  void book_work(const Particles<dim> &particles, double time);
  /// In J. Those of parts are summed to that of the body.
  const core::ExactSum &work() const { return work_; }

  /// Blocks are called by their first particles.
  void save(core::State &state, const Particles<dim> &particles) const;
  void load(const core::State &state, const Particles<dim> &particles);

private:
  /// The first one of each block.
  static std::vector<int> blocks(const Particles<dim> &particles);

  std::vector<core::BoundaryLoad<dim>> loads_;
  core::ExactSum work_;
  bool is_booked_ = false;
  Vector<dim> old_acceleration_ = Vector<dim>::Zero();
  std::vector<Vector<dim>> old_moment_; // kg m, of each block
};
} // namespace ligament::particles
