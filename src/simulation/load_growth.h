// How far the loads of a scene have grown, where one number says it for all of them.
#pragma once

#include "core/load.h"

#include <vector>

namespace ligament::program
{
/// Loads between two times, in steps of the far field.
template <int dim>
class LoadGrowth
{
public:
  /// Times in s.
  LoadGrowth(const std::vector<core::BoundaryLoad<dim>> &loads, double from, double to);

  /// Something changes at all.
  bool is_any() const { return lead_ != nullptr; }
  /// All that change do so in proportion.
  bool is_proportional() const { return is_proportional_; }

  /// 0 at the beginning, 1 at the end; monotonous.
  double share(double time) const;
  /// Its rate, in 1/s.
  double rate(double time) const;

  /// Some load may fall or turn, at corners alone.
  static bool may_turn(const std::vector<core::BoundaryLoad<dim>> &loads);
  /// Where a next one should end, at most at `last`: the next corner of a load.
  static double next_corner(const std::vector<core::BoundaryLoad<dim>> &loads, double from,
                            double last);

private:
  const core::BoundaryLoad<dim> *lead_ = nullptr;
  double from_, to_;
  bool is_proportional_ = true;
};
} // namespace ligament::program
