#include "src/scene/check_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
constexpr const char *axis_names = "xyz";

bool overlaps(const Box &a, const Box &b, int dim)
{
  for (int c = 0; c < dim; ++c)
    if (a.upper[c] <= b.lower[c] || a.lower[c] >= b.upper[c])
      return false;
  return true;
}

bool covers(const Box &outer, const Box &inner, int dim)
{
  for (int c = 0; c < dim; ++c)
    if (outer.lower[c] > inner.lower[c] || outer.upper[c] < inner.upper[c])
      return false;
  return true;
}

class CutCheck
{
public:
  CutCheck(const Scene &scene, const Box &specimen, const Layout *layout, Findings &findings)
      : scene_(scene), specimen_(specimen), layout_(layout), f_(findings)
  {
    const std::string key = "/discrete_zone/spacing";
    const bool known = scene.zone.extent != DiscreteZone::Extent::none &&
                       findings.sound_and_given({"/discrete_zone/spacing"});
    spacing_ = known ? scene.zone.spacing : 0;
  }

  void notch(const Notch &notch, const std::string &key)
  {
    for (int c = 0; c < scene_.dimension; ++c)
      if (notch.lower[c] >= notch.upper[c])
        return f_.error(key, fmt::format("the notch {} is empty in {}", key, axis_names[c]),
                        fmt::format("it goes from {} m to {} m", notch.lower[c], notch.upper[c]),
                        "give \"lower\" below \"upper\"");
    const Box box{notch.lower, notch.upper};
    if (!overlaps(box, specimen_, scene_.dimension))
      return outside("the notch " + key, key);
    if (covers(box, specimen_, scene_.dimension))
      return f_.error(key, fmt::format("the notch {} covers the whole specimen", key),
                      "nothing is left to compute", "make it smaller");
    Box inside = box;
    for (int c = 0; c < 3; ++c) {
      inside.lower[c] = std::max(inside.lower[c], specimen_.lower[c]);
      inside.upper[c] = std::min(inside.upper[c], specimen_.upper[c]);
    }
    for (int c = 0; c < scene_.dimension; ++c)
      if (const double width = notch.upper[c] - notch.lower[c]; width < spacing_ * (1 - 1e-9))
        return f_.error(key,
                        fmt::format("the notch {} is {:.4g} m wide in {}, less than a spacing", key,
                                    width, axis_names[c]),
                        fmt::format("the particles cannot show it: \"spacing\" is {} m", spacing_),
                        "widen it, make the spacing smaller, or give a crack");
    off_overlap(inside, "the notch " + key, key);
  }

  void hole(const Hole &hole, const std::string &key)
  {
    Box box;
    bool cuts_side = false;
    for (int c = 0; c < 3; ++c) {
      box.lower[c] = hole.centre[c] - hole.radius;
      box.upper[c] = hole.centre[c] + hole.radius;
      if (c < scene_.dimension && !scene_.specimen.is_periodic(c))
        cuts_side =
            cuts_side || box.lower[c] <= specimen_.lower[c] || box.upper[c] >= specimen_.upper[c];
    }
    if (!overlaps(box, specimen_, scene_.dimension))
      return outside("the hole " + key, key + "/centre");
    if (cuts_side)
      return f_.error(key, fmt::format("the hole {} cuts a side of the specimen", key),
                      "holes lie inside", "make it smaller, move it, or use a notch");
    if (hole.radius < 2 * spacing_ * (1 - 1e-9))
      return f_.error(
          key + "/radius",
          fmt::format("\"radius\" in {} is {} m, less than two spacings", key, hole.radius),
          fmt::format("the particles cannot show it: \"spacing\" is {} m", spacing_),
          fmt::format("give at least {:.4g} m, or a smaller spacing", 2 * spacing_));
    off_overlap(box, "the hole " + key, key);
  }

