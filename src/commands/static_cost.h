// What check knows of a scene whose loading goes by equilibria.
#pragma once

#include "src/simulation/coupled_body.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>

namespace ligament::program
{
/// How many phases there will be is known to nobody before the bonds break; what one equilibrium
/// asks for is.
struct StaticCost
{
  long unknowns = 0;             // of one equilibrium
  std::optional<double> seconds; // of one equilibrium, set-up included; empty: not measured
  std::optional<double> memory;  // bytes that its solver needs beside the body; likewise
};

template <int dim>
StaticCost static_cost(const CoupledBody<dim> &body);

/// Lines for the card of `check`.
std::string to_text(const StaticCost &cost, const Scene &scene);
/// What is not known is null.
nlohmann::ordered_json to_json(const StaticCost &cost);
} // namespace ligament::program
