#include "src/commands/static_cost.h"

#include "src/output/format.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace ligament::program
{
namespace
{
/// Particles that are no pads have displacements and, where the force turns them, rotations; nodes
/// that do not hang have displacements in the components that no load holds.
template <int dim>
long unknowns_of(const CoupledBody<dim> &body)
{
  long n = 0;
  if (body.zone) {
    const auto &state = body.zone->state;
    long particles = state.size();
    if (const auto *overlap = body.coupler->overlap())
      particles -= std::count_if(overlap->members.begin(), overlap->members.end(),
                                 [](const auto &member) { return member.pad; });
    n += particles * (dim + (state.turns ? n_spins<dim> : 0));
  }
  if (!body.far)
    return n;
  const auto &mesh = body.far->mesh();
  std::vector<bool> hangs(mesh.n_nodes());
  for (const auto &hanging : mesh.hanging)
    hangs[hanging.node] = true;
  for (int i = 0; i < mesh.n_nodes(); ++i)
    for (int c = 0; c < dim; ++c)
      n += !hangs[i] && !body.far->is_held(i, c);
  return n;
}
} // namespace

// Time and memory of a solve belong here once a solver is asked for them.
template <int dim>
StaticCost static_cost(const CoupledBody<dim> &body)
{
  StaticCost cost;
  cost.unknowns = unknowns_of(body);
  return cost;
}

std::string to_text(const StaticCost &cost, const Scene &scene)
{
  std::string text = fmt::format("  loading              {:>12}: unknown number of phases\n",
                                 word_of(scene.time.loading));
  text += fmt::format("  unknowns             {:>12} in one equilibrium\n", cost.unknowns);
  if (cost.seconds)
    text += fmt::format("  one equilibrium      {:>12}\n", duration(*cost.seconds));
  if (cost.memory)
    text += fmt::format("  its solver           {:>12.0f} MiB\n", *cost.memory / 1048576);
  return text;
}

nlohmann::ordered_json to_json(const StaticCost &cost)
{
  nlohmann::ordered_json json = {
      {"unknowns", cost.unknowns}, {"seconds", nullptr}, {"memory_bytes", nullptr}};
  if (cost.seconds)
    json["seconds"] = *cost.seconds;
  if (cost.memory)
    json["memory_bytes"] = *cost.memory;
  return json;
}

template StaticCost static_cost(const CoupledBody<2> &);
template StaticCost static_cost(const CoupledBody<3> &);
} // namespace ligament::program
