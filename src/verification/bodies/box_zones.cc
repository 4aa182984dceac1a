#include "src/verification/bodies/box_zones.h"

#include <algorithm>

namespace ligament::program
{
namespace
{
Scene boxes_2d(const Point &size, const std::vector<ZoneBox> &boxes, double poissons_ratio)
{
  Scene scene = unit_scene(2, size, poissons_ratio);
  add_far_field(scene, {35, 33, 0}, 3.1);
  set_boxes(scene, boxes);
  scene.coupling.transition_cells = 2;
  return scene;
}
} // namespace

void set_boxes(Scene &scene, const std::vector<ZoneBox> &boxes)
{
  auto &zone = scene.zone;
  zone.boxes = boxes;
  zone.lower = boxes[0].lower;
  zone.upper = boxes[0].upper;
  for (const ZoneBox &box : boxes)
    for (int c = 0; c < 3; ++c) {
      zone.lower[c] = std::min(zone.lower[c], box.lower[c]);
      zone.upper[c] = std::max(zone.upper[c], box.upper[c]);
    }
}

Scene l_shape_2d(double poissons_ratio)
{
  return boxes_2d({100, 96, 0}, {{{-32, -30, 0}, {31, 1, 0}}, {{-32, -30, 0}, {0, 30, 0}}},
                  poissons_ratio);
}

Scene two_zones_2d(double poissons_ratio)
{
  return boxes_2d({106, 60, 0}, {{{-40, -15, 0}, {-7, 15, 0}}, {{6, -15, 0}, {40, 15, 0}}},
                  poissons_ratio);
}
} // namespace ligament::program
