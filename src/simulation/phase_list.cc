#include "src/simulation/phase_list.h"

#include "src/simulation/kept_tables.h"

namespace ligament::program
{
std::string text_of(PhaseEnd end)
{
  switch (end) {
  case PhaseEnd::bond_breaks:
    return "a bond bears its strength";
  case PhaseEnd::above_strength:
    return "a bond bears more than its strength in equilibrium";
  case PhaseEnd::end_of_run:
    return "end of the run";
  case PhaseEnd::out_of_balance:
    return "no equilibrium was found";
  case PhaseEnd::no_resistance:
    return "the body no longer carries";
  case PhaseEnd::stopped:
    return "the run was stopped";
  case PhaseEnd::calm:
    return "the body is calm";
  case PhaseEnd::restless:
    return "nothing broke for 50 transits";
  case PhaseEnd::face_torn:
    return "a face has softened to the end";
  }
  return {};
}

PhaseEntry entry_of(const Phase &p, double dt)
{
  PhaseEntry e;
  e.kind = p.is_static ? "static" : "dynamic";
  e.begin = double(p.begin) * dt;
  e.end = double(p.end) * dt;
  (p.is_static ? e.steps_skipped : e.steps) = p.end - p.begin;
  e.solves = p.solves;
  e.iterations = p.iterations;
  e.load = p.load;
  e.broken = p.broken;
  e.reason = text_of(p.reason);
  e.seconds = p.seconds;
  return e;
}

core::Table table_of(const std::vector<Phase> &phases)
{
  core::Table rows = numbered_rows(phases.size());
  const auto add = [&](const char *name, auto &&value) {
    std::vector<std::decay_t<decltype(value(phases[0]))>> column;
    for (const Phase &p : phases)
      column.push_back(value(p));
    rows.add(name, column);
  };
  const auto whole = [](auto value) { return std::int64_t(value); };
  add("is_static", [&](const Phase &p) { return whole(p.is_static); });
  add("begin", [&](const Phase &p) { return whole(p.begin); });
  add("end", [&](const Phase &p) { return whole(p.end); });
  add("solves", [&](const Phase &p) { return whole(p.solves); });
  add("iterations", [&](const Phase &p) { return whole(p.iterations); });
  add("broken", [&](const Phase &p) { return whole(p.broken); });
  add("reason", [&](const Phase &p) { return whole(p.reason); });
  add("load", [](const Phase &p) { return p.load; });
  add("seconds", [](const Phase &p) { return p.seconds; });
  return rows;
}

std::vector<Phase> phases_of(const core::Table &table)
{
  const auto numbers = [&](const char *name) { return table.integers(name); };
  const auto is_static = numbers("is_static"), begin = numbers("begin"), end = numbers("end"),
             solves = numbers("solves"), iterations = numbers("iterations"),
             broken = numbers("broken"), reason = numbers("reason");
  const auto load = table.reals("load"), seconds = table.reals("seconds");
  std::vector<Phase> phases;
  for (std::size_t k = 0; k < table.n_rows(); ++k)
    phases.push_back({is_static[k] != 0, long(begin[k]), long(end[k]), int(solves[k]),
                      int(iterations[k]), load[k], long(broken[k]), PhaseEnd(reason[k]),
                      seconds[k]});
  return phases;
}
} // namespace ligament::program
