#include "src/analysis/compare.h"

#include "core/files.h"
#include "core/parameters/spelling.h"
#include "src/analysis/body_difference.h"
#include "src/analysis/compared_side.h"
#include "src/analysis/crack_path.h"
#include "src/analysis/field_error.h"
#include "src/analysis/phases.h"
#include "src/analysis/verdict.h"
#include "src/drawing/html.h"
#include "src/drawing/plot.h"
#include "src/output/broken_bonds.h"
#include "src/output/format.h"
#include "src/output/run_folder.h"
#include "src/output/run_record.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <tuple>

namespace ligament::program
{
namespace
{
std::optional<double> relative_error(const std::optional<double> &run,
                                     const std::optional<double> &reference)
{
  if (!run || !reference || *reference == 0)
    return {};
  return *run / *reference - 1;
}

std::optional<double> ratio(const std::optional<double> &a, const std::optional<double> &b)
{
  if (!a || !b || !(*a > 0) || !(*b > 0))
    return {};
  return *a / *b;
}
struct Distances
{
  std::optional<double> mean, max;
};

/// Both directions, in units of `diameter`.
Distances crack_distance(const std::vector<BrokenBond> &run_part,
                         const std::vector<BrokenBond> &run,
                         const std::vector<BrokenBond> &reference_part,
                         const std::vector<BrokenBond> &reference, double diameter)
{
  Distances result;
  double sum = 0, largest = 0;
  int n_directions = 0;
  for (const auto &distances :
       {nearest_distances(run_part, reference), nearest_distances(reference_part, run)})
  {
    if (distances.empty())
      continue;
    double direction = 0;
    for (const double distance : distances) {
      direction += distance / diameter;
      largest = std::max(largest, distance / diameter);
    }
    sum += direction / double(distances.size());
    ++n_directions;
  }
  if (n_directions > 0)
    result = {sum / n_directions, largest};
  return result;
}

std::vector<BrokenBond> part(const std::vector<BrokenBond> &bonds, double time, bool later)
{
  std::vector<BrokenBond> chosen;
  std::copy_if(bonds.begin(), bonds.end(), std::back_inserter(chosen),
               [&](const BrokenBond &b) { return (b.time > time) == later; });
  return chosen;
}

/// When the faces broke, on average: the crack's timetable in one figure.
double mean_time(const std::vector<BrokenBond> &bonds)
{
  double sum = 0;
  for (const BrokenBond &b : bonds)
    sum += b.time;
  return sum / double(bonds.size());
}

/// Fields are compared up to this share of the time of the onset: nearer to it the crack of one run
/// is on its way already, and a difference of a per mille in strength moves everything.
constexpr double share_of_onset = 0.99;

/// The latest states of the two runs at the same common time up to `limit`.
std::optional<std::pair<Snapshot, Snapshot>>
snapshots_of_one_time(const RunFolder &run, const RunFolder &reference, double limit)
{
  for (const std::string &a : run.snapshots())
    for (const std::string &b : reference.snapshots())
      if (std::filesystem::exists(a) && std::filesystem::exists(b)) {
        std::pair pair(read_snapshot(a), read_snapshot(b));
        const double ta = pair.first.time, tb = pair.second.time;
        if (std::abs(ta - tb) < 1e-9 * tb && std::max(ta, tb) <= limit)
          return pair;
      }
  return {};
}

class Comparison
{
public:
  Comparison(ComparedSide run, ComparedSide reference)
      : run_(std::move(run)), reference_(std::move(reference))
  {
  }

  CompareResult result()
  {
    status();
    bodies();
    find_limit();
    curves();
    if (is_of_one_dimension())
      crack();
    histories();
    if (is_of_one_dimension())
      fields();
    if (reference_.record) {
      cost();
    } else
      note_what_a_curve_lacks();
    draw();
    return std::move(r_);
  }

private:
  void note_what_a_curve_lacks()
  {
    r_.notes.push_back("the reference is a curve: no crack path, fields or times to compare");
    if (const auto unknown = unknown_columns(reference_); !unknown.empty())
      r_.notes.push_back("columns of the reference that compare does not know: " +
                         core::listed(unknown, "and"));
  }