  void crack(const Crack &crack, const std::string &key)
  {
    const std::string points = key + "/points";
    const std::size_t n = crack.points.size();
    if (scene_.dimension == 2 ? n < 2 : n < 3)
      return f_.error(points, fmt::format("\"points\" in {} has {} points", key, n),
                      scene_.dimension == 2 ? "a crack in 2D is a line"
                                            : "a crack in 3D is a polygon",
                      scene_.dimension == 2 ? "give its two ends, and its corners between"
                                            : "give three corners or more");
    // A polygon closes itself: its last point is not its first one again.
    for (std::size_t k = scene_.dimension == 2 ? 1 : 0; k < n && n > 2; ++k)
      if (crack.points[k] == crack.points[(k + n - 1) % n])
        return f_.error(points, fmt::format("\"points\" in {} has the same point twice", key),
                        "the crack has no direction there", "remove one of them");
    if (diameter(crack.points) == 0)
      return f_.error(points, fmt::format("\"points\" in {} are all the same", key),
                      "the crack has no length", "give different points");
    if (scene_.dimension == 3 && !is_plane(crack.points))
      return f_.error(points, fmt::format("\"points\" in {} do not lie in a plane", key),
                      "a crack is a plane polygon", "split it into plane ones");
    if (scene_.dimension == 3 && !is_convex(crack.points))
      return f_.error(points, fmt::format("\"points\" in {} are no convex polygon", key),
                      "a crack is a convex polygon", "order them along its edge, or split it");
    std::vector<Point> inside;
    double length = 0;
    if (scene_.dimension == 3) {
      inside = clip(crack.points, specimen_, 3);
      length = inside.empty() ? 0 : std::sqrt(polygon_area(inside));
    }
    for (std::size_t k = 1; k < n && scene_.dimension == 2; ++k) {
      const auto part = clip({crack.points[k - 1], crack.points[k]}, specimen_, 2);
      length += part.empty() ? 0 : diameter(part);
      inside.insert(inside.end(), part.begin(), part.end());
    }
    if (length == 0)
      return outside("the crack " + key, points);
    if (length < 2 * spacing_ * (1 - 1e-9))
      return f_.error(points,
                      fmt::format("the crack {} is {:.4g} m {}, less than two spacings", key,
                                  length, scene_.dimension == 2 ? "long" : "across"),
                      fmt::format("the particles cannot show it: \"spacing\" is {} m", spacing_),
                      "make it longer, or the spacing smaller");
    in_zone(bounding_box(inside), "the crack " + key, points);
    check_path(scene_, crack, points, f_);
  }

private:
  void outside(const std::string &name, const std::string &key)
  {
    std::string extent;
    for (int c = 0; c < scene_.dimension; ++c)
      extent += fmt::format("{}{} from {} to {} m", c == 0 ? "" : ", ", axis_names[c],
                            specimen_.lower[c], specimen_.upper[c]);
    f_.error(key, name + " is outside the specimen", "the specimen extends over " + extent,
             "move it");
  }

  void in_zone(const Box &cut, const std::string &name, const std::string &key)
  {
    if (layout_)
      check_inside_zone(cut, name, key, *layout_, f_);
  }

  /// In 2D the mesh follows holes and notches, too: they may also lie beside the zone and the cells
  /// that the coupler has. Where a notch crosses the overlap, the mesh decides.
  void off_overlap(const Box &cut, const std::string &name, const std::string &key)
  {
    if (!layout_ || !layout_->coupled)
      return;
    const double margin = (scene_.coupling.transition_cells + 1) * layout_->cell_size;
    Vector<3> lower(cut.lower.data()), upper(cut.upper.data());
    const Vector<3> all = Vector<3>::Constant(margin);
    const auto zone = zone_shape<3>(scene_);
    const bool is_beside = !zone.meets(lower - all, upper + all, 0);
    const bool is_hole = name.compare(0, 8, "the hole") == 0;
    if (scene_.dimension == 3 || (is_hole && !is_beside))
      in_zone(cut, name, key);
  }

