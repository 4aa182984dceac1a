#include "src/scene/read_scene.h"

#include "core/check.h"
#include "core/input_file.h"
#include "core/json.h"
#include "core/keyed_error.h"
#include "core/parameters/describe_parameters.h"
#include "core/parameters/override.h"
#include "core/parameters/read_parameters.h"
#include "src/scene/atoms.h"
#include "src/scene/body_shape.h"
#include "src/scene/check_scene.h"
#include "src/scene/scene_parameters.h"
#include "src/scene/zone_around.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace ligament::program
{
namespace
{
/// The dimension decides how the other keys are read; 0 when its own value is wrong.
int dimension_of(const core::JsonValue &json)
{
  const core::JsonMember *member = json.find("dimension");
  if (!member)
    return Scene().dimension;
  const core::JsonValue &value = member->value;
  const bool good =
      value.is(core::JsonValue::Kind::number) && (value.number == 2 || value.number == 3);
  return good ? int(value.number) : 0;
}

/// An echo says "none" where there are none.
bool has_atoms(const core::JsonValue &json)
{
  const core::JsonMember *atoms = json.find("atoms");
  return atoms && !(atoms->value.is(core::JsonValue::Kind::string) && atoms->value.text == "none");
}

/// What the table cannot say: "far_field": "none" makes everything discrete.
void apply_far_field_word(const core::JsonValue &json, Scene &scene)
{
  const core::JsonMember *far = json.find("far_field");
  const bool none =
      far && far->value.is(core::JsonValue::Kind::string) && far->value.text == "none";
  if (none && scene.zone.extent == DiscreteZone::Extent::box)
    scene.zone.extent = DiscreteZone::Extent::all;
}

/// The corners around all boxes of the zone.
void enclose_boxes(DiscreteZone &zone)
{
  for (std::size_t i = 0; i < zone.boxes.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const ZoneBox &box = zone.boxes[i];
      zone.lower[c] = i == 0 ? box.lower[c] : std::min(zone.lower[c], box.lower[c]);
      zone.upper[c] = i == 0 ? box.upper[c] : std::max(zone.upper[c], box.upper[c]);
    }
}

/// A region that says nothing leaves the choice to the boxes.
void check_choice_of_zone(const DiscreteZone &zone, int dimension, Findings &findings)
{
  bool says_something = false;
  for (int c = 0; c < dimension; ++c)
    says_something |= std::isfinite(zone.lower[c]) || std::isfinite(zone.upper[c]);
  if (zone.around && (!zone.boxes.empty() || says_something))
    findings.error("/discrete_zone/around",
                   fmt::format("both \"around\" and \"{}\" in /discrete_zone",
                               zone.boxes.empty() ? "region" : "boxes"),
                   "they are two ways to say which part of the specimen is discrete",
                   "remove one of them");
  if (!zone.boxes.empty() && says_something)
    findings.error("/discrete_zone/boxes", "both \"region\" and \"boxes\" in /discrete_zone",
                   "they are two ways to say which part of the specimen is discrete",
                   "remove one of them");
}

/// Keys that mean nothing to the packing are not echoed: reading them again would be doubted.
void leave_out_unused(const DiscreteZone &zone, nlohmann::ordered_json &json)
{
  if (zone.packing != PackingKind::random)
    for (const char *key : {"seed", "relaxation_sweeps", "size_ratio"})
      json.erase(key);
  if (zone.packing != PackingKind::file)
    json.erase("packing_file");
}

/// Likewise of a gauge, whose other keys belong to other kinds.
void leave_out_unused(const GaugeParameters &gauge, nlohmann::ordered_json &json)
{
  const std::vector<std::string> own = keys_of(gauge.kind);
  for (const auto &name : std::vector<std::string>{"points", "direction", "normal", "lower",
                                                   "upper", "inner_lower", "inner_upper", "angle",
                                                   "side", "load", "tool", "smoothing", "mass"})
    if (std::find(own.begin(), own.end(), name) == own.end())
      json.erase(name);
  // What was left open by saying something else would be doubted like a contradiction.
  for (const auto &[name, is_open] :
       {std::pair("points", gauge.points.empty()), std::pair("load", gauge.load < 0),
        std::pair("side", gauge.side_name.empty()), std::pair("tool", gauge.tool.empty())})
    if (is_open)
      json.erase(name);
  const bool has_point = !gauge.points.empty();
  if (has_point && (gauge.kind == GaugeKind::strain || gauge.kind == GaugeKind::stress))
    for (const char *name : {"lower", "upper"})
      json.erase(name);
}

/// Likewise of a load on a side, or of a jump.
void leave_out_unused(const LoadParameters &load, nlohmann::ordered_json &json)
{
  if (load.periodic) {
    json.erase("boundary");
    return;
  }
  json.erase("periodic");
  json.erase("strain");
}

/// Likewise of a tool of another shape.
void leave_out_unused(const ToolParameters &tool, nlohmann::ordered_json &json)
{
  const auto keep_for = [&](const char *key, std::initializer_list<ToolKind> kinds) {
    if (std::find(kinds.begin(), kinds.end(), tool.shape) == kinds.end())
      json.erase(key);
  };
  keep_for("size", {ToolKind::plate});
  keep_for("radius", {ToolKind::roller, ToolKind::ball});
  keep_for("length", {ToolKind::roller, ToolKind::wedge});
  keep_for("points", {ToolKind::wedge});
}

/// Relative paths in a scene start in its folder; in one that came through a pipe where we are.
void locate_files(const std::string &name, Scene &scene)
{
  if (name == scene_name("-") || !core::is_named_file(name))
    return;
  std::vector<std::string *> paths = {&scene.zone.packing_file, &scene.specimen.file};
  if (scene.atoms)
    paths.push_back(&scene.atoms->file);
  for (std::string *path : paths)
    if (!path->empty())
      *path = (std::filesystem::path(name).parent_path() / *path).string();
}

/// Values in the form in which the program uses them.
void complete(Scene &scene)
{
  resolve_atoms(scene, nullptr);
  enclose_body(scene.specimen, scene.dimension);
  place_zone(scene);
  enclose_boxes(scene.zone);
  resolve_sides(scene, nullptr);
  for (int c = 0; c < 3; ++c) {
    const double size = scene.specimen.size[c], centre = scene.specimen.centre[c];
    if (scene.zone.extent == DiscreteZone::Extent::all || std::isinf(scene.zone.lower[c]))
      scene.zone.lower[c] = centre - size;
    if (scene.zone.extent == DiscreteZone::Extent::all || std::isinf(scene.zone.upper[c]))
      scene.zone.upper[c] = centre + size;
  }
  if (scene.zone.extent == DiscreteZone::Extent::all)
    scene.far_field.reset();
  for (LoadParameters &load : scene.loads) {
    if (load.absorbing)
      load.kind = LoadKind::traction;
    for (const auto &[kind, value] :
         {std::pair(LoadKind::velocity, load.velocity),
          std::pair(LoadKind::displacement, load.displacement),
          std::pair(LoadKind::traction, load.traction), std::pair(LoadKind::force, load.force)})
      if (value[0] || value[1] || value[2]) {
        load.kind = kind;
        load.value = value;
      }
    for (int c = 0; c < 3 && load.periodic; ++c)
      if (load.strain[c]) {
        load.kind = LoadKind::displacement;
        load.value[c] = *load.strain[c] * scene.specimen.size[int(*load.periodic)];
      }
    if (load.pressure)
      load.kind = LoadKind::pressure;
  }
}

/// Overrides are of either form that apply_override() takes.
template <typename Overrides>
ReadResult parse(const std::string &text, const std::string &name, const Overrides &overrides)
{
  ReadResult result;
  core::JsonValue &json = result.json = core::parse_json(text, name, result.errors);
  // A value that a repeated key hides does not stop the search for other mistakes, bad syntax does.
  if (json.is(core::JsonValue::Kind::null) && !result.errors.empty())
    return result;
  Scene scene;
  core::ParameterSection table;
  declare_scene(table, scene, has_atoms(json));
  for (const auto &o : overrides)
    core::apply_override(table, o, json, result.errors);
  const int dimension = dimension_of(json);
  core::read_parameters(table, json, "", dimension, table, result.errors, &result.warnings);
  result.keys_are_right = result.errors.empty();
  apply_far_field_word(json, scene);
  double found_lattice = 0; // m
  if (json.is(core::JsonValue::Kind::object)) {
    Findings findings(json, result.errors, result.warnings);
    check_choice_of_zone(scene.zone, dimension, findings);
    check_corners(scene, findings);
    Scene enclosed = scene; // the table's variables stay as they were read: they are echoed
    locate_files(name, enclosed);
    resolve_atoms(enclosed, &findings);
    if (enclosed.is_warm())
      found_lattice = enclosed.atoms->lattice_parameter;
    try {
      if (findings.sound({"/specimen", "/dimension"}))
        enclose_body(enclosed.specimen, dimension);
      if (findings.sound({"/specimen", "/dimension", "/discrete_zone", "/far_field", "/coupling"}))
        place_zone(enclosed);
    } catch (const core::KeyedError &error) {
      findings.error(error.key, error.message, error.reason, error.remedy);
    }
    enclose_boxes(enclosed.zone);
    if (findings.sound({"/dimension", "/specimen/file"})) // which names the sides
      resolve_sides(enclosed, &findings);
    check_scene(enclosed, findings);
  }
  core::sort_by_place(result.errors);
  core::sort_by_place(result.warnings);
  if (!result.errors.empty())
    return result;
  result.resolved = core::echo(table, dimension);
  leave_out_unused(scene.zone, result.resolved["discrete_zone"]);
  for (std::size_t k = 0; k < scene.gauges.size(); ++k)
    leave_out_unused(scene.gauges[k], result.resolved["gauges"][k]);
  for (std::size_t k = 0; k < scene.loads.size(); ++k)
    leave_out_unused(scene.loads[k], result.resolved["loads"][k]);
  for (std::size_t k = 0; k < scene.tools.size(); ++k)
    leave_out_unused(scene.tools[k], result.resolved["tools"][k]);
  if (scene.time.step)
    result.resolved["time"].erase("step_fraction");
  if (scene.specimen.has_own_box())
    result.resolved["specimen"].erase("size");
  if (scene.dimension == 3 && scene.specimen.outline.empty())
    result.resolved["specimen"].erase("thickness");
  locate_files(name, scene);
  if (!scene.specimen.file.empty()) // whoever resumes the run reads it from another folder
    result.resolved["specimen"]["file"] = std::filesystem::absolute(scene.specimen.file).string();
  if (scene.zone.packing == PackingKind::file)
    result.resolved["discrete_zone"]["packing_file"] =
        std::filesystem::absolute(scene.zone.packing_file).string();
  if (scene.atoms) {
    result.resolved.erase("material");
    result.resolved["discrete_zone"].erase("spacing");
    if (!scene.atoms->file.empty())
      result.resolved["atoms"]["file"] = std::filesystem::absolute(scene.atoms->file).string();
  }
  if (found_lattice > 0) // not echoed: whoever reads the scene may choose another temperature
    scene.atoms->lattice_parameter = found_lattice;
  complete(scene);
  result.scene = std::move(scene);
  return result;
}

ReadResult refused(const std::string &file, const std::string &reason, const std::string &remedy)
{
  ReadResult result;
  result.errors.push_back(
      {core::Place{scene_name(file)}, "", "cannot read the scene", reason, remedy});
  return result;
}

template <typename Overrides>
ReadResult read(const std::string &file, const Overrides &overrides)
{
  std::string text;
  try {
    text = core::read_input(file);
  } catch (const core::EnvironmentError &error) {
    return refused(file, error.what(), "check the path");
  }
  if (text.find_first_not_of(" \t\r\n") == text.npos)
    return refused(file, "it is empty",
                   "write a scene into it; examples/cracked_plate/scene.json is one");
  ReadResult result = parse(text, scene_name(file), overrides);
  result.text = std::move(text);
  return result;
}
} // namespace

std::string scene_name(const std::string &file)
{
  return file == "-" ? "standard input" : file;
}

ReadResult parse_scene(const std::string &text, const std::string &name,
                       const std::vector<std::string> &overrides)
{
  return parse(text, name, overrides);
}

ReadResult read_scene(const std::string &file, const std::vector<std::string> &overrides)
{
  return read(file, overrides);
}

ReadResult read_scene(const std::string &file, const std::vector<core::Override> &overrides)
{
  return read(file, overrides);
}

std::string explain(const std::string &key)
{
  Scene scene;
  core::ParameterSection table;
  declare_scene(table, scene);
  return core::explain(table, key);
}

nlohmann::ordered_json explain_json(const std::string &key)
{
  Scene scene;
  core::ParameterSection table;
  declare_scene(table, scene);
  return core::explain_json(table, key);
}

nlohmann::ordered_json json_schema()
{
  Scene scene;
  core::ParameterSection table;
  declare_scene(table, scene);
  nlohmann::ordered_json schema = core::schema(table);
  schema["title"] = "Ligament scene";
  return schema;
}

std::string reference_markdown()
{
  Scene scene;
  core::ParameterSection table;
  declare_scene(table, scene);
  return "# Scene files: all keys\n"
         "\n"
         "Generated from the table in `src/scene/scene_parameters.cc` by `ligament explain "
         "--markdown`; a test keeps it up to date.\n"
         "\n"
         "A scene is JSON with `//` and `/* */` comments. Numbers are in SI units; a string gives "
         "another unit:\n"
         "`\"12.5 mm\"`, `\"0.75 MPa*m^0.5\"`, `\"22.2 kJ/m^2\"`, `\"15 deg\"`. Units are products "
         "of m, g, s, Hz, N, Pa, bar,\n"
         "J, eV, W and rad with the usual prefixes, and of t, min, h, u, angstrom, K, deg, ° and "
         "%; `*` or a blank multiplies,\n"
         "`/` divides by the next factor only, `^0.5` and `sqrt(..)` are powers. Any key can be "
         "given on the command line:\n"
         "`--set /path=value`.\n" +
         core::markdown_tables(table, "The scene as a whole");
}
} // namespace ligament::program
