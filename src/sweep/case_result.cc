#include "src/sweep/case_result.h"

#include "core/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
std::optional<double> relative(const std::optional<double> &value, double right)
{
  return value && right != 0 ? std::optional(*value / right - 1) : std::nullopt;
}

/// Where a reference lies; empty when it was not computed.
std::string place_of_reference(const std::string &name, std::vector<CaseResult> &results,
                               bool CaseResult::*mark)
{
  std::string place = name; // a path, unless it is a row
  for (CaseResult &r : results)
    if (r.scene->group.empty() && r.scene->name == name) {
      r.*mark = true;
      place = r.end.run ? r.end.run->path : "";
    }
  return place;
}

void compare_all(const std::string &reference, bool CaseResult::*is_reference,
                 std::optional<CompareResult> CaseResult::*target, std::vector<CaseResult> &results,
                 std::vector<std::string> &notes)
{
  if (reference.empty())
    return;
  bool is_incomplete = false;
  for (CaseResult &r : results) {
    if (!r.end.run || r.*is_reference || r.end.run->path == reference)
      continue;
    try {
      r.*target = compare(r.end.run->path, reference);
      is_incomplete =
          is_incomplete || (!(r.*target)->complete && r.end.status == CaseEnd::Status::done);
      write_comparison(*(r.*target), r.end.run->path);
    } catch (const core::InputError &error) {
      notes.push_back(r.scene->name + ": " + error.what());
    } catch (const core::EnvironmentError &error) {
      notes.push_back(r.scene->name + ": no plot: " + error.what());
    }
  }
  if (is_incomplete)
    notes.push_back("the reference \"" + reference +
                    "\" is not complete: errors against it mean little; finish it with `ligament "
                    "resume`");
}

void compare_with_figures(const TotalReference &total, std::vector<CaseResult> &results)
{
  for (CaseResult &r : results) {
    if (!r.record)
      continue;
    CompareResult c;
    if (total.peak_load)
      c.peak_load_error = relative(r.record->peak_load, *total.peak_load);
    if (total.peak_stress)
      c.peak_load_error = relative(r.record->peak_stress, *total.peak_stress);
    if (total.stiffness)
      c.stiffness_error = relative(r.record->stiffness, *total.stiffness);
    if (c.peak_load_error || c.stiffness_error)
      r.total = c;
  }
}
} // namespace

std::optional<double> CaseResult::run_time() const
{
  return record ? std::optional(record->setup_seconds + record->wall_seconds) : std::nullopt;
}

std::optional<double> CaseResult::time(Cost kind) const
{
  if (kind == Cost::run_time)
    return run_time();
  return cost ? std::optional(cost->core_seconds) : std::nullopt;
}

std::vector<CaseResult> evaluate(const Study &study, const CaseList &list,
                                 const std::map<std::string, CaseEnd> &ends,
                                 std::vector<std::string> &notes)
{
  std::vector<CaseResult> results;
  for (const Case &c : list.cases) {
    CaseResult r;
    r.scene = &c;
    r.end =
        c.refused.empty() ? ends.at(c.id) : CaseEnd{CaseEnd::Status::refused, c.refused, {}, false};
    if (r.end.run) {
      r.record = read_run_record(r.end.run->record());
      r.cost = read_cost(*r.end.run);
    }
    results.push_back(std::move(r));
  }
  const auto measure = [&](const std::string &name, bool CaseResult::*mark,
                           std::optional<CompareResult> CaseResult::*target) {
    const std::string place = name.empty() ? "" : place_of_reference(name, results, mark);
    if (place.empty() && !name.empty())
      notes.push_back("the reference \"" + name + "\" was not computed: no errors against it");
    compare_all(place, mark, target, results, notes);
  };
  measure(study.reference, &CaseResult::is_reference, &CaseResult::coupling);
  measure(study.total.reference, &CaseResult::is_total_reference, &CaseResult::total);
  compare_with_figures(study.total, results);
  return results;
}

std::optional<double> measured(const CompareResult &r, Measure measure)
{
  const auto magnitude = [](const std::optional<double> &value) {
    return value ? std::optional(std::abs(*value)) : std::nullopt;
  };
  switch (measure) {
  case Measure::peak_load:
    return magnitude(r.peak_load_error);
  case Measure::stiffness:
    return magnitude(r.stiffness_error);
  case Measure::energy:
    return magnitude(r.energy_error);
  case Measure::crack_distance:
    return r.crack_distance_mean;
  case Measure::displacement:
    return r.displacement_error;
  case Measure::breaking_time:
    return magnitude(r.breaking_time_error);
  }
  return {};
}

std::string measure_name(Measure measure)
{
  constexpr const char *names[] = {
      "error of the peak load", "error of the stiffness",     "error of the work up to the peak",
      "distance of the cracks", "error of the displacements", "error of the time of breaking"};
  return names[int(measure)];
}
} // namespace ligament::program
