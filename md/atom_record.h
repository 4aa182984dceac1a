// A place of an atom, or a force on one, as kernels load it.
#pragma once

namespace ligament::md
{
/// Three components and one that fills the vector, which kernels may use; in 2D z = 0.
struct alignas(32) AtomRecord
{
  double x = 0, y = 0, z = 0; // m or N
  double extra = 0;
};

inline double *component(AtomRecord &r)
{
  return &r.x;
}
inline const double *component(const AtomRecord &r)
{
  return &r.x;
}
} // namespace ligament::md
