// The shape of the specimen: one description of it, and one that bounds a body.
#include "core/keyed_error.h"
#include "core/load.h"
#include "core/parameters/spelling.h"
#include "src/scene/body_file.h"
#include "src/scene/body_shape.h"
#include "src/scene/check_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace ligament::program
{
namespace
{
const std::string section = "/specimen";

/// The ways to say what the specimen is, and which of them are used.
void check_choice(const Scene &scene, Findings &f)
{
  const Specimen &s = scene.specimen;
  std::vector<std::string> given;
  for (const auto &[key, is_given] :
       {std::pair("size", f.given(section + "/size")), std::pair("outline", !s.outline.empty()),
        std::pair("ball", s.ball.has_value()), std::pair("file", !s.file.empty())})
    if (is_given)
      given.push_back(key);
  if (given.empty() && f.sound({section}))
    return f.error(section + "/size", "missing key \"size\" in /specimen",
                   "it says how large the body is",
                   scene.dimension == 2 ? "add \"size\": [.., ..], or an \"outline\""
                                        : "add \"size\", an \"outline\", \"ball\" or "
                                          "\"file\"");
  if (given.size() > 1)
    return f.error(section + "/" + given[1],
                   fmt::format("both \"{}\" and \"{}\" in /specimen", given[0], given[1]),
                   "each of them says what the body is", "remove one of them");
  const bool is_prism = given == std::vector<std::string>{"outline"};
  if (scene.dimension == 3 && f.given(section + "/thickness") && !is_prism)
    f.error(section + "/thickness", "\"thickness\" in /specimen has no meaning here",
            "in 3D it is the extent of an \"outline\" along z", "remove it");
  if (scene.dimension == 3 && is_prism && !f.given(section + "/thickness") &&
      f.sound({section + "/thickness"}))
    f.error(section + "/thickness", "missing key \"thickness\" in /specimen",
            "an outline in 3D is that of a prism along z", "add \"thickness\"");
  if (s.ball || (scene.dimension == 3 && !s.file.empty()))
    for (const auto &[key, is_given] :
         {std::pair("cutouts", !s.cutouts.empty()), std::pair("slots", !s.slots.empty())})
      if (is_given)
        f.error(section + "/" + std::string(key),
                fmt::format("\"{}\" in /specimen beside \"{}\"", key, given[0]),
                "they cut boxes and prisms only", "remove them, or give \"notches\"");
}

/// Calls visit(boundary, vertices) for each side or facet of a body from a file.
template <typename Visit>
void for_each_facet(const BodyFile &body, Visit &&visit)
{
  for (const core::Polygon &polygon : body.polygons)
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vector<2> &a = polygon[k].place, &b = polygon[(k + 1) % polygon.size()].place;
      visit(polygon[k].boundary,
            std::vector<Vector<3>>{Vector<3>(a[0], a[1], 0), Vector<3>(b[0], b[1], 0)});
    }
  for (const auto &facet : body.facets) {
    std::vector<Vector<3>> vertices;
    for (const auto &edge : facet.edges)
      vertices.push_back(body.vertices[edge[0]]);
    visit(facet.boundary, vertices);
  }
}

/// A group of a file may have the name of a side of the box where it lies there alone: elsewhere
/// loads would act on both.
void check_names_of_file(const Specimen &s, Findings &f)
{
  std::set<std::string> told;
  for_each_facet(*s.body, [&](int boundary, const std::vector<Vector<3>> &vertices) {
    if (boundary < 0)
      return;
    const std::string &name = s.body->names[boundary];
    const auto side = std::find(box_sides.begin(), box_sides.end(), name);
    if (side == box_sides.end() || told.count(name))
      return;
    const int number = int(side - box_sides.begin()), axis = number / 2;
    const double place = number % 2 ? s.upper(axis) : s.lower(axis);
    const bool lies_there = std::all_of(vertices.begin(), vertices.end(), [&](const auto &x) {
      return std::abs(x[axis] - place) <= 1e-6 * s.size[axis];
    });
    if (lies_there)
      return;
    told.insert(name);
    f.error(section + "/file",
            fmt::format("\"file\" in /specimen has a group \"{}\" that does not lie on that side",
                        name),
            fmt::format("what lies on that side of the box around the specimen has this name by "
                        "itself; of the group something is at ({:.4g}, {:.4g}, {:.4g}) m",
                        vertices[0][0], vertices[0][1], vertices[0][2]),
            "give the group another name");
  });
}

/// Sides that a scene names itself.
void check_names(const Scene &scene, Findings &f)
{
  const auto check = [&](const std::string &name, const std::string &key) {
    if (std::find(box_sides.begin(), box_sides.end(), name) != box_sides.end())
      f.error(key + "/side", fmt::format("\"side\" in {} is \"{}\"", key, name),
              "what lies on that side of the box around the specimen has this name by itself",
              "give another name, or none");
  };
  const Specimen &s = scene.specimen;
  if (s.body && f.sound({section + "/file"}))
    check_names_of_file(s, f);
  for (std::size_t k = 0; k < s.outline.size(); ++k)
    check(s.outline[k].side, fmt::format("{}/outline/{}", section, k));
  for (std::size_t k = 0; k < s.cutouts.size(); ++k) {
    const std::string key = fmt::format("{}/cutouts/{}", section, k);
    check(s.cutouts[k].side, key);
    for (std::size_t j = 0; j < s.cutouts[k].outline.size(); ++j)
      check(s.cutouts[k].outline[j].side, fmt::format("{}/outline/{}", key, j));
  }
  for (std::size_t k = 0; k < s.slots.size(); ++k)
    check(s.slots[k].side, fmt::format("{}/slots/{}", section, k));
}

void check_outline(const std::vector<OutlineCorner> &outline, const std::string &key, Findings &f)
{
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const OutlineCorner &corner = outline[k];
    const std::string at = fmt::format("{}/{}", key, k);
    if (corner.centre[0].has_value() != corner.centre[1].has_value())
      f.error(at + "/centre", fmt::format("\"centre\" in {} has one coordinate", at),
              "an arc runs about a point", "give both, or no centre for a straight side");
    else if (corner.clockwise && !corner.centre[0])
      f.error(at + "/clockwise", fmt::format("\"clockwise\" in {} without a \"centre\"", at),
              "the way to this corner is straight", "remove it, or give the centre of an arc");
  }
}

