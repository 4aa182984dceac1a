// Equilibrium of a body whose surface is held where a field of displacements has it.
#pragma once

#include "src/simulation/static_system.h"

#include <functional>

namespace ligament::program
{
using PlaneField = std::function<Vector<2>(const Vector<2> &)>;

/// From the reference state to equilibrium with the far field's nodes on some sides (numbers of
/// core/types.h) at `field`, until forces are round-off. The field's strains must be so small that
/// their squares are round-off. No overlap may end at these sides: what acts on its particles is
/// carried by nodes that are not held. Returns the largest motion of what is held.
double settle_with_sides(CoupledBody<2> &body, const std::function<bool(int boundary)> &is_held,
                         const PlaneField &field);

/// Largest distance of a particle or node from where the field has it.
double largest_distance(const CoupledBody<2> &body, const PlaneField &field);
} // namespace ligament::program
