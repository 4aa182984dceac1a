#include "src/sweep/summary.h"

#include "core/files.h"
#include "src/drawing/html.h"
#include "src/output/format.h"
#include "src/sweep/pareto.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ligament::program
{
namespace
{
using Errors = std::optional<CompareResult> CaseResult::*;
using Rows = std::vector<std::vector<std::string>>;

std::string time_name(const Study &study)
{
  return study.cost == Cost::run_time ? "run time" : "core time";
}

struct Point
{
  const CaseResult *result;
  double time, error;
};

/// Every case with a cost and an error, also one without any difference from the reference.
std::vector<Point> points(const Study &study, const std::vector<CaseResult> &results, Errors errors)
{
  std::vector<Point> list;
  for (const CaseResult &r : results)
    if (r.time(study.cost) && r.*errors && r.end.status == CaseEnd::Status::done)
      if (const auto error = measured(*(r.*errors), study.measure); error && std::isfinite(*error))
        list.push_back({&r, *r.time(study.cost), *error});
  return list;
}

std::vector<Point> front(const std::vector<Point> &all)
{
  std::vector<double> times, errors;
  for (const Point &p : all) {
    times.push_back(p.time);
    errors.push_back(p.error);
  }
  std::vector<Point> chosen;
  for (const std::size_t i : pareto_front(times, errors))
    chosen.push_back(all[i]);
  return chosen;
}

/// What can be drawn: a logarithmic axis has no place for an error of 0.
std::vector<Point> drawable(std::vector<Point> all)
{
  all.erase(std::remove_if(all.begin(), all.end(), [](const Point &p) { return !(p.error > 0); }),
            all.end());
  return all;
}

void add_point(Series &series, const Point &p, const std::string &note)
{
  series.x.push_back(p.time);
  series.y.push_back(p.error);
  series.notes.push_back(note);
}

Series marks(const std::string &label)
{
  Series series;
  series.label = label;
  series.markers = true;
  series.line = false;
  return series;
}

std::string cell(const std::optional<double> &value, const std::string &format = "{:.3g}")
{
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

std::string front_table(const Study &study, const std::vector<Point> &all)
{
  Rows rows;
  for (const Point &p : front(all))
    rows.push_back({p.result->scene->name, duration(p.time),
                    study.measure == Measure::crack_distance
                        ? fmt::format("{:.2f} d", p.error)
                        : fmt::format("{:.2g} %", 100 * p.error)});
  return html_table({"no other case is both faster and better", time_name(study), "error"}, rows);
}

std::string all_cases(const std::vector<CaseResult> &results)
{
  Rows rows;
  for (const CaseResult &r : results) {
    const auto of = [&](Errors errors, auto member) {
      return r.*errors ? percent((*(r.*errors)).*member) : "-";
    };
    std::vector<std::string> row = {r.scene->name, to_string(r.end.status)};
    if (r.record)
      row.insert(row.end(),
                 {grouped(r.record->particles), grouped(r.record->cells), duration(*r.run_time()),
                  r.record->peak_load ? quantity(*r.record->peak_load, "N") : "-"});
    else
      row.insert(row.end(), 4, "-");
    row.push_back(of(&CaseResult::coupling, &CompareResult::peak_load_error));
    row.push_back(of(&CaseResult::coupling, &CompareResult::stiffness_error));
    row.push_back(r.coupling ? cell(r.coupling->crack_distance_mean, "{:.2f}") : "-");
    row.push_back(of(&CaseResult::total, &CompareResult::peak_load_error));
    row.push_back(r.record ? cell(r.record->energy_residual, "{:.1e}") : "-");
    rows.push_back(row);
  }
  return html_table({"case", "status", "particles", "cells", "run time", "peak load",
                     "peak load, coupling error", "stiffness, coupling error", "crack distance, d",
                     "peak load, total error", "energy residual"},
                    rows);
}

std::string refusals(const std::vector<CaseResult> &results)
{
  std::string text;
  for (const CaseResult &r : results)
    if (r.end.status != CaseEnd::Status::done)
      text += "<li>" +
              escape_xml(r.scene->name + " (" + to_string(r.end.status) + "): " + r.end.reason) +
              "</li>\n";
  return text.empty() ? "" : "<h2>Refused or stopped</h2>\n<ul>\n" + text + "</ul>\n";
}
} // namespace

Plot error_plot(const Study &study, const std::vector<CaseResult> &results, Errors errors)
{
  const auto whole = points(study, results, errors), all = drawable(whole);
  Plot plot;
  plot.height = 460;
  plot.x = {time_name(study), "s", true};
  plot.y = {measure_name(study.measure), study.measure == Measure::crack_distance ? "d" : "1",
            true};
  std::vector<std::string> groups;
  for (const Point &p : all)
    if (std::find(groups.begin(), groups.end(), p.result->scene->group) == groups.end())
      groups.push_back(p.result->scene->group);
  for (const std::string &group : groups) {
    Series series = marks(group.empty() ? "single cases" : group);
    for (const Point &p : all)
      if (p.result->scene->group == group && !p.result->scene->rival)
        add_point(series, p, group.empty() ? p.result->scene->name : "");
    if (!series.x.empty())
      plot.series.push_back(series);
  }
  Series rivals = marks("rivals");
  rivals.hollow = true;
  for (const Point &p : all)
    if (p.result->scene->rival)
      add_point(rivals, p, p.result->scene->name);
  if (!rivals.x.empty())
    plot.series.push_back(rivals);
  Series line;
  line.label = "Pareto front";
  for (const Point &p : drawable(front(whole))) // that of the table
    add_point(line, p, "");
  if (!line.x.empty())
    plot.series.push_back(line);
  for (const CaseResult &r : results)
    if (errors == &CaseResult::coupling && r.is_reference && r.time(study.cost) && !all.empty()) {
      Series limit;
      limit.label = time_name(study) + " of the reference (" + r.scene->name + ")";
      limit.dashed = true;
      const auto [low, high] = std::minmax_element(
          all.begin(), all.end(), [](const Point &a, const Point &b) { return a.error < b.error; });
      limit.x = {*r.time(study.cost), *r.time(study.cost)};
      limit.y = {low->error, high->error};
      plot.series.push_back(limit);
    }
  return plot;
}

void write_summary(const StudyFolder &folder, const Study &study, const CaseList &list,
                   const std::vector<CaseResult> &results, const std::vector<std::string> &notes)
{
  int most_jobs = 1;
  std::size_t n_done = 0, n_stopped = 0;
  for (const CaseResult &r : results) {
    most_jobs = std::max(most_jobs, r.cost ? r.cost->jobs : 1);
    n_done += r.end.status == CaseEnd::Status::done;
    n_stopped += r.end.status == CaseEnd::Status::stopped;
  }
  std::string body = fmt::format(
      "<p class=\"headline\">{} cases, {} computed, {} stopped by their guards. {}</p>\n",
      list.cases.size(), n_done, n_stopped,
      most_jobs == 1 ? "One run at a time: the times are clean."
                     : "Several runs at a time: the times disturb each other.");
  const struct
  {
    const char *title, *file;
    Errors errors;
  } axes[] = {{"Error of the coupling", "coupling_error.svg", &CaseResult::coupling},
              {"Total error", "total_error.svg", &CaseResult::total}};
  for (const auto &axis : axes) {
    const auto all = points(study, results, axis.errors);
    if (all.empty())
      continue;
    body += std::string("<h2>") + axis.title + "</h2>\n";
    if (const Plot plot = error_plot(study, results, axis.errors); !plot.series.empty()) {
      const std::string drawing = draw_plot(plot);
      core::write_file(folder.path() + "/" + axis.file, drawing);
      body += drawing;
    }
    body += front_table(study, all);
  }
  body += "<h2>All cases</h2>\n" + all_cases(results) + refusals(results);
  for (const std::string &note : notes)
    body += "<p>" + escape_xml(note) + "</p>\n";
  body += "<p>All figures with units: <code>sweep.csv</code>; each run has a report of its own "
          "below <code>runs</code>.</p>\n";
  core::write_file(folder.summary(), html_page(study.title.empty() ? "Study" : study.title, body));
}
} // namespace ligament::program
