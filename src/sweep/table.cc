// sweep.csv: one line per case.
#include "core/check.h"
#include "core/files.h"
#include "src/scene/read_scene.h"
#include "src/sweep/case_result.h"

#include <fmt/format.h>

namespace ligament::program
{
namespace
{
using Number = std::optional<double>;

struct Column
{
  const char *name, *unit;
  Number (*value)(const CaseResult &);
};

template <auto Member>
Number of_record(const CaseResult &r)
{
  return r.record ? Number((*r.record).*Member) : Number();
}

template <auto Member>
Number of_cost(const CaseResult &r)
{
  return r.cost ? Number((*r.cost).*Member) : Number();
}

template <auto Member>
Number of_coupling(const CaseResult &r)
{
  return r.coupling ? (*r.coupling).*Member : Number();
}

template <auto Member>
Number of_total(const CaseResult &r)
{
  return r.total ? (*r.total).*Member : Number();
}

using R = RunRecord;
using C = CompareResult;
const Column columns[] = {{"run_time", "s", [](const CaseResult &r) { return r.run_time(); }},
                          {"wall_time_loop", "s", of_record<&R::wall_seconds>},
                          {"setup_time", "s", of_record<&R::setup_seconds>},
                          {"core_time", "s", of_cost<&RunCost::core_seconds>},
                          {"jobs", "1", of_cost<&RunCost::jobs>},
                          {"peak_memory", "B", of_cost<&RunCost::peak_memory>},
                          {"particles", "1", of_record<&R::particles>},
                          {"overlap_particles", "1", of_record<&R::overlap_particles>},
                          {"cells", "1", of_record<&R::cells>},
                          {"steps", "1", of_record<&R::steps>},
                          {"dt", "s", of_record<&R::dt>},
                          {"simulated_time", "s", of_record<&R::simulated_time>},
                          {"peak_load", "N", of_record<&R::peak_load>},
                          {"peak_stress", "Pa", of_record<&R::peak_stress>},
                          {"stiffness", "Pa", of_record<&R::stiffness>},
                          {"broken_bonds", "1", of_record<&R::broken_bonds>},
                          {"energy_residual", "1", of_record<&R::energy_residual>},
                          {"peak_load_error", "1", of_coupling<&C::peak_load_error>},
                          {"stiffness_error", "1", of_coupling<&C::stiffness_error>},
                          {"energy_error", "1", of_coupling<&C::energy_error>},
                          {"crack_distance_mean", "d", of_coupling<&C::crack_distance_mean>},
                          {"crack_distance_max", "d", of_coupling<&C::crack_distance_max>},
                          {"displacement_error", "1", of_coupling<&C::displacement_error>},
                          {"breaking_time_error", "1", of_coupling<&C::breaking_time_error>},
                          {"time_ratio", "1", of_coupling<&C::time_ratio>},
                          {"particle_ratio", "1", of_coupling<&C::particle_ratio>},
                          {"total_peak_load_error", "1", of_total<&C::peak_load_error>},
                          {"total_stiffness_error", "1", of_total<&C::stiffness_error>},
                          {"total_energy_error", "1", of_total<&C::energy_error>},
                          {"total_crack_distance_mean", "d", of_total<&C::crack_distance_mean>},
                          {"total_displacement_error", "1", of_total<&C::displacement_error>},
                          {"total_breaking_time_error", "1", of_total<&C::breaking_time_error>}};

/// Quoted where the text has commas, quotes or line ends.
std::string field(const std::string &text)
{
  if (text.find_first_of(",\"\n") == std::string::npos)
    return text;
  std::string quoted = "\"";
  for (const char c : text)
    quoted += c == '"' ? "\"\"" : c == '\n' ? " " : std::string(1, c);
  return quoted + "\"";
}

/// Value of a scene key, in SI; empty where this scene has no such key.
std::string value(const Case &c, const std::string &key)
{
  const nlohmann::ordered_json::json_pointer pointer(key);
  if (c.scene.is_null() || !c.scene.contains(pointer))
    return "";
  const auto &v = c.scene.at(pointer);
  return v.is_string() ? v.get<std::string>() : v.is_null() ? "" : v.dump();
}

std::string unit(const std::string &key)
{
  if (key.size() > 1 && key.compare(key.size() - 2, 2, "/-") == 0)
    return "1"; // an element more: no key that could be explained
  const auto found = explain_json(key);
  const std::string name = found.at(0).at("unit");
  return found.size() == 1 && !name.empty() ? name : "1";
}
} // namespace

void write_table(const std::string &path, const CaseList &list,
                 const std::vector<CaseResult> &results)
{
  std::string names = "name,group,status", units = "text,text,text";
  for (const std::string &key : list.keys) {
    names += "," + field(key);
    units += "," + unit(key);
  }
  for (const Column &column : columns) {
    names += std::string(",") + column.name;
    units += std::string(",") + column.unit;
  }
  std::string text = names + ",reason,run\n" + units + ",text,text\n";
  for (const CaseResult &r : results) {
    text += field(r.scene->name) + "," + field(r.scene->group) + "," + to_string(r.end.status);
    for (const std::string &key : list.keys)
      text += "," + field(value(*r.scene, key));
    for (const Column &column : columns) {
      const Number number = column.value(r);
      text += number ? fmt::format(",{:.10g}", *number) : ",";
    }
    text += "," + field(r.end.reason) + "," + (r.end.run ? field(r.end.run->path) : "") + "\n";
  }
  core::write_file(path, text);
}
} // namespace ligament::program
