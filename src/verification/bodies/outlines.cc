#include "src/verification/bodies/outlines.h"

#include "src/scene/body_shape.h"

namespace ligament::program
{
std::vector<OutlineCorner> circle(const Point &centre, double radius, const std::string &side)
{
  OutlineCorner corner;
  corner.at = {centre[0] + radius, centre[1], 0};
  corner.centre[0] = centre[0];
  corner.centre[1] = centre[1];
  corner.side = side;
  return {corner};
}

Scene outlined_scene(const std::vector<OutlineCorner> &outline,
                     const std::vector<std::vector<OutlineCorner>> &openings, double poissons_ratio)
{
  Scene scene = unit_scene(2, {0, 0, 0}, poissons_ratio);
  scene.specimen.outline = outline;
  for (const auto &opening : openings)
    scene.specimen.cutouts.push_back({opening, "rim"});
  enclose_body(scene.specimen, 2);
  return scene;
}

void couple(Scene &scene, const Point &lower, const Point &upper)
{
  add_far_field(scene, {0, 0, 0}, 3.1);
  scene.zone.lower = lower;
  scene.zone.upper = upper;
  scene.coupling.transition_cells = 2;
}
} // namespace ligament::program
