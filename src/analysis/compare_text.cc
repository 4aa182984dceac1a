// What compare prints: the table and the JSON object.
#include "src/analysis/compare.h"

#include <fmt/core.h>

#include <algorithm>

namespace ligament::program
{
std::string table(const CompareResult &result)
{
  CompareResult::Line head{"", "run", "reference", "difference"};
  std::size_t width[3] = {0, head.run.size(), head.reference.size()};
  for (const auto &l : result.lines) {
    width[0] = std::max(width[0], l.name.size());
    width[1] = std::max(width[1], l.run.size());
    width[2] = std::max(width[2], l.reference.size());
  }
  std::string text;
  const auto add = [&](const CompareResult::Line &l) {
    text += fmt::format("{:<{}}  {:>{}}  {:>{}}  {}\n", l.name, width[0], l.run, width[1],
                        l.reference, width[2], l.difference);
  };
  add(head);
  for (const auto &l : result.lines)
    add(l);
  for (const auto &note : result.notes)
    text += "note: " + note + "\n";
  return text;
}

nlohmann::json to_json(const CompareResult &r)
{
  nlohmann::json json;
  const auto put = [&](const char *name, const std::optional<double> &value) {
    json[name] = value ? nlohmann::json(*value) : nlohmann::json();
  };
  json["complete"] = r.complete;
  put("peak_load_error", r.peak_load_error);
  put("largest_load_error", r.largest_load_error);
  put("stiffness_error", r.stiffness_error);
  put("crack_distance_mean", r.crack_distance_mean);
  put("crack_distance_max", r.crack_distance_max);
  put("crack_distance_mean_to_onset", r.crack_distance_mean_to_onset);
  put("crack_distance_max_to_onset", r.crack_distance_max_to_onset);
  put("crack_distance_mean_after_onset", r.crack_distance_mean_after_onset);
  put("crack_distance_max_after_onset", r.crack_distance_max_after_onset);
  put("energy_error", r.energy_error);
  put("breaking_time_error", r.breaking_time_error);
  put("time_ratio", r.time_ratio);
  put("particle_ratio", r.particle_ratio);
  put("displacement_error", r.displacement_error);
  put("displacement_error_max", r.displacement_error_max);
  put("velocity_error", r.velocity_error);
  put("velocity_error_max", r.velocity_error_max);
  put("kinetic_share", r.kinetic_share);
  const auto put_history = [&](const std::string &name, const HistoryError &error) {
    put((name + "_history_error").c_str(), error.mean);
    put((name + "_history_error_max").c_str(), error.largest);
  };
  put_history("load", r.load_history);
  put_history("displacement", r.displacement_history);
  put_history("elastic", r.elastic_history);
  put_history("kinetic", r.kinetic_history);
  for (const auto &[name, error] : r.gauges)
    for (const auto &[norm, value] :
         {std::pair("error", error.mean), std::pair("error_max", error.largest)})
      json["gauges"][name][norm] = value ? nlohmann::json(*value) : nlohmann::json();
  put("compared_until", r.compared_until);
  json["matched_particles"] = r.matched_particles;
  json["notes"] = r.notes;
  json["plot"] = r.svg_file;
  json["page"] = r.html_file;
  return json;
}
} // namespace ligament::program
