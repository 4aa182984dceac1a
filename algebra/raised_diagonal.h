// What preconditioners see of a diagonal entry.
#pragma once

namespace ligament::algebra
{
/// Raised against motions that nothing resists; one where the unknown has no stiffness at all.
inline double raised(double diagonal)
{
  return diagonal == 0 ? 1.0 : (1 + 1e-9) * diagonal;
}
} // namespace ligament::algebra
