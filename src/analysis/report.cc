#include "src/analysis/report.h"

#include "core/check.h"
#include "core/files.h"
#include "src/analysis/phases.h"
#include "src/analysis/verdict.h"
#include "src/drawing/html.h"
#include "src/drawing/plot.h"
#include "src/drawing/run_pictures.h"
#include "src/output/format.h"
#include "src/output/history.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

namespace ligament::program
{
namespace
{
using Rows = std::vector<std::vector<std::string>>;

std::string paragraph(const std::string &cls, const std::string &text)
{
  return "<p class=\"" + cls + "\">" + escape_xml(text) + "</p>\n";
}

bool has_values(const Table &history, const std::string &name)
{
  if (!history.has(name))
    return false;
  const auto &values = history.raw(name);
  return std::any_of(values.begin(), values.end(),
                     [](double v) { return std::isfinite(v) && v != 0; });
}

/// The pictures of the record that exist, inside the page.
std::string pictures(const RunFolder &folder, const RunRecord &record)
{
  std::string text;
  for (const auto &picture : record.pictures) {
    const std::string file = folder.path + "/" + picture.file;
    if (!std::filesystem::exists(file))
      continue;
    const std::string data = core::read_file(file);
    text += fmt::format("<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"/>"
                        "<figcaption>{0}</figcaption></figure>\n",
                        escape_xml(picture.caption), base64(data.data(), data.size()));
  }
  return text.empty() ? ""
                      : "<h2>Specimen and crack</h2>\n<div class=\"pictures\">" + text + "</div>\n";
}

std::string load_curve(const Table &history)
{
  const bool stress = has_values(history, "stress"), strain = has_values(history, "strain");
  const bool load = has_values(history, "load"), shift = has_values(history, "displacement");
  Plot plot;
  if (stress && strain) {
    plot.x = {"mean strain", "1", false};
    plot.y = {"stress", "Pa", false};
    plot.series = {{"", history.raw("strain"), history.raw("stress")}};
  } else if (load) {
    plot.x = shift ? PlotAxis{"displacement", "m", false} : PlotAxis{"time", "s", false};
    plot.y = {"load", "N", false};
    plot.series = {{"", history.raw(shift ? "displacement" : "time"), history.raw("load")}};
  } else
    return "";
  return "<h2>Load curve</h2>\n" + draw_plot(plot);
}

std::string crack_growth(const Table &history, int dimension)
{
  if (!has_values(history, "crack_length"))
    return "";
  Plot plot;
  plot.x = {"time", "s", false};
  plot.y = {dimension == 2 ? "crack length" : "crack area", dimension == 2 ? "m" : "m^2", false};
  plot.series = {{"", history.raw("time"), history.raw("crack_length")}};
  plot.height = 280;
  return "<h2>Crack</h2>\n" + draw_plot(plot);
}

std::string energies(const Table &history, const RunRecord &record)
{
  Plot plot;
  plot.x = {"time", "s", false};
  plot.y = {"energy", "J", false};
  Rows rows;
  const double work = history.has("external_work") && history.n_rows() > 0
                          ? history.raw("external_work").back()
                          : 0;
  for (const auto &column : history.columns()) {
    if (column.unit != "J" || !has_values(history, column.name))
      continue;
    std::string label = column.name;
    std::replace(label.begin(), label.end(), '_', ' ');
    Series series{label, history.raw("time"), history.raw(column.name)};
    series.dashed = column.name == "external_work" || column.name == "residual";
    plot.series.push_back(series);
    const double last = series.y.back();
    rows.push_back(
        {label, quantity(last, "J"), work > 0 ? fmt::format("{:.3g} %", 100 * last / work) : "-"});
  }
  if (rows.empty())
    return "";
  std::string text = "<h2>Energy ledger</h2>\n" + draw_plot(plot) +
                     html_table({has_figures(record) ? "at the end" : "in the last row", "energy",
                                 "of the external work"},
                                rows);
  if (record.energy_residual)
    text += fmt::format("<p>Largest residual of the whole run: {:.2g} of the external work or the "
                        "kinetic energy, whichever was larger.</p>\n",
                        *record.energy_residual);
  return text;
}

/// Of every gauge the columns of one unit in one plot.
std::string gauges(const Table &history, const RunRecord &record)
{
  std::string text;
  for (const GaugeEntry &gauge : record.gauges) {
    text += "<h3>" + escape_xml(gauge.name) + "</h3>\n" +
            paragraph("note", gauge.kind + ": " + gauge.text);
    std::map<std::string, Plot> plots;
    for (const Column &column : history.columns()) {
      const auto &own = gauge.columns;
      if (std::find(own.begin(), own.end(), column.name) == own.end())
        continue;
      Plot &plot = plots[column.unit];
      plot.x = {"time", "s", false};
      plot.y = {gauge.name, column.unit, false};
      plot.series.push_back({column.name, history.raw("time"), history.raw(column.name)});
    }
    for (auto &[unit, plot] : plots) {
      plot.height = 280;
      text += draw_plot(plot);
    }
  }
  return text.empty() ? "" : "<h2>Gauges</h2>\n" + text;
}

std::string timing(const RunRecord &record)
{
  if (record.timing.empty())
    return "";
  double total = 0;
  for (const auto &row : record.timing)
    total += row.seconds;
  Rows rows;
  for (const auto &row : record.timing)
    rows.push_back(
        {row.name, fmt::format("{:.3f}", row.seconds),
         total > 0 ? fmt::format("{:.1f} %", 100 * row.seconds / total) : "-", grouped(row.calls),
         row.calls > 0 ? fmt::format("{:.2f}", 1e6 * row.seconds / double(row.calls)) : "-"});
  rows.push_back({"total", fmt::format("{:.3f}", total), "", "", ""});
  return "<h2>Where the time went</h2>\n" +
         html_table({"section", "seconds", "share", "calls", "µs per call"}, rows);
}

std::string model(const RunRecord &r)
{
  Rows rows;
  const auto add = [&](const std::string &name, const std::string &value) {
    rows.push_back({name, value});
  };
  const auto maybe = [&](const std::string &name, const std::optional<double> &value,
                         const char *unit) {
    if (value)
      add(name, quantity(*value, unit));
  };
  // What is known as soon as the body is built, and what only at the end.
  const bool is_built = !r.kind.empty(), has_ended = has_figures(r);
  const auto when = [&](bool known, const std::string &name, const std::string &value) {
    add(name, known ? value : "-");
  };
  static const std::pair<const char *, const char *> kinds[] = {
      {"coupled", "discrete and finite elements, coupled"},
      {"pure_dem", "discrete elements alone"},
      {"pure_fem", "finite elements alone"}};
  for (const auto &[kind, text] : kinds)
    if (r.kind == kind)
      add("model", text);
  add("dimension", r.dimension == 3 ? "3D" : r.plane.empty() ? "2D" : "2D, plane " + r.plane);
  std::string size;
  for (const double length : r.size)
    size += (size.empty() ? "" : " x ") + quantity(length, "m");
  when(is_built, "specimen", size);
  if (r.particles > 0)
    add("particle spacing d", quantity(r.spacing, "m"));
  when(is_built, "particles", grouped(r.particles));
  when(is_built, "of them in the overlap", grouped(r.overlap_particles));
  when(is_built, "cells", grouped(r.cells));
  if (r.equivalent_particles > 0)
    add("particles of the pure discrete model", grouped(r.equivalent_particles));
  when(is_built, "time step", quantity(r.dt, "s"));
  maybe("stable step, particles", r.dt_critical, "s");
  maybe("stable step, far field", r.dt_far, "s");
  if (r.step_ratio > 1)
    add("far field steps once per", fmt::format("{} steps", r.step_ratio));
  if (!r.regime.empty())
    add("regime of the overlap", r.regime);
  when(has_ended, "steps", grouped(steps_done(r)));
  if (!r.phases.empty())
    add("steps that static phases skipped", grouped(totals(r).skipped));
  when(has_ended, "simulated time", quantity(r.simulated_time, "s"));
  add("ranks", grouped(r.ranks));
  when(has_ended, "wall time, set-up and loop",
       duration(r.setup_seconds) + " + " + duration(r.wall_seconds));
  const std::string most = r.peak_load ? "peak" : "largest";
  maybe(most + " load", r.largest_load, "N");
  maybe(most + " stress", r.largest_stress, "Pa");
  maybe("time of the " + most + " load", r.largest_time, "s");
  when(has_ended, "stiffness",
       r.stiffness ? quantity(*r.stiffness, "Pa") : "none: the load rises on no line");
  maybe("load path gone since", r.broken_time, "s");
  maybe("trusted until", r.trusted_until, "s");
  when(has_ended, "broken faces", grouped(r.broken_bonds));
  if (r.overlap_particles > 0)
    when(has_ended, "of them in the overlap", grouped(r.broken_in_overlap));
  maybe("external work", r.external_work, "J");
  maybe(r.dimension == 2 ? "crack length" : "crack area", r.crack_length,
        r.dimension == 2 ? "m" : "m^2");
  for (const auto &[name, figure] : r.figures)
    add(name, quantity(figure.value, figure.unit));
  return "<h2>Figures</h2>\n" + html_table({"", ""}, rows);
}

std::string warnings(const RunRecord &record)
{
  if (record.warnings.empty())
    return "";
  std::string text = "<h2>Warnings</h2>\n<ul>\n";
  for (const RunWarning &warning : record.warnings)
    text += "<li>" + escape_xml(warning_text(record, warning)) + "</li>\n";
  return text + "</ul>\n";
}

std::string skipped(const RunRecord &record)
{
  if (record.skipped.empty())
    return "";
  std::string text = "<h2>What was left out, and why</h2>\n<ul>\n";
  for (const auto &part : record.skipped)
    text += "<li>" + escape_xml(part.what) + ": " + escape_xml(part.why) + "</li>\n";
  return text + "</ul>\n";
}

std::string comparisons(const RunFolder &folder)
{
  std::vector<std::string> files;
  for (const auto &entry : std::filesystem::directory_iterator(folder.path))
    if (entry.is_regular_file() && entry.path().extension() == ".svg" &&
        entry.path().filename().string().rfind("compare_", 0) == 0)
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::string text;
  for (const auto &file : files)
    text += core::read_file(file);
  return text.empty() ? "" : "<h2>Beside a reference</h2>\n" + text;
}

std::string sources(const RunFolder &folder, const RunRecord &record)
{
  std::string text = "<h2>Files</h2>\n<ul>\n";
  const std::pair<std::string, const char *> files[] = {
      {folder.pvd(),
       "particles, cells and broken faces over time: open this one in ParaView, then "
       "apply Warp By Vector with displacement. fields/*_peak, *_broken and *_end are "
       "the states of the pictures"},
      {folder.history(), "the time series with units"},
      {folder.broken_bonds(), "every broken face with its time"},
      {folder.cut_faces(), "every face that an initial crack cuts"},
      {folder.fragments(), "the pieces at the end, the heaviest first"},
      {folder.log(), "the log"},
      {folder.record(), "the figures of this page for scripts"}};
  for (const auto &[file, meaning] : files)
    if (std::filesystem::exists(file))
      text += "<li><code>" + escape_xml(std::filesystem::path(file).filename()) +
              "</code>: " + meaning + "</li>\n";
  text += "</ul>\n";
  if (std::filesystem::exists(folder.resolved_scene()))
    text += "<details><summary>The scene with all defaults</summary><pre>" +
            escape_xml(core::read_file(folder.resolved_scene())) + "</pre></details>\n";
  return text +
         fmt::format("<p>Ligament {}{}, started {}.</p>\n", escape_xml(record.version),
                     record.commit.empty() ? "" : " (" + escape_xml(record.commit) + ")",
                     record.started.empty() ? "at an unknown time" : escape_xml(record.started));
}
} // namespace

std::string write_report(const std::string &run_folder, const std::vector<std::string> &fields,
                         const std::string &target)
{
  const RunFolder folder{run_folder};
  core::require(folder.holds_a_run(),
                run_folder + ": not the output folder of a run (no run.json in it)");
  RunRecord record = read_figures(folder.record());
  const RunFolder place{target.empty() ? run_folder : target};
  make_folder(place.path);
  if (!fields.empty())
    record.pictures = write_pictures(folder, record, fields, place);

  std::string body = paragraph("headline", headline(record));
  body += paragraph(is_stable(record) ? "verdict" : "verdict bad",
                    record.verdict.empty() ? verdict(record) : record.verdict);
  body +=
      warnings(record) + phases_section(record) + pictures(fields.empty() ? folder : place, record);
  if (std::filesystem::exists(folder.history())) {
    const Table history = read_history(folder, record);
    body += load_curve(history) + gauges(history, record) +
            crack_growth(history, record.dimension) + energies(history, record);
  }
  body += comparisons(folder) + model(record) + timing(record) + skipped(record) +
          sources(folder, record);
  core::write_file(place.report(), html_page(record.title, body));
  return place.report();
}
} // namespace ligament::program
