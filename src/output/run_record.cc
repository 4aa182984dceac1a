#include "src/output/run_record.h"

#include "core/check.h"
#include "core/disk_reserve.h"
#include "core/files.h"

#include <nlohmann/json.hpp>

#include <limits>
#include <type_traits>

namespace ligament::program
{
namespace
{
using Json = nlohmann::ordered_json; // keeps the file readable

// The fields of the small records, once for both directions.
template <typename Visit>
void for_each_field(core::Timers::Row &r, Visit &&visit)
{
  visit("name", r.name);
  visit("seconds", r.seconds);
  visit("calls", r.calls);
}

template <typename Visit>
void for_each_field(Figure &r, Visit &&visit)
{
  visit("value", r.value);
  visit("unit", r.unit);
}

template <typename Visit>
void for_each_field(SkippedPart &r, Visit &&visit)
{
  visit("what", r.what);
  visit("why", r.why);
}

template <typename Visit>
void for_each_field(PictureEntry &r, Visit &&visit)
{
  visit("file", r.file);
  visit("caption", r.caption);
}

template <typename Visit>
void for_each_field(RunWarning &r, Visit &&visit)
{
  visit("text", r.text);
  visit("energy", r.energy);
}

template <typename Visit>
void for_each_field(PhaseEntry &r, Visit &&visit)
{
  visit("kind", r.kind);
  visit("begin", r.begin);
  visit("end", r.end);
  visit("steps", r.steps);
  visit("steps_skipped", r.steps_skipped);
  visit("solves", r.solves);
  visit("iterations", r.iterations);
  visit("load", r.load);
  visit("broken", r.broken);
  visit("reason", r.reason);
  visit("seconds", r.seconds);
}

template <typename Visit>
void for_each_field(GaugeEntry &r, Visit &&visit)
{
  visit("name", r.name);
  visit("kind", r.kind);
  visit("columns", r.columns);
  visit("text", r.text);
}

template <typename Visit>
void for_each_field(ToolOutline &r, Visit &&visit)
{
  visit("points", r.points);
  visit("displacement", r.displacement);
  visit.if_any("turn", r.turn);
}

template <typename Visit>
void for_each_field(StateEntry &r, Visit &&visit)
{
  visit("name", r.name);
  visit("caption", r.caption);
  visit("time", r.time);
  visit("particles", r.particles);
  visit("cells", r.cells);
  visit.if_any("tools", r.tools);
}

template <typename Visit>
void for_each_field(RunRecord &r, Visit &&visit)
{
  visit("title", r.title);
  visit("version", r.version);
  visit("commit", r.commit);
  visit("started", r.started);
  visit("status", r.status);
  visit("reason", r.reason);
  visit("verdict", r.verdict);
  visit("kind", r.kind);
  visit("dimension", r.dimension);
  visit("plane", r.plane);
  visit("spacing", r.spacing);
  visit("size", r.size);
  visit("thickness", r.thickness);
  visit("particles", r.particles);
  visit("cells", r.cells);
  visit("overlap_particles", r.overlap_particles);
  visit("equivalent_particles", r.equivalent_particles);
  visit("dt", r.dt);
  visit("dt_critical", r.dt_critical);
  visit("dt_far", r.dt_far);
  visit("step_ratio", r.step_ratio);
  visit("regime", r.regime);
  visit("steps", r.steps);
  visit("simulated_time", r.simulated_time);
  visit("wall_seconds", r.wall_seconds);
  visit("setup_seconds", r.setup_seconds);
  visit("discrete_seconds", r.discrete_seconds);
  visit("largest_load", r.largest_load);
  visit("largest_stress", r.largest_stress);
  visit("largest_time", r.largest_time);
  visit("peak_load", r.peak_load);
  visit("peak_stress", r.peak_stress);
  visit("peak_time", r.peak_time);
  visit("stiffness", r.stiffness);
  visit("broken_time", r.broken_time);
  visit("trusted_until", r.trusted_until);
  visit("broken_bonds", r.broken_bonds);
  visit("broken_in_overlap", r.broken_in_overlap);
  visit("crack_length", r.crack_length);
  visit("external_work", r.external_work);
  visit("energy_residual", r.energy_residual);
  visit("figures", r.figures);
  visit("timing", r.timing);
  visit("skipped", r.skipped);
  visit("magnification", r.magnification);
  visit("states", r.states);
  visit("pictures", r.pictures);
  visit("warnings", r.warnings);
}

template <typename T>
inline constexpr bool is_value = std::is_arithmetic_v<T> || std::is_same_v<T, std::string> ||
                                 std::is_same_v<T, std::array<double, 3>>;

struct Writer
{
  Json &json;