  void bodies()
  {
    if (reference_.record)
      for (const std::string &note :
           body_differences(*run_.record, run_.name, *reference_.record, reference_.name))
        r_.notes.push_back(note);
  }

  /// Places in the body mean the same in both.
  bool is_of_one_dimension() const
  {
    return reference_.record && run_.record->dimension == reference_.record->dimension;
  }

  void line(const std::string &name, const std::string &run, const std::string &reference,
            const std::string &difference)
  {
    r_.lines.push_back({name, run, reference, difference});
  }
  static std::string text(const std::optional<double> &value, const char *unit)
  {
    return value ? quantity(*value, unit) : "-";
  }
  static std::string both(const std::optional<double> &l2, const std::optional<double> &max)
  {
    return l2 ? fmt::format("{:.2f} % / {:.2f} %", 100 * *l2, 100 * max.value_or(0)) : "-";
  }
  static std::string diameters(const std::optional<double> &value)
  {
    return value ? fmt::format("{:.2f} d", *value) : "-";
  }

  void curves()
  {
    // The user's curve decides what can be compared; two runs have everything.
    const bool load = run_.values("load", "N") && reference_.values("load", "N");
    const Measure &by_largest = load ? by_load : by_stress;
    const bool peaks = peak(run_, by_largest) && peak(reference_, by_largest);
    const auto a = largest(run_, by_largest), b = largest(reference_, by_largest);
    const auto error = relative_error(a, b);
    (peaks ? r_.peak_load_error : r_.largest_load_error) = error;
    line(fmt::format("{} {}", peaks ? "peak" : "largest", load ? "load" : "stress"),
         text(a, by_largest.y_unit), text(b, by_largest.y_unit), percent(error));
    if (error && *error < -1 && !reference_.record)
      r_.notes.push_back(
          "the largest loads have opposite signs: in a run tension is positive; write "
          "loads and displacements of a curve that counts compression as positive "
          "with the other sign");
    if (!error)
      r_.notes.push_back("peak: both curves need a column load (N) or stress (Pa) that is not 0");
    else if (!peaks)
      note_missing_peaks();

    const bool stress = has(run_, by_stress) && has(reference_, by_stress);
    measure_ = stress ? by_stress : by_load;
    const auto ka = stiffness(run_, measure_), kb = stiffness(reference_, measure_);
    r_.stiffness_error = relative_error(ka, kb);
    const char *unit = stress ? "Pa" : "N/m";
    line("stiffness", text(ka, unit), text(kb, unit), percent(r_.stiffness_error));
    if (!r_.stiffness_error)
      r_.notes.push_back("stiffness: strain and stress or displacement and load are needed in both "
                         "curves, with three points on a line (to 2 %) between 10 % and 50 % of "
                         "the largest load");
    work(peaks);
  }

  void note_missing_peaks()
  {
    bool is_open = false;
    for (const ComparedSide *side : {&run_, &reference_})
      if (side->record && !has_figures(*side->record)) {
        is_open = true;
        r_.notes.push_back(fmt::format("peak: unknown of {}, whose figures come with its end; the "
                                       "largest load is that up to its last row",
                                       side->name));
      }
    if (!is_open)
      r_.notes.push_back("peak: there is none where nothing broke");
  }

  void work(bool peaks)
  {
    std::optional<double> a, b;
    if (peaks) {
      a = work_at_largest(run_);
      b = work_at_largest(reference_);
    } else if (const auto run = run_.series({"external_work"}, "J"),
               reference = reference_.series({"external_work"}, "J");
               run && reference)
    {
      a = value_at(*run, last_common(*run, *reference));
      b = value_at(*reference, last_common(*run, *reference));
    }
    r_.energy_error = relative_error(a, b);
    line(peaks ? "external work at the peak" : "external work at the last common time",
         text(a, "J"), text(b, "J"), percent(r_.energy_error));
  }

