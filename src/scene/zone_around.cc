#include "src/scene/zone_around.h"

#include "core/keyed_error.h"
#include "src/scene/body_shape.h"
#include "src/scene/geometry.h"

#include <fmt/format.h>

#include <algorithm>

namespace ligament::program
{
namespace
{
constexpr double corner = 30 * M_PI / 180; // rad, from which on a turn inwards is a corner

/// Boxes around the things, within the specimen.
std::vector<Box> things(const Scene &scene, const ZoneAround &around)
{
  const Specimen &s = scene.specimen;
  std::vector<Box> boxes;
  const auto add = [&](Box box) {
    for (int c = 0; c < 3; ++c) {
      box.lower[c] = std::max(box.lower[c], s.lower(c));
      box.upper[c] = std::min(box.upper[c], s.upper(c));
    }
    boxes.push_back(box);
  };
  const auto all_of_z = [&](Box box) {
    if (scene.dimension == 3) {
      box.lower[2] = s.lower(2);
      box.upper[2] = s.upper(2);
    }
    return box;
  };
  if (around.cracks)
    for (const Crack &crack : s.cracks)
      if (!crack.points.empty()) // else the check of the cuts tells that
        add(bounding_box(crack.points));
  if (around.notches)
    for (const Notch &notch : s.notches)
      add({notch.lower, notch.upper});
  if (around.slots)
    for (const Slot &slot : s.slots) {
      Box box = bounding_box({slot.from, slot.to});
      for (int c = 0; c < 2; ++c) {
        box.lower[c] -= slot.width / 2;
        box.upper[c] += slot.width / 2;
      }
      add(all_of_z(box));
    }
  if (around.holes)
    for (const Hole &hole : s.holes)
      add({{hole.centre[0] - hole.radius, hole.centre[1] - hole.radius, 0},
           {hole.centre[0] + hole.radius, hole.centre[1] + hole.radius, 0}});
  if (around.cutouts)
    for (const Cutout &cutout : s.cutouts) {
      Specimen one;
      one.outline = cutout.outline;
      enclose_body(one, 2);
      add(all_of_z({one.lower(), one.upper()}));
    }
  if (around.corners) {
    Specimen plain = s; // corners of the outline itself
    plain.cutouts.clear();
    plain.slots.clear();
    plain.holes.clear();
    plain.notches.clear();
    for (const auto &polygon :
         outline_of(plain, scene.dimension, std::max(s.size[0], s.size[1]) / 400, false))
      for (std::size_t k = 0, n = polygon.size(); k < n; ++k) {
        const Vector<2> &x = polygon[k].place, u = x - polygon[(k + n - 1) % n].place,
                        v = polygon[(k + 1) % n].place - x;
        if (std::atan2(u[0] * v[1] - u[1] * v[0], u.dot(v)) < -corner)
          add(all_of_z({{x[0], x[1], 0}, {x[0], x[1], 0}}));
      }
  }
  return boxes;
}

/// The zone's boxes around those; infinite where they reach through.
std::vector<ZoneBox> zone_boxes(const Scene &scene, const ZoneAround &around, double cell_size)
{
  const Specimen &s = scene.specimen;
  const double overlap = scene.coupling.overlap_cells * cell_size;
  const double largest = cell_size * (scene.far_field ? std::pow(2., scene.far_field->levels) : 1.);
  const double apart = 2 * scene.coupling.transition_cells * cell_size;
  std::vector<Box> boxes = things(scene, around);
  for (Box &box : boxes)
    for (int c = 0; c < 3; ++c) {
      box.lower[c] -= around.margin + overlap;
      box.upper[c] += around.margin + overlap;
    }
  const auto are_apart = [&](const Box &a, const Box &b) {
    for (int c = 0; c < scene.dimension; ++c)
      if (a.upper[c] + apart < b.lower[c] || b.upper[c] + apart < a.lower[c])
        return true;
    return false;
  };
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t j = i + 1; j < boxes.size(); ++j)
      if (!are_apart(boxes[i], boxes[j])) {
        boxes[i] = bounding_box({boxes[i].lower, boxes[i].upper, boxes[j].lower, boxes[j].upper});
        boxes.erase(boxes.begin() + long(j));
        i = std::size_t(-1); // a larger box may meet others
        break;
      }
  std::vector<ZoneBox> zone;
  for (const Box &box : boxes) {
    ZoneBox &part = zone.emplace_back();
    for (int c = 0; c < scene.dimension; ++c) {
      if (box.lower[c] - s.lower(c) > 2 * largest)
        part.lower[c] = box.lower[c];
      if (s.upper(c) - box.upper[c] > 2 * largest)
        part.upper[c] = box.upper[c];
    }
  }
  return zone;
}

std::string text(const Point &p, int dim)
{
  std::string all;
  for (int c = 0; c < dim; ++c)
    all += (c == 0 ? "" : ", ") + (std::isfinite(p[c]) ? fmt::format("{:.4g}", p[c]) : "null");
  return "[" + all + "]";
}
} // namespace

void place_zone(Scene &scene)
{
  if (!scene.zone.around || scene.zone.extent != DiscreteZone::Extent::box)
    return;
  const double cell_size = scene.far_field ? scene.far_field->cell_size : 0;
  const auto boxes = zone_boxes(scene, *scene.zone.around, cell_size);
  if (boxes.empty())
    throw core::KeyedError("/discrete_zone/around", "\"around\" in /discrete_zone finds nothing",
                           "the specimen has none of what it names",
                           "set one of cracks, slots, notches, holes, cutouts and corners that it "
                           "has to true, or give a \"region\"");
  if (boxes.size() > 1) {
    scene.zone.boxes = boxes;
    return;
  }
  scene.zone.lower = boxes[0].lower;
  scene.zone.upper = boxes[0].upper;
}

std::string zone_place(const Scene &scene)
{
  return std::string("/discrete_zone/") + (scene.zone.around          ? "around"
                                           : scene.zone.boxes.empty() ? "region"
                                                                      : "boxes");
}

std::string proposed_zone(const Scene &scene, const Findings &f)
{
  const std::string general =
      "add \"region\": {\"lower\": [..], \"upper\": [..]}, or \"extent\": \"all\"";
  const double *size = scene.specimen.size.data();
  if (!f.sound({"/specimen", "/dimension"}) || !f.sound_and_given({"/discrete_zone/spacing"}) ||
      *std::min_element(size, size + scene.dimension) <= 0)
    return general;
  const double d = scene.zone.spacing,
               h = scene.far_field && f.sound({"/far_field"}) ? scene.far_field->cell_size : 4 * d;
  ZoneAround around{true, true, true, true, true, true, 12 * d};
  std::vector<ZoneBox> boxes;
  try {
    boxes = zone_boxes(scene, around, h);
  } catch (const core::KeyedError &) { // no outline: the check of the shape tells that
  }
  if (boxes.empty())
    return general;
  std::string zone;
  for (const ZoneBox &box : boxes)
    zone += fmt::format("{}{{\"lower\": {}, \"upper\": {}}}", zone.empty() ? "" : ", ",
                        text(box.lower, scene.dimension), text(box.upper, scene.dimension));
  return fmt::format("add {}{}",
                     boxes.size() == 1 ? "\"region\": " + zone : "\"boxes\": [" + zone + "]",
                     scene.far_field ? std::string()
                                     : fmt::format(" with \"far_field\": {{\"cell_size\": "
                                                   "{:.4g}}}",
                                                   h)) +
         ", which holds all cracks, notches, holes and corners with 12 spacings around them";
}
} // namespace ligament::program