  template <typename T>
  static Json converted(T &value)
  {
    if constexpr (is_value<T>)
      return value;
    else {
      Json object = Json::object();
      for_each_field(value, Writer{object});
      return object;
    }
  }

  template <typename T>
  void operator()(const char *name, T &value) const
  {
    json[name] = converted(value);
  }
  template <typename T>
  void operator()(const char *name, std::optional<T> &value) const
  {
    json[name] = value ? Json(*value) : Json();
  }
  template <typename T>
  void operator()(const char *name, std::vector<T> &values) const
  {
    Json &list = json[name] = Json::array();
    for (auto &value : values)
      list.push_back(converted(value));
  }
  template <typename T>
  void operator()(const char *name, std::map<std::string, T> &values) const
  {
    Json &object = json[name] = Json::object();
    for (auto &[key, value] : values)
      object[key] = converted(value);
  }
  /// Records of before have no such list.
  template <typename T>
  void if_any(const char *name, std::vector<T> &values) const
  {
    if (!values.empty())
      (*this)(name, values);
  }
};

struct Reader
{
  const Json &json;

  /// JSON has no word for a number that is none: null.
  static double number(const Json &entry)
  {
    return entry.is_null() ? std::numeric_limits<double>::quiet_NaN() : entry.get<double>();
  }

  template <typename T>
  static T converted(const Json &entry)
  {
    if constexpr (std::is_same_v<T, double>)
      return number(entry);
    else if constexpr (std::is_same_v<T, std::array<double, 3>>)
      return {number(entry.at(0)), number(entry.at(1)), number(entry.at(2))};
    else if constexpr (is_value<T>)
      return entry.get<T>();
    else {
      T value;
      for_each_field(value, Reader{entry});
      return value;
    }
  }

  template <typename T>
  void operator()(const char *name, T &value) const
  {
    value = converted<T>(json.at(name));
  }
  template <typename T>
  void operator()(const char *name, std::optional<T> &value) const
  {
    const Json &entry = json.at(name);
    value = entry.is_null() ? std::nullopt : std::optional(converted<T>(entry));
  }
  template <typename T>
  void operator()(const char *name, std::vector<T> &values) const
  {
    values.clear();
    for (const Json &entry : json.at(name))
      values.push_back(converted<T>(entry));
  }
  template <typename T>
  void operator()(const char *name, std::map<std::string, T> &values) const
  {
    values.clear();
    for (const auto &[key, entry] : json.at(name).items())
      values[key] = converted<T>(entry);
  }
  template <typename T>
  void if_any(const char *name, std::vector<T> &values) const
  {
    if (json.contains(name))
      (*this)(name, values);
  }
};
} // namespace

void write_run_record(const std::string &path, const RunRecord &record)
{
  Json json;
  RunRecord copy = record;
  for_each_field(copy, Writer{json});
  Writer{json}("ranks", copy.ranks);
  Writer{json}.if_any("phases", copy.phases);
  Writer{json}.if_any("gauges", copy.gauges);
  json["complete"] = record.is_complete();
  const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  try {
    core::write_file(path, text);
  } catch (const core::EnvironmentError &) {
    if (!core::release_reserve(path))
      throw;
    core::write_file(path, text);
  }
}

std::string incompleteness(const RunRecord &record)
{
  if (record.status == "stopped")
    return "was stopped by its guard";
  if (record.status == "interrupted")
    return "was interrupted";
  return record.status == "running" ? "is not finished" : record.status;
}

RunRecord read_run_record(const std::string &path)
{
  RunRecord record;
  try {
    const Json json = Json::parse(core::read_file(path));
    for_each_field(record, Reader{json});
    if (json.contains("ranks")) // records of before have none
      Reader{json}("ranks", record.ranks);
    Reader{json}.if_any("phases", record.phases);
    Reader{json}.if_any("gauges", record.gauges);
  } catch (const core::EnvironmentError &error) {
    throw core::InputError(std::string(error.what()) + " (not the output folder of a run?)");
  } catch (const Json::exception &error) {
    throw core::InputError(path + ": not the record of a run: " + error.what());
  }
  return record;
}
} // namespace ligament::program