  double last_common(const TimeSeries &a, const TimeSeries &b) const
  {
    return a.time.empty() || b.time.empty()
               ? 0
               : std::min({a.time.back(), b.time.back(), still_until_});
  }

  void status()
  {
    const auto of = [this](const ComparedSide &side) -> std::string {
      if (!side.record)
        return "";
      if (side.record->is_complete())
        return "complete";
      r_.complete = false;
      r_.notes.push_back(side.name + " " + incompleteness_with_reason(*side.record));
      return incompleteness(*side.record);
    };
    const std::string run = of(run_), reference = of(reference_);
    if (!r_.complete)
      line("run", run, reference, "");
  }

  /// Up to when states and histories are compared.
  void find_limit()
  {
    for (const ComparedSide *side : {&run_, &reference_}) {
      if (const auto onset = onset_time(*side))
        still_until_ = std::min(still_until_, share_of_onset * *onset);
      if (side->record && side->record->trusted_until) {
        trusted_until_ = std::min(trusted_until_, *side->record->trusted_until);
        r_.notes.push_back(fmt::format("{} left the range of its models at {}: what comes later "
                                       "does not count",
                                       side->name, quantity(*side->record->trusted_until, "s")));
      }
    }
    still_until_ = std::min(still_until_, trusted_until_);
  }

  void histories()
  {
    const auto error = [this](const std::vector<const char *> &columns, const char *unit) {
      const auto run = run_.series(columns, unit), reference = reference_.series(columns, unit);
      if (!run || !reference)
        return HistoryError();
      const double until = last_common(*run, *reference);
      r_.compared_until = std::max(until, r_.compared_until.value_or(until));
      return history_error(*run, *reference, until);
    };
    r_.load_history = error({"load"}, "N");
    r_.displacement_history = error({"displacement"}, "m");
    r_.elastic_history = error({"potential_discrete", "potential_far", "blended"}, "J");
    r_.kinetic_history = error({"kinetic_discrete", "kinetic_far"}, "J");
    if (reference_.record)
      for (const GaugeEntry &gauge : run_.record->gauges)
        for (const std::string &name : gauge.columns)
          if (const auto unit = common_unit(name))
            r_.gauges[name] = error({name.c_str()}, unit->c_str());
    if (!r_.compared_until)
      return;
    const auto add = [this](const std::string &name, const HistoryError &e) {
      if (e.mean)
        line(name, "", "", both(e.mean, e.largest));
    };
    line("histories up to", "", "", quantity(*r_.compared_until, "s"));
    add("  load, L2 / largest", r_.load_history);
    add("  elongation, L2 / largest", r_.displacement_history);
    add("  elastic energy, L2 / largest", r_.elastic_history);
    add("  kinetic energy, L2 / largest", r_.kinetic_history);
    for (const auto &[name, e] : r_.gauges)
      add("  gauge " + name + ", L2 / largest", e);
  }

  /// Of a column that both histories have; gauges of one name may measure different things.
  std::optional<std::string> common_unit(const std::string &name)
  {
    const auto a = unit_of(run_, name), b = unit_of(reference_, name);
    if (a && b && *a != *b) {
      r_.notes.push_back(fmt::format("gauge {}: in {} in {}, in {} in {}", name, *a, run_.name, *b,
                                     reference_.name));
      return {};
    }
    return a ? b : a;
  }

