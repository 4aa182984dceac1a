// How far the loads of a scene have grown: one number for each course in time that they take.
#pragma once

#include "core/load.h"

#include <Eigen/Core>

#include <vector>

namespace ligament::program
{
/// Loads between two times. Those that grow in proportion take one course; the first one leads.
template <int dim>
class LoadGrowth
{
public:
  /// Times in s.
  LoadGrowth(const std::vector<core::BoundaryLoad<dim>> &loads, double from, double to);

  /// One at least: where nothing grows, it is time.
  int n_courses() const { return courses_.empty() ? 1 : int(courses_.size()); }

  /// Of each course: 0 at the beginning, 1 at the end; monotonous where no load turns.
  Eigen::VectorXd shares(double time) const;
  /// Their rates, in 1/s; 0 where nothing grows.
  Eigen::VectorXd rates(double time) const;
  /// Of the first one.
  double share(double time) const;
  /// When it is that far, in s.
  double time_of(double share) const;

  /// Some load may fall or turn, at corners alone.
  static bool may_turn(const std::vector<core::BoundaryLoad<dim>> &loads);
  /// Where a next one should end, at most at `last`: the next corner of a load.
  static double next_corner(const std::vector<core::BoundaryLoad<dim>> &loads, double from,
                            double last);

private:
  std::vector<const core::BoundaryLoad<dim> *> courses_;
  double from_, to_;
};
} // namespace ligament::program
