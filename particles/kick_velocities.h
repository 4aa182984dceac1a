// What forces do to velocities, vectorised: divisions by masses cost no more than reading them.
#pragma once

namespace ligament::particles
{
/// v += dt f / m of n particles, one component; the same bits on all instruction sets.
void kick_velocities(double *velocity, const double *force, const double *mass, double dt, int n);
} // namespace ligament::particles
