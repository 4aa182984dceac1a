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
  /// To the forces of a time in s.
  void add_forces(Particles<dim> &particles, double time) const;
  /// Adds to work() what it did since the last call: the mean of the accelerations times the change
  /// of sum m u, which is what the sum over all particles gives.
  void book_work(const Particles<dim> &particles, double time);
  /// In J.
  double work() const { return work_.value(); }

  void save(core::State &state) const;
  void load(const core::State &state);

private:
  Vector<dim> acceleration(double time) const;

  std::vector<core::BoundaryLoad<dim>> loads_;
  core::ExactSum work_;
  bool is_booked_ = false;
  Vector<dim> old_acceleration_ = Vector<dim>::Zero(), old_moment_ = Vector<dim>::Zero(); // kg m
};
} // namespace ligament::particles
