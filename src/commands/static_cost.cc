#include "src/commands/static_cost.h"

#include "src/commands/peak_memory.h"
#include "src/output/format.h"
#include "src/simulation/equilibrium_solver.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

namespace ligament::program
{
namespace
{
constexpr long most_to_measure = 300000; // unknowns: some seconds
}

template <int dim>
StaticCost static_cost(const Scene &scene, CoupledBody<dim> &body)
{
  StaticCost cost;
  const double before = peak_memory();
  EquilibriumSolver<dim> solver(body, preconditioning(scene.time.static_solver));
  cost.unknowns = solver.system().n_unknowns();
  if (cost.unknowns > most_to_measure) {
    cost.memory = equilibrium_bytes(dim) * double(solver.system().size());
    return cost;
  }
  const auto start = std::chrono::steady_clock::now();
  Eigen::VectorXd response;
  if (solver.find_response(0, scene.time.duration, response) ==
      EquilibriumSolver<dim>::End::converged)
    cost.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  cost.memory = peak_memory() - before;
  cost.is_measured = true;
  return cost;
}

std::string to_text(const StaticCost &cost, const Scene &scene, double seconds_per_step)
{
  std::string text = fmt::format("  loading              {:>12}: unknown number of phases\n",
                                 word_of(scene.time.loading));
  text += fmt::format("  unknowns             {:>12} in one equilibrium\n", cost.unknowns);
  if (cost.seconds)
    text += fmt::format(
        "  one equilibrium      {:>12} on one process, as long as {} steps; a phase takes 3 to 5, "
        "where faces slide some tens\n",
        duration(*cost.seconds), grouped(std::llround(*cost.seconds / seconds_per_step)));
  else
    text += fmt::format("  one equilibrium           unknown: only measured up to {} unknowns\n",
                        grouped(most_to_measure));
  const bool is_factor = scene.time.static_solver == StaticSolver::cholesky;
  text += fmt::format("  its memory           {:>12.0f} MiB{}\n", cost.memory / 1048576,
                      cost.is_measured ? " beyond the set-up's"
                      : is_factor      ? " by multigrid; by cholesky unknown, and more"
                                       : " beyond the set-up's, predicted");
  return text;
}

nlohmann::ordered_json to_json(const StaticCost &cost)
{
  nlohmann::ordered_json json = {
      {"unknowns", cost.unknowns}, {"seconds", nullptr}, {"memory_bytes", cost.memory}};
  if (cost.seconds)
    json["seconds"] = *cost.seconds;
  return json;
}

template StaticCost static_cost(const Scene &, CoupledBody<2> &);
template StaticCost static_cost(const Scene &, CoupledBody<3> &);
} // namespace ligament::program