  void crack()
  {
    std::vector<BrokenBond> a, b;
    std::string n_a = "-", n_b = "-"; // unknown until a run has ended
    for (const auto &[side, bonds, n] :
         {std::tuple(&run_, &a, &n_a), std::tuple(&reference_, &b, &n_b)})
    {
      if (!std::filesystem::exists(side->folder->broken_bonds())) {
        r_.notes.push_back(fmt::format("crack path: {} has no broken_bonds.csv", side->name));
        continue;
      }
      *bonds = part(read_broken_bonds(side->folder->broken_bonds()), trusted_until_, false);
      *n = grouped(std::int64_t(bonds->size()));
    }
    line("broken faces", n_a, n_b, "");
    if (n_a == "-" || n_b == "-")
      return;
    if (a.empty() || b.empty()) {
      r_.notes.push_back("crack path: not in both runs a face broke");
      return;
    }
    const double ta_mean = mean_time(a), tb_mean = mean_time(b);
    r_.breaking_time_error = relative_error(ta_mean, tb_mean);
    line("mean time of breaking", text(ta_mean, "s"), text(tb_mean, "s"),
         percent(r_.breaking_time_error));
    const double d = run_.record->spacing;
    const auto all = crack_distance(a, a, b, b, d);
    r_.crack_distance_mean = all.mean;
    r_.crack_distance_max = all.max;
    line("crack path, mean distance", "", "", diameters(all.mean));
    line("crack path, largest distance", "", "", diameters(all.max));
    const auto ta = onset_time(run_), tb = onset_time(reference_);
    if (!ta || !tb) {
      r_.notes.push_back("crack path before and after its onset: both histories need time, load "
                         "and the potential energies");
      return;
    }
    const auto before = crack_distance(part(a, *ta, false), a, part(b, *tb, false), b, d);
    r_.crack_distance_mean_to_onset = before.mean;
    r_.crack_distance_max_to_onset = before.max;
    line("  up to its onset, mean / largest", "", "",
         diameters(before.mean) + " / " + diameters(before.max));
    const auto after = crack_distance(part(a, *ta, true), a, part(b, *tb, true), b, d);
    r_.crack_distance_mean_after_onset = after.mean;
    r_.crack_distance_max_after_onset = after.max;
    line("  after it, mean / largest", "", "",
         diameters(after.mean) + " / " + diameters(after.max));
  }

  void fields()
  {
    const auto pair = snapshots_of_one_time(*run_.folder, *reference_.folder, still_until_);
    if (!pair) {
      r_.notes.push_back(
          "fields: the runs kept no state of the same time before fracture took over");
      return;
    }
    const FieldError error = field_error(pair->first, pair->second);
    r_.matched_particles = error.matched;
    r_.displacement_error = error.displacement;
    r_.displacement_error_max = error.displacement_max;
    r_.velocity_error = error.velocity;
    r_.velocity_error_max = error.velocity_max;
    if (error.matched == 0)
      r_.notes.push_back("fields: no particle stands at the same place in both runs");
    const std::string matched = grouped(error.matched) + " particles";
    line("time of the fields below", quantity(pair->first.time, "s"),
         quantity(pair->second.time, "s"), "");
    line("displacement, L2 / largest", matched, "",
         both(error.displacement, error.displacement_max));
    velocities(pair->second.time, matched);
  }

  void velocities(double time, const std::string &matched)
  {
    const auto share = [time](const ComparedSide &side) -> std::optional<double> {
      const auto kinetic = side.series({"kinetic_discrete", "kinetic_far"}, "J"),
                 elastic = side.series({"potential_discrete", "potential_far", "blended"}, "J");
      return kinetic && elastic ? ratio(value_at(*kinetic, time), value_at(*elastic, time))
                                : std::nullopt;
    };
    const auto text = [](const std::optional<double> &s) {
      return s ? fmt::format("{:.2g} %", 100 * *s) : "-";
    };
    r_.kinetic_share = share(reference_);
    line("velocities: kinetic energy over elastic", text(share(run_)), text(r_.kinetic_share), "");
    line("  velocity, L2 / largest", matched, "", both(r_.velocity_error, r_.velocity_error_max));
  }

