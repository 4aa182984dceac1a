// What check knows of a scene whose loading goes by equilibria.
#pragma once

#include "src/simulation/coupled_body.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>

namespace ligament::program
{
/// Of each unknown by multigrid, beyond the peak of the set-up: its matrix twice, the levels,
/// vectors; measured (docs/scaling.md). Nodes count like particles, whose blocks they fill.
constexpr double equilibrium_bytes(int dimension)
{
  return dimension == 2 ? 1800 : 3600;
}

/// How many phases there will be is known to nobody before the bonds break; what one equilibrium
/// asks for is.
struct StaticCost
{
  long unknowns = 0;             // of one equilibrium
  std::optional<double> seconds; // of one solve, set-up included; empty: not measured
  double memory = 0;             // bytes beyond the peak of the set-up
  bool is_measured = false;      // the memory; else it is predicted, by multigrid
};

/// Solves once. Leaves the body where it is.
template <int dim>
StaticCost static_cost(const Scene &scene, CoupledBody<dim> &body);

/// Lines for the card of `check`.
std::string to_text(const StaticCost &cost, const Scene &scene, double seconds_per_step);
/// What is not known is null.
nlohmann::ordered_json to_json(const StaticCost &cost);
} // namespace ligament::program