void check_slot(const Slot &slot, const std::string &key, double spacing, Findings &f)
{
  if (slot.tip != SlotTip::v && slot.tip_angle != Slot().tip_angle)
    f.error(key + "/tip_angle",
            fmt::format("\"tip_angle\" in {}, whose \"tip\" is \"{}\"", key, word_of(slot.tip)),
            "only a tip \"v\" has an angle", "remove it, or choose the tip \"v\"");
  const double length = std::hypot(slot.to[0] - slot.from[0], slot.to[1] - slot.from[1]);
  const double tip = slot.tip == SlotTip::flat    ? 0
                     : slot.tip == SlotTip::round ? slot.width / 2
                                                  : slot.width / 2 / std::tan(slot.tip_angle / 2);
  if (length < tip * (1 - 1e-9) || length == 0)
    return f.error(key + "/to", fmt::format("the slot {} is shorter than its tip", key),
                   fmt::format("it is {:.4g} m long, its tip {:.4g} m", length, tip),
                   "make it longer, or its width smaller");
  if (slot.width < spacing * (1 - 1e-9))
    f.error(key + "/width",
            fmt::format("\"width\" in {} is {} m, less than a spacing", key, slot.width),
            fmt::format("the particles cannot show it: \"spacing\" is {} m", spacing),
            "widen it, make the spacing smaller, or give a crack");
}
} // namespace

void check_corners(const Scene &scene, Findings &f)
{
  check_outline(scene.specimen.outline, section + "/outline", f);
  for (std::size_t k = 0; k < scene.specimen.cutouts.size(); ++k)
    check_outline(scene.specimen.cutouts[k].outline,
                  fmt::format("{}/cutouts/{}/outline", section, k), f);
}

void check_shape(const Scene &scene, Findings &f)
{
  check_choice(scene, f);
  check_names(scene, f);
  const Specimen &s = scene.specimen;
  const bool particles = scene.zone.extent != DiscreteZone::Extent::none &&
                         f.sound_and_given({"/discrete_zone/spacing"});
  for (std::size_t k = 0; k < s.slots.size(); ++k)
    if (const auto key = fmt::format("{}/slots/{}", section, k); f.sound({key}))
      check_slot(s.slots[k], key, particles ? scene.zone.spacing : 0, f);
  if (scene.far_field && scene.far_field->cells_from_file && s.file.empty())
    f.error("/far_field/cells_from_file", "\"cells_from_file\" in /far_field without a file",
            "/specimen has no \"file\"", "add one, or remove the key");
  if (s.body && s.body->mesh.was_second_order)
    f.warning(section + "/file", "\"file\" in /specimen has elements of second order",
              "their corners are taken, and straight edges between them",
              "mesh it by first order, finer where it is curved");
  if (!f.sound({section}) || s.is_plain() || s.ball || (scene.dimension == 3 && !s.file.empty()))
    return;
  try {
    const auto polygons =
        outline_of(s, scene.dimension, std::max(s.size[0], s.size[1]) / 400, scene.dimension == 2);
    const auto n_pieces = std::count_if(polygons.begin(), polygons.end(), [](const auto &polygon) {
      return core::signed_area(polygon) > 0;
    });
    if (n_pieces > 1)
      f.warning(section, fmt::format("the specimen is in {} pieces", n_pieces),
                "cutouts and slots part it", "make them smaller, unless the pieces are wanted");
  } catch (const core::KeyedError &error) {
    f.error(error.key, error.message, error.reason, error.remedy);
  }
}

void resolve_sides(Scene &scene, Findings *f)
{
  const auto names = side_names_of(scene.specimen, scene.dimension);
  const auto number = [&](const std::string &name, const std::string &key) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (!name.empty() && found != names.end())
      return int(found - names.begin());
    std::vector<std::string> known;
    for (const std::string &one : names)
      if (!one.empty())
        known.push_back(one);
    if (f && f->sound_and_given({key}))
      f->error(key, fmt::format("the specimen has no side \"{}\"", name),
               "it has " + core::listed(known),
               "use one of them, or name a side of its outline so");
    return -1;
  };
  for (std::size_t k = 0; k < scene.loads.size(); ++k) {
    LoadParameters &load = scene.loads[k];
    if (load.periodic && load.side.empty())
      load.boundary = core::BoundaryLoad<3>::jump_across(int(*load.periodic));
    else if (load.side.empty() && f) {
      load.boundary = -1;
      const std::string key = fmt::format("/loads/{}", k);
      if (f->sound({key}))
        f->error(key + "/boundary", fmt::format("missing key \"boundary\" in {}", key),
                 "it says on which side the load acts",
                 "add it: a side of the specimen, or \"periodic\" with an axis");
    } else
      load.boundary = number(load.side, fmt::format("/loads/{}/boundary", k));
  }
  for (std::size_t k = 0; k < scene.gauges.size(); ++k) {
    GaugeParameters &gauge = scene.gauges[k];
    gauge.side.reset();
    if (!gauge.side_name.empty())
      gauge.side = number(gauge.side_name, fmt::format("/gauges/{}/side", k));
  }
}
} // namespace ligament::program