  const Scene &scene_;
  const Box &specimen_;
  const Layout *layout_;
  Findings &f_;
  double spacing_ = 0; // m; 0: not known or not used
};

double distance(const Point &a, const Point &b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}
} // namespace

void check_inside_zone(const Box &cut, const std::string &name, const std::string &key,
                       const Layout &layout, Findings &f)
{
  if (!layout.coupled)
    return;
  const std::string &place = layout.place;
  const double keep_off = layout.overlap + 2 * layout.cell_size;
  if (!layout.boxes.boxes.empty()) {
    Vector<3> lower = Vector<3>::Zero(), upper = Vector<3>::Zero();
    for (int c = 0; c < layout.dim; ++c) {
      lower[c] = cut.lower[c] - keep_off;
      upper[c] = cut.upper[c] + keep_off;
    }
    if (!layout.boxes.covers(lower, upper, 1e-9 * keep_off))
      f.error(key, fmt::format("{} is too near the edge of the discrete zone, or outside", name),
              fmt::format("it must stay {:.4g} m inside the union of {}: the overlap and "
                          "two cells",
                          keep_off, place),
              "widen the zone or move it");
    return;
  }
  for (int side = 0; side < 2 * layout.dim; ++side) {
    if (!layout.coupled_side[side])
      continue;
    const int c = side / 2;
    const double distance =
        side % 2 ? layout.zone.upper[c] - cut.upper[c] : cut.lower[c] - layout.zone.lower[c];
    if (distance >= keep_off * (1 - 1e-9))
      continue;
    f.error(key,
            fmt::format("{} {} the discrete zone at its {} end in {}", name,
                        distance < 0 ? "reaches out of" : "is too near the edge of",
                        side % 2 ? "upper" : "lower", axis_names[c]),
            fmt::format("it must stay {:.4g} m inside {} there: the overlap and two cells",
                        keep_off, place),
            fmt::format("move that side of the zone outward by {:.4g} m, or move it",
                        keep_off - distance));
    return;
  }
}

void check_cuts(const Scene &scene, const Box &specimen, const Layout *layout, Findings &f)
{
  CutCheck check(scene, specimen, layout, f);
  const Specimen &s = scene.specimen;
  const auto key = [](const char *list, std::size_t k) {
    return fmt::format("/specimen/{}/{}", list, k);
  };
  for (std::size_t k = 0; k < s.notches.size(); ++k)
    if (f.sound({key("notches", k)}))
      check.notch(s.notches[k], key("notches", k));
  for (std::size_t k = 0; k < s.cracks.size(); ++k)
    if (f.sound({key("cracks", k)}))
      check.crack(s.cracks[k], key("cracks", k));
  for (std::size_t k = 0; k < s.holes.size(); ++k)
    if (f.sound({key("holes", k)}))
      check.hole(s.holes[k], key("holes", k));
  for (std::size_t k = 0; k < s.holes.size(); ++k)
    for (std::size_t j = 0; j < k; ++j)
      if (f.sound({key("holes", k), key("holes", j)}) &&
          distance(s.holes[j].centre, s.holes[k].centre) < s.holes[j].radius + s.holes[k].radius)
        f.error(key("holes", k), fmt::format("the holes {} and {} overlap", j, k),
                "each hole has an edge of its own", "move one of them, or join them");
  if (scene.zone.extent == DiscreteZone::Extent::none && !s.cracks.empty())
    f.error("/specimen/cracks", "a mesh without particles has no cracks", "cells are whole",
            "remove the cracks, or add a discrete zone around them");
  if (scene.zone.extent == DiscreteZone::Extent::none && scene.dimension == 3 && !s.notches.empty())
    f.error("/specimen/notches", "a mesh in 3D has no notches of its own",
            "it fills boxes and prisms along z",
            "give \"slots\", which go through along z, or add a discrete zone around them");
}
} // namespace ligament::program
