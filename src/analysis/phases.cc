#include "src/analysis/phases.h"

#include "src/drawing/html.h"
#include "src/output/format.h"

#include <fmt/core.h>

namespace ligament::program
{
namespace
{
// A longer table would push the rest of the page out of sight: it opens on demand.
constexpr std::size_t most_open_rows = 30;

std::string counted(std::int64_t n, const std::string &one, const std::string &many)
{
  return grouped(n) + " " + (n == 1 ? one : many);
}

std::vector<std::string> row_of(std::size_t number, const PhaseEntry &p)
{
  const auto count = [](std::int64_t n) { return n > 0 ? grouped(n) : "-"; };
  return {std::to_string(number), p.kind,
          quantity(p.begin, "s"), quantity(p.end - p.begin, "s"),
          quantity(p.load, "N"),  grouped(p.broken),
          count(p.steps),         count(p.steps_skipped),
          count(p.solves),        count(p.iterations),
          duration(p.seconds),    p.reason};
}
} // namespace

PhaseTotals totals(const RunRecord &record)
{
  PhaseTotals t;
  for (const PhaseEntry &p : record.phases) {
    const bool is_static = p.kind == "static";
    ++(is_static ? t.n_static : t.n_dynamic);
    (is_static ? t.static_s : t.dynamic_s) += p.seconds;
    t.broken += p.broken;
    t.steps += p.steps;
    t.skipped += p.steps_skipped;
    t.solves += p.solves;
    t.iterations += p.iterations;
  }
  return t;
}

long steps_done(const RunRecord &record)
{
  return record.phases.empty() ? record.steps : totals(record).steps;
}

std::string phases_sentence(const RunRecord &record)
{
  if (record.phases.empty())
    return "";
  const PhaseTotals t = totals(record);
  return fmt::format("{} and {} stood for {} steps",
                     counted(t.n_static, "static phase", "static phases"),
                     counted(t.steps, "step", "steps"), grouped(t.steps + t.skipped));
}

std::string phases_section(const RunRecord &record)
{
  if (record.phases.empty())
    return "";
  const PhaseTotals t = totals(record);
  std::vector<std::vector<std::string>> rows;
  for (const PhaseEntry &p : record.phases)
    rows.push_back(row_of(rows.size() + 1, p));
  const std::string table =
      html_table({"phase", "kind", "begins at", "lasts", "load at its end", "faces broken", "steps",
                  "steps skipped", "solves", "iterations", "wall time", "why it ended"},
                 rows);
  std::string text = fmt::format(
      "<h2>Phases</h2>\n<p>{} with {} in {}: {} were skipped. {} with {} in {}. {} in all "
      "phases.</p>\n",
      counted(t.n_static, "static phase", "static phases"),
      counted(t.solves, "linear solve", "linear solves"), duration(t.static_s),
      counted(t.skipped, "step", "steps"), counted(t.n_dynamic, "dynamic phase", "dynamic phases"),
      counted(t.steps, "step", "steps"), duration(t.dynamic_s),
      counted(t.broken, "face broke", "faces broke"));
  if (rows.size() <= most_open_rows)
    return text + table;
  return text + fmt::format("<details><summary>All {}</summary>\n", rows.size()) + table +
         "</details>\n";
}
} // namespace ligament::program
