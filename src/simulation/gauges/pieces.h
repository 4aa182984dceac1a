// Which particles and nodes hang together: the pieces of a body, of all ranks.
#pragma once

#include "src/simulation/coupled_body.h"

namespace ligament::program
{
/// Numbers of pieces, the heaviest first; of those as heavy as each other the one whose first
/// particle, or node, comes first.
struct BodyPieces
{
  static constexpr int elsewhere = -1;

  std::vector<int> of_particle; // at hand; `elsewhere`: another rank owns it
  std::vector<int> of_node;     // on the first rank
  std::vector<double> mass;     // kg, of the pieces
};

/// Particles that bonds join are one piece; cells do not break, and hold the particles in them. Of
/// several ranks, which all call it, each gives the masses (kg) of the particles that it owns, and
/// the first one those of the nodes.
template <int dim>
BodyPieces find_pieces(const CoupledBody<dim> &body, const std::vector<double> &particle_mass,
                       const std::vector<double> &node_mass);
} // namespace ligament::program
