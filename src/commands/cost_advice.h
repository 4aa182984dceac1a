// What to change in a scene whose coupling costs more than it saves.
#pragma once

#include "src/commands/step_cost.h"
#include "src/scene/read_scene.h"

#include <string>
#include <vector>

namespace ligament::program
{
struct CostAdvice
{
  /// Other values of some keys, and how many times faster than pure discrete elements the scene
  /// would be with them; the best first.
  struct Option
  {
    std::vector<std::string> overrides; // "/path=value", as --set takes them
    double saving;
  };
  std::vector<Option> options;
  /// Settings that could not be measured, and why not the last one of them.
  int n_refused = 0;
  std::string refused_because;
  /// A zone of so many particles would cost what it saves; empty where none would.
  std::optional<std::int64_t> break_even_particles;

  bool pure_is_better() const { return options.empty() || options.front().saving <= 1; }
};

/// Measures the scene with other cell sizes, step ratios and overlaps, as `check` measures the
/// scene itself: each is set up and stepped for a moment. Values that the scene refuses are
/// counted.
template <int dim>
CostAdvice advise(const ReadResult &input, const CoupledBody<dim> &body, const StepCost &cost);

/// Lines for the card of `check`.
std::string to_text(const CostAdvice &advice, std::int64_t particles);
nlohmann::ordered_json to_json(const CostAdvice &advice);
} // namespace ligament::program
