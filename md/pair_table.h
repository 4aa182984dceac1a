// Functions of distance as kernels load them.
#pragma once

#include "md/potential.h"

namespace ligament::md
{
/// Of one interval, one cache line, t from 0 to 1 in it: f = c0 + t (c1 + t (c2 + t c3)) and
/// -phi' = p0 + t (p1 + t p2), per m; phi = p3 in J at t = 0.
struct alignas(64) PairPiece
{
  double density[4], pull[4];
};

/// f_ab and phi_ab of all intervals, and one more of zeros: distances at the cut-off may be rounded
/// into it.
std::vector<PairPiece> make_pair_table(const Potential &potential, int a, int b);
} // namespace ligament::md