  void cost()
  {
    const RunRecord &a = *run_.record, &b = *reference_.record;
    r_.time_ratio = ratio(b.wall_seconds, a.wall_seconds);
    r_.particle_ratio = ratio(double(b.particles), double(a.particles));
    const auto factor = [](const std::optional<double> &f) {
      return f ? fmt::format("{:.2f} x", *f) : "-";
    };
    const auto particles = [](const RunRecord &r) {
      return r.kind.empty() ? "-" : grouped(r.particles); // before the body is built
    };
    line("particles", particles(a), particles(b), factor(r_.particle_ratio));
    if (!a.phases.empty() || !b.phases.empty()) {
      const auto skipped = [](const RunRecord &r) { return grouped(totals(r).skipped); };
      line("steps", grouped(steps_done(a)), grouped(steps_done(b)),
           factor(ratio(double(steps_done(b)), double(steps_done(a)))));
      line("  skipped by static phases", skipped(a), skipped(b), "");
    }
    const auto wall_time = [](const RunRecord &r) {
      return has_figures(r) ? duration(r.wall_seconds) : "-";
    };
    line("wall time", wall_time(a), wall_time(b), factor(r_.time_ratio));
  }

  /// Curves without a common way of the load may still have a common time.
  Measure drawn_measure() const
  {
    for (const Measure &m : {measure_, load_by_time, stress_by_time})
      if (has(run_, m) && has(reference_, m))
        return m;
    return measure_;
  }

  void draw()
  {
    Plot plot;
    plot.title = run_.name + " against " + reference_.name;
    const Measure drawn = drawn_measure();
    plot.x = {drawn.x, drawn.x_unit, false};
    plot.y = {drawn.y, drawn.y_unit, false};
    for (const ComparedSide *side : {&run_, &reference_})
      if (has(*side, drawn))
        plot.series.push_back({side->name, *side->values(drawn.x, drawn.x_unit),
                               *side->values(drawn.y, drawn.y_unit), side == &reference_, false,
                               true});
    if (plot.series.size() < 2)
      r_.notes.push_back("plot: the curves have no pair of columns in common");
    r_.file_name = "compare_" + reference_.name;
    r_.plot = draw_plot(plot);
    std::vector<std::vector<std::string>> rows;
    for (const auto &l : r_.lines)
      rows.push_back({l.name, l.run, l.reference, l.difference});
    r_.sides =
        fmt::format("<p>{} against {}</p>\n", escape_xml(run_.path), escape_xml(reference_.path));
    std::string body =
        r_.sides + html_table({"", run_.name, reference_.name, "difference"}, rows) + r_.plot;
    for (const auto &note : r_.notes)
      body += "<p>" + escape_xml(note) + "</p>\n";
    r_.page = html_page(plot.title, body);
  }

  ComparedSide run_, reference_;
  Measure measure_ = by_load;
  // s: what is later is not trusted; a crack is on its way.
  double trusted_until_ = std::numeric_limits<double>::infinity(), still_until_ = trusted_until_;
  CompareResult r_;
};
} // namespace

CompareResult compare(const std::string &run_folder, const std::string &reference)
{
  return Comparison(read_run(run_folder), read_reference(reference)).result();
}

namespace
{
/// Where plot and page go: others of the same two sides make way, those of other sides stay.
std::string free_stem(const CompareResult &result, const std::string &folder)
{
  const std::string first = folder + "/" + result.file_name;
  std::string stem = first;
  for (int n = 2; std::filesystem::exists(stem + ".html") &&
                  core::read_file(stem + ".html").find(result.sides) == std::string::npos;
       ++n)
    stem = fmt::format("{}_{}", first, n);
  return stem;
}
} // namespace

void write_comparison(CompareResult &result, const std::string &folder)
{
  make_folder(folder);
  const std::string stem = free_stem(result, folder);
  core::write_file(stem + ".svg", result.plot);
  result.svg_file = stem + ".svg";
  core::write_file(stem + ".html", result.page);
  result.html_file = stem + ".html";
}
} // namespace ligament::program
