// A small body of any kind as a static solver sees it, 2D or 3D: for tests of equilibria.
#pragma once

#include "src/simulation/equilibrium_solver.h"
#include "tests/support/small_plate.h"

#include <random>

namespace ligament::tests
{
/// 8 x 60 x 7, a band of particles in the middle, two cells of overlap; elastic, nothing acts.
inline const std::string small_bar = R"({
  "dimension": 3,
  "specimen": {"size": [8, 60, 7]},
  "material": {"youngs_modulus": 1, "poissons_ratio": 0.22, "density": 1},
  "discrete_zone": {
    "region": {"lower": [null, -16, null], "upper": [null, 16, null]}, "packing": "fcc", "spacing": 1
  },
  "far_field": {"cell_size": 3.1},
  "coupling": {"overlap_cells": 2, "transition_cells": 2},
  "time": {"duration": 100},
  "output": {"history_interval": 1, "progress_interval": 1e9}
})";

/// The plate or the bar after `overrides`.
template <int dim>
program::Scene static_scene(const std::vector<std::string> &overrides)
{
  const auto result =
      program::parse_scene(dim == 2 ? small_plate : small_bar, "static_body", overrides);
  for (const auto &error : result.errors)
    ADD_FAILURE() << core::to_string(error);
  return result.scene.value();
}

template <int dim>
struct StaticBody
{
  core::Log log;
  core::Timers timers;
  program::CoupledBody<dim> body;
  program::EquilibriumSolver<dim> solver;

  explicit StaticBody(const program::Scene &scene,
                      algebra::Preconditioning kind = dim == 2
                                                          ? algebra::Preconditioning::cholesky
                                                          : algebra::Preconditioning::multigrid)
      : body(program::make_body<dim>(scene, log, timers)), solver(body, kind)
  {
  }
  explicit StaticBody(const std::vector<std::string> &overrides)
      : StaticBody(static_scene<dim>(overrides))
  {
  }
  program::StaticSystem<dim> &system() { return solver.system(); }

  /// Numbers between -1 and 1 for all unknowns.
  Eigen::VectorXd noise(unsigned seed)
  {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    Eigen::VectorXd y =
        Eigen::VectorXd::NullaryExpr(system().size(), [&] { return uniform(random); });
    system().drop_inert(y);
    return y;
  }

  /// By what forces fall in a small motion y, from differences of the forces at the loads of t = 0.
  /// Their error: the square of the step, and round-off over it.
  Eigen::VectorXd force_difference(const Eigen::VectorXd &y, double step = 1e-6)
  {
    const auto start = system().place();
    system().displace(y, step);
    const Eigen::VectorXd up = system().forces(0);
    system().put_back(start);
    system().displace(y, -step);
    const Eigen::VectorXd down = system().forces(0);
    system().put_back(start);
    system().forces(0);
    return (down - up) / (2 * step);
  }
};

/// /loads, each [side, kind, x, y] or [side, kind, x, y, z] with "null" for what is free.
struct Load
{
  const char *side, *kind;
  std::vector<std::string> value;
};
inline std::string loads(const std::vector<Load> &list)
{
  std::string text;
  for (const Load &load : list) {
    std::string value;
    for (const auto &component : load.value)
      value += (value.empty() ? "" : ", ") + component;
    text += std::string(text.empty() ? "" : ", ") + R"({"boundary": ")" + load.side + R"(", ")" +
            load.kind + R"(": [)" + value + R"(], "ramp": 1})";
  }
  return "/loads=[" + text + "]";
}
} // namespace ligament::tests
