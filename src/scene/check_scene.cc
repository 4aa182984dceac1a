#include "src/scene/check_scene.h"

#include "core/parameters/spelling.h"
#include "src/drawing/shown_field.h"
#include "src/scene/atoms.h"
#include "src/scene/check_flow_loads.h"
#include "src/scene/zone_around.h"

#include <fmt/format.h>

#include <algorithm>

namespace ligament::program
{
namespace
{
using Extent = DiscreteZone::Extent;

const std::string zone_key = "/discrete_zone", far_key = "/far_field",
                  region_key = "/discrete_zone/region", boxes_key = "/discrete_zone/boxes";

Box box_of(const Specimen &specimen)
{
  Box box;
  for (int c = 0; c < 3; ++c) {
    box.lower[c] = specimen.lower(c);
    box.upper[c] = specimen.upper(c);
  }
  return box;
}

/// Both models must be able to exist: the keys that are needed only then.
void check_models(const Scene &scene, Findings &f)
{
  if (!f.given(zone_key) || !f.sound({zone_key + "/extent"}))
    return;
  const bool no_far = !scene.far_field.has_value();
  if (scene.zone.extent == Extent::none) {
    if (no_far && f.sound({far_key}))
      f.error(far_key, "neither \"discrete_zone\" nor \"far_field\" is there",
              "a scene needs at least one of the two models", "give one of them");
    return;
  }
  if (scene.zone.extent == Extent::box && no_far && f.sound({far_key}))
    f.error(far_key, "missing key \"far_field\" in /",
            "the discrete zone is a part of the specimen, the rest needs finite elements",
            "add \"far_field\": {\"cell_size\": ..}, or \"far_field\": \"none\" for the pure "
            "discrete reference");
  if (scene.zone.extent == Extent::box && !f.given(region_key) && scene.zone.boxes.empty() &&
      !scene.zone.around && f.sound({region_key, boxes_key, zone_key + "/around"}))
    f.error(region_key, "missing key \"region\" in /discrete_zone",
            "it says which part of the specimen is discrete", proposed_zone(scene, f));
  for (const std::string key : {"packing", "spacing"})
    if (!f.given(zone_key + "/" + key) && f.sound({zone_key + "/" + key, "/atoms"}) &&
        !(scene.atoms && key == "spacing"))
      f.error(zone_key + "/" + key, fmt::format("missing key \"{}\" in /discrete_zone", key),
              "scenes with discrete elements need it", fmt::format("add \"{}\"", key));
}

/// Keys beside an extent "all", written out. What `--set` makes of a coupled scene, its twins
/// "/far_field=none" and "/discrete_zone=none", keeps them.
void check_extent(const Scene &scene, Findings &f)
{
  if (scene.zone.extent != Extent::all || !f.sound({zone_key, far_key}))
    return;
  const std::string reason = "the \"extent\" of /discrete_zone is \"all\"",
                    remedy = "remove it, or the \"extent\"";
  if (scene.far_field)
    return f.unused(far_key, reason, "write \"none\", or remove the \"extent\"");
  if (f.given(far_key))
    return;
  const ZoneBox plain;
  if (!scene.zone.boxes.empty())
    f.unused(boxes_key, reason, remedy);
  else if (scene.zone.around)
    f.unused(zone_key + "/around", reason, remedy);
  else if (scene.zone.lower != plain.lower || scene.zone.upper != plain.upper)
    f.unused(region_key, reason, remedy);
}

/// Keys that belong to another packing than the one that was chosen. Their defaults do no harm.
void check_packing_keys(const Scene &scene, Findings &f)
{
  const DiscreteZone &zone = scene.zone, plain;
  const std::string packing = word_of(*zone.packing);
  const auto refuse = [&](const std::string &name, PackingKind only, bool differs) {
    const std::string key = zone_key + "/" + name, &needed = word_of(only);
    if (zone.packing == only || !f.sound_and_given({key}))
      return;
    const std::string message = fmt::format(
        "\"{}\" in /discrete_zone has no meaning for the packing \"{}\"", name, packing);
    const std::string reason = fmt::format("only the packing \"{}\" has one", needed),
                      remedy = fmt::format("remove it, or choose the packing \"{}\"", needed);
    if (differs)
      f.error(key, message, reason, remedy);
    else
      f.warning(key, message, reason, remedy);
  };
  refuse("seed", PackingKind::random, zone.seed != plain.seed);
  refuse("relaxation_sweeps", PackingKind::random,
         zone.relaxation_sweeps != plain.relaxation_sweeps);
  refuse("size_ratio", PackingKind::random, zone.size_ratio != plain.size_ratio);
  refuse("packing_file", PackingKind::file, !zone.packing_file.empty());
  if (zone.packing == PackingKind::file && zone.packing_file.empty() &&
      f.sound({zone_key + "/packing_file"}))
    f.error(zone_key + "/packing",
            "\"packing\" in /discrete_zone is \"file\", but there is no \"packing_file\"",
            "the particles stand in a file", "add \"packing_file\"");
  if (zone.is_irregular() && zone.orientation != plain.orientation &&
      f.sound({zone_key + "/orientation"}))
    f.error(zone_key + "/orientation",
            fmt::format("\"orientation\" in /discrete_zone has no meaning for the packing \"{}\"",
                        packing),
            "only lattices have rows to turn", "remove it");
}

void check_packing(const Scene &scene, Findings &f)
{
  const std::string key = zone_key + "/packing";
  if (!f.sound_and_given({"/discrete_zone/packing"}))
    return;
  check_packing_keys(scene, f);
  if (!f.sound({"/dimension"}) || scene.zone.is_irregular() || scene.atoms)
    return;
  if (scene.zone.packing == PackingKind::bcc) {
    f.error(key, "\"packing\" in /discrete_zone is \"bcc\" without \"atoms\"",
            "cells on this lattice are not known to the law of discrete elements",
            "choose \"fcc\", \"simple_cubic\" or \"random\", or give \"atoms\"");
    return;
  }
  const bool plane =
      scene.zone.packing == PackingKind::square || scene.zone.packing == PackingKind::hexagonal;
  if (plane != (scene.dimension == 2))
    f.error(key,
            fmt::format("\"packing\" in /discrete_zone is \"{}\", which is not a packing in {}D",
                        word_of(*scene.zone.packing), scene.dimension),
            fmt::format("/dimension is {}", scene.dimension),
            scene.dimension == 2 ? "choose \"hexagonal\", \"square\" or \"random\""
                                 : "choose \"fcc\", \"simple_cubic\" or \"random\"");
}

void check_time(const Scene &scene, Findings &f)
{
  if (f.given("/time/step") && f.given("/time/step_fraction"))
    f.error("/time/step", "both \"step\" and \"step_fraction\" in /time",
            "they are two ways to say the same", "remove one of them");
  else if (f.sound_and_given({"/time/step", "/time/duration"}) &&
           *scene.time.step > scene.time.duration)
    f.error("/time/step",
            fmt::format("\"step\" in /time is {} s, longer than the duration of {} s",
                        *scene.time.step, scene.time.duration),
            "nothing would be computed", "give a smaller step, or none");
  if (f.sound({"/time/stop_when", "/material/fracture/criterion", "/inclusions"}) &&
      scene.time.stop_when == StopWhen::specimen_broken && !may_break(scene))
    f.warning("/time/stop_when", "\"stop_when\" in /time waits for a fracture that cannot happen",
              "the fracture criterion is \"none\"", "remove it, or choose a criterion");
}

/// Whether there is a load that a testing machine would read: sides between which it is carried.
bool has_test_load(const Scene &scene)
{
  const auto is_any = [](const PartialPoint &value) {
    return std::any_of(value.begin(), value.end(),
                       [](const auto &v) { return v.value_or(0) != 0; });
  };
  const auto is_given = [&](const LoadParameters &load) {
    const bool presses_a_side = load.pressure && load.boundary < 2 * scene.dimension;
    return presses_a_side || is_any(load.velocity) || is_any(load.displacement) ||
           is_any(load.traction) || is_any(load.force) || is_any(load.strain);
  };
  return std::any_of(scene.loads.begin(), scene.loads.end(), is_given) ||
         std::any_of(scene.tools.begin(), scene.tools.end(),
                     [](const ToolParameters &tool) { return tool.is_driven(); });
}

void check_load_path(const Scene &scene, Findings &f)
{
  if (f.sound({"/time/stop_when", "/loads", "/tools"}) &&
      scene.time.stop_when == StopWhen::specimen_broken && !has_test_load(scene))
    f.warning(
        "/time/stop_when",
        "\"stop_when\" in /time waits for a load path to be lost, and there is none",
        "it lies between a side or a tool that is driven and the other end; what a body force "
        "or an initial motion breaks is not looked for",
        "remove it, and give the duration that is wanted");
}

/// The field of this word; null: one that is nowhere by itself.
const FieldInfo *field_of(const std::string &word, int dimension)
{
  const std::string name = shown_field(word, dimension).field;
  for (const FieldInfo &info : field_table())
    if (info.name == name)
      return &info;
  return nullptr;
}

FieldInfo::Only only_of(const std::string &word, int dimension)
{
  const FieldInfo *info = field_of(word, dimension);
  return info ? info->only : FieldInfo::Only::anywhere;
}

/// Why the run will have no such field to colour its pictures by; empty: it will.
std::string why_grey(const Scene &scene, const std::string &word)
{
  const FieldInfo *info = field_of(word, scene.dimension);
  const bool is_of_mesh = info && (info->on_nodes || info->on_cells);
  if (scene.zone.extent == Extent::none && !is_of_mesh)
    return "only particles have one, and there is no discrete zone";
  if ((word == "softened" || word == "opening") && !may_soften(scene))
    return "no face softens: it takes a \"strength\" and an \"energy\"";
  return "";
}

/// Components across the plane are 0 in 2D.
void check_pictures(const Scene &scene, Findings &f)
{
  const auto words = shown_field_words(scene.dimension);
  for (std::size_t k = 0; k < scene.output.pictures.size(); ++k) {
    const std::string key = fmt::format("/output/pictures/{}", k);
    const std::string &field = scene.output.pictures[k].field;
    if (!f.sound({key}))
      continue;
    if (std::find(words.begin(), words.end(), field) == words.end())
      f.error(key + "/field", fmt::format("there is no \"{}\" in 2D", field), "it is 0 everywhere",
              "use one of " + core::listed(words));
    else if (!scene.atoms && only_of(field, scene.dimension) == FieldInfo::Only::of_atoms)
      f.error(key + "/field", fmt::format("a picture of \"{}\"", field), "only atoms have one",
              "give \"atoms\", or remove the picture");
    else if (!scene.flows() && only_of(field, scene.dimension) == FieldInfo::Only::where_it_flows)
      f.error(key + "/field", fmt::format("a picture of \"{}\"", field), "no material flows",
              "give one its \"plasticity\", or remove the picture");
    else if (const std::string reason = why_grey(scene, field);
             !reason.empty() && f.sound({"/material", "/inclusions", zone_key}))
      f.warning(key + "/field", fmt::format("a picture of \"{}\" will be grey", field), reason,
                "choose another field, or remove the picture");
  }
}
} // namespace

void check_scene(const Scene &scene, Findings &f)
{
  check_models(scene, f);
  check_extent(scene, f);
  check_packing(scene, f);
  check_atoms(scene, f);
  check_fracture(scene.material, "/material/fracture", scene, f);
  check_softening(scene, scene.material, "/material/fracture", f);
  check_plasticity(scene, f);
  check_viscosity(scene, f);
  check_face_life(scene, f);
  check_time(scene, f);
  check_unused_keys(scene, f);
  if (!f.sound({"/dimension"}))
    return;
  check_shape(scene, f);
  std::optional<Layout> layout;
  const double *size = scene.specimen.size.data();
  if (f.sound({"/specimen"}) && *std::min_element(size, size + scene.dimension) > 0) {
    const Box specimen = box_of(scene.specimen);
    layout = check_layout(scene, specimen, f);
    check_cuts(scene, specimen, layout ? &*layout : nullptr, f);
    check_inclusions(scene, specimen, layout ? &*layout : nullptr, f);
    check_substitutions(scene, f);
    check_gauges(scene, specimen, f);
  }
  check_periodic(scene, layout ? &*layout : nullptr, f);
  check_loads(scene, layout ? &*layout : nullptr, f);
  check_motion(scene, f);
  check_tools(scene, f);
  check_load_path(scene, f);
  check_phases(scene, f);
  check_scales(scene, f);
  check_flow_loads(scene, f);
  check_pictures(scene, f);
}
} // namespace ligament::program
