#include "src/analysis/verdict.h"

#include "src/analysis/phases.h"
#include "src/output/format.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <vector>

namespace ligament::program
{
namespace
{
/// Above this share of the largest energy the ledger is not closed well enough to trust a run.
constexpr double largest_good_residual = 1e-2;
/// Up to here the ledger counts as closed: the share that any figure of the run may owe to it.
constexpr double closed_residual = 1e-4;

std::string join(const std::vector<std::string> &parts)
{
  std::string text;
  for (const auto &part : parts)
    text += (text.empty() ? "" : "; ") + part;
  return text;
}

std::string model_part(const RunRecord &r)
{
  if (r.kind == "pure_fem")
    return fmt::format("{} cells", grouped(r.cells));
  if (r.kind == "pure_dem") {
    std::string text = grouped(r.particles) + " particles";
    const double seconds = r.phases.empty() ? r.wall_seconds : totals(r).dynamic_s;
    if (seconds > 0)
      text += fmt::format(", {:.3g} million particle-steps per second",
                          1e-6 * double(r.particles) * double(steps_done(r)) / seconds);
    return text;
  }
  std::string text =
      fmt::format("{} particles and {} cells", grouped(r.particles), grouped(r.cells));
  if (r.equivalent_particles > 0)
    text += fmt::format(" stood for {} particles", grouped(r.equivalent_particles));
  if (const auto saving = predicted_saving(r))
    text += fmt::format(": {:.1f} x {} than pure discrete elements would be at this rate",
                        *saving >= 1 ? *saving : 1 / *saving, *saving >= 1 ? "faster" : "slower");
  return text;
}

std::string residual_part(double residual)
{
  std::string text = fmt::format("energy residual {:.1g}", residual);
  if (residual > closed_residual && residual <= largest_good_residual)
    text += fmt::format(" of the largest energy, above the {:.0e} of a closed balance",
                        closed_residual);
  return text;
}
} // namespace

bool has_figures(const RunRecord &r)
{
  return r.status != "running" && !(r.status == "failed" && r.wall_seconds == 0);
}

RunRecord read_figures(const std::string &path)
{
  RunRecord r = read_run_record(path);
  if (has_figures(r))
    return r;
  r.largest_load = r.largest_stress = r.largest_time = {};
  r.peak_load = r.peak_stress = r.peak_time = {};
  r.stiffness = r.broken_time = r.trusted_until = {};
  r.crack_length = r.external_work = r.energy_residual = r.discrete_seconds = {};
  r.steps = 0;
  r.simulated_time = r.wall_seconds = 0;
  r.broken_bonds = r.broken_in_overlap = 0;
  r.regime.clear();
  r.phases.clear();
  r.timing.clear();
  r.warnings.clear();
  r.verdict.clear();
  return r;
}

std::string incompleteness_with_reason(const RunRecord &r)
{
  return incompleteness(r) + (r.reason.empty() ? "" : ": " + r.reason);
}

std::string warning_text(const RunRecord &r, const RunWarning &warning)
{
  if (!warning.energy)
    return warning.text;
  std::string cost = quantity(*warning.energy, "J");
  if (r.external_work && *r.external_work > 0)
    cost += fmt::format(", {:.2g} of the external work", *warning.energy / *r.external_work);
  return warning.text + " (" + cost + ")";
}

// Warnings with an energy are about the result, others about input and files.
bool is_stable(const RunRecord &r)
{
  return r.is_complete() && r.energy_residual.value_or(0) <= largest_good_residual &&
         !r.trusted_until && r.broken_in_overlap == 0 &&
         std::none_of(r.warnings.begin(), r.warnings.end(),
                      [](const RunWarning &w) { return w.energy.has_value(); });
}

// What equilibria of the pure discrete model would cost is not measured by steps.
std::optional<double> predicted_saving(const RunRecord &r)
{
  double output = 0; // both models write files at the same times; larger ones are not foreseen
  for (const auto &row : r.timing)
    if (row.name == "output")
      output += row.seconds;
  if (!r.phases.empty() || r.particles == 0 || r.equivalent_particles == 0 || !r.discrete_seconds ||
      !(*r.discrete_seconds > 0) || !(r.wall_seconds > 0))
    return {};
  // Both models take the same number of steps: the coupler leaves the critical step alone.
  const double pure =
      *r.discrete_seconds * double(r.equivalent_particles) / double(r.particles) + output;
  return pure / r.wall_seconds;
}

std::string verdict(const RunRecord &r)
{
  std::vector<std::string> parts;
  if (!r.kind.empty()) // the body is built
    parts.push_back(model_part(r));
  if (!r.phases.empty())
    parts.push_back(phases_sentence(r));
  if (r.energy_residual)
    parts.push_back(residual_part(*r.energy_residual));
  if (!r.is_complete())
    parts.push_back("it " + incompleteness_with_reason(r));
  if (r.energy_residual && !(*r.energy_residual <= largest_good_residual))
    parts.push_back("the energies do not add up: do not trust this run");
  for (const RunWarning &warning : r.warnings)
    if (warning.text != r.reason)
      parts.push_back("warning: " + warning_text(r, warning));
  if (r.energy_residual && is_stable(r))
    parts.push_back("nothing unstable");
  return join(parts);
}

std::string headline(const RunRecord &r)
{
  if (!has_figures(r))
    return fmt::format("The run {}.", incompleteness_with_reason(r));
  std::string text;
  if (!r.is_complete())
    text = fmt::format("The run {}: ", incompleteness(r));
  if (r.largest_load)
    text += fmt::format("{} {}", r.peak_load ? "peak load" : "largest load",
                        quantity(*r.largest_load, "N"));
  if (r.largest_load && r.largest_stress)
    text += fmt::format(" ({})", quantity(*r.largest_stress, "Pa"));
  if (r.largest_load && r.largest_time)
    text += fmt::format(" after {}", quantity(*r.largest_time, "s"));
  if (r.largest_load)
    text += "; ";
  text += r.broken_bonds == 0 ? "nothing broke" : grouped(r.broken_bonds) + " broken faces";
  if (r.broken_bonds > 0 && r.crack_length)
    text += r.dimension == 2 ? ", crack length " + quantity(*r.crack_length, "m")
                             : ", crack area " + quantity(*r.crack_length, "m^2");
  if (r.broken_in_overlap > 0)
    text += fmt::format(", {} of them in the overlap", grouped(r.broken_in_overlap));
  text[0] = char(std::toupper(static_cast<unsigned char>(text[0])));
  return text + ".";
}
} // namespace ligament::program
