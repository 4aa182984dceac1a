#include "src/commands/cost_advice.h"

#include "core/check.h"
#include "src/output/format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
// Seconds of stepping for each option.
constexpr double moment = 0.15;

// Cells over particle spacing: below, the overlap is refused or inaccurate; above, it is coarse.
constexpr double least_ratio = 2.5, largest_ratio = 8;

/// How much faster than pure discrete elements the scene is with these overrides; InputError where
/// they are refused.
template <int dim>
double saving_with(const ReadResult &input, const std::vector<std::string> &overrides)
{
  const ReadResult changed = parse_scene(input.resolved.dump(), "scene", overrides);
  core::require(changed.scene.has_value(),
                changed.errors.empty() ? "" : changed.errors.front().message);
  core::Log log;
  core::Timers timers;
  auto body = make_body<dim>(*changed.scene, log, timers);
  const StepCost cost = measure_step_cost(*changed.scene, body, timers, moment);
  return cost.saving(body.equivalent_particles, body.zone->state.size());
}

/// The settings worth a measurement: each cell size with the largest step ratio that its stable
/// step allows.
template <int dim>
std::vector<std::vector<std::string>> candidates(const Scene &scene, const CoupledBody<dim> &body)
{
  std::vector<std::vector<std::string>> all;
  const bool has_ratio = scene.coupling.scheme == coupling::Scheme::fine_scale_split;
  const auto step_ratio = [&](double factor) { return int(0.6 * factor * body.dt_far / body.dt); };
  const double h = scene.far_field->cell_size;
  for (const double factor : {1., 1.5, 2., 3., 1 / 1.5}) {
    const double ratio = factor * h / scene.zone.spacing;
    if (factor != 1 && (ratio < least_ratio || ratio > largest_ratio))
      continue;
    std::vector<std::string> overrides;
    if (factor != 1)
      overrides.push_back(fmt::format("/far_field/cell_size={:.4g}", factor * h));
    // A refined mesh grows with its finest cell: a little less than in proportion.
    const int m = std::max(1, step_ratio(factor == 1 ? 1 : 0.97 * factor));
    if (has_ratio && m != scene.coupling.step_ratio)
      overrides.push_back(fmt::format("/coupling/step_ratio={}", m));
    if (!overrides.empty())
      all.push_back(overrides);
    if (scene.coupling.overlap_cells > 2) {
      overrides.push_back("/coupling/overlap_cells=2");
      all.push_back(overrides);
    }
  }
  return all;
}
} // namespace

template <int dim>
CostAdvice advise(const ReadResult &input, const CoupledBody<dim> &body, const StepCost &cost)
{
  CostAdvice advice;
  for (const auto &overrides : candidates(*input.scene, body))
    try {
      advice.options.push_back({overrides, saving_with<dim>(input, overrides)});
    } catch (const core::InputError &error) {
      ++advice.n_refused;
      advice.refused_because = error.what();
    }
  std::stable_sort(advice.options.begin(), advice.options.end(),
                   [](const auto &a, const auto &b) { return a.saving > b.saving; });
  // What is not the particles' stays when the zone shrinks: overlap and far field.
  const double particles = body.zone->state.size();
  const double others = particles * (1 / cost.discrete_share - 1); // in particles
  const double even = double(body.equivalent_particles) - others;
  if (even > body.coupler->overlap()->members.size())
    advice.break_even_particles = std::int64_t(even);
  return advice;
}

std::string to_text(const CostAdvice &advice, std::int64_t particles)
{
  std::string text = "  coupling costs more than it saves";
  if (advice.pure_is_better()) {
    text += ": pure discrete elements, --set /far_field=none, are the better choice;\n";
    if (advice.options.empty())
      text += advice.n_refused == 0
                  ? "  there is no other cell size, step ratio or overlap to try"
                  : fmt::format("  none of {} other cell sizes, step ratios and overlaps could be "
                                "measured: {}",
                                advice.n_refused, advice.refused_because);
    else
      text += fmt::format("  no cell size, step ratio or overlap that was tried changes that, the "
                          "best reaches {:.2f}x",
                          advice.options.front().saving);
  } else
    text += "; faster than pure discrete elements would be";
  text += "\n";
  for (const auto &option : advice.options)
    if (option.saving > 1)
      text += fmt::format("    {:.2f}x with --set {}\n", option.saving,
                          fmt::join(option.overrides, " --set "));
  if (advice.break_even_particles && *advice.break_even_particles < particles)
    text += fmt::format("    a zone of less than {} particles in place of {}: make "
                        "/discrete_zone/region smaller\n",
                        grouped(*advice.break_even_particles), grouped(particles));
  return text;
}

nlohmann::ordered_json to_json(const CostAdvice &advice)
{
  nlohmann::ordered_json json = {{"pure_is_better", advice.pure_is_better()},
                                 {"break_even_particles", nullptr},
                                 {"options", nlohmann::ordered_json::array()},
                                 {"refused", advice.n_refused}};
  if (advice.break_even_particles)
    json["break_even_particles"] = *advice.break_even_particles;
  for (const auto &option : advice.options)
    json["options"].push_back({{"set", option.overrides}, {"predicted_saving", option.saving}});
  return json;
}

template CostAdvice advise(const ReadResult &, const CoupledBody<2> &, const StepCost &);
template CostAdvice advise(const ReadResult &, const CoupledBody<3> &, const StepCost &);
} // namespace ligament::program
