#include "src/scene/body_file.h"
#include "src/scene/body_shape.h"
#include "src/scene/check_scene.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>

namespace ligament::program
{
namespace
{
/// The axis along which a direction lies; -1: none.
int axis_of(const Point &direction, int dim)
{
  int axis = -1;
  for (int c = 0; c < dim; ++c)
    if (direction[c] != 0) {
      if (axis >= 0)
        return -1;
      axis = c;
    }
  return axis;
}

/// A cut as the rectangles see it: the box around it.
struct Cut
{
  std::string key;
  Box box;
  bool is_flat;            // a crack
  bool is_slanted = false; // its flanks lie along no axis
  std::string side = {};   // name of its flanks
};

/// It goes on outward by its width, and through along z.
Box box_around(const Slot &slot, const Specimen &specimen)
{
  Box box = bounding_box({slot.from, slot.to});
  for (int c = 0; c < 2; ++c) {
    const double beyond = slot.from[c] < slot.to[c] ? -1 : slot.from[c] > slot.to[c] ? 1 : 0;
    box.lower[c] -= beyond < 0 ? slot.width : beyond == 0 ? slot.width / 2 : 0;
    box.upper[c] += beyond > 0 ? slot.width : beyond == 0 ? slot.width / 2 : 0;
  }
  box.lower[2] = specimen.lower(2);
  box.upper[2] = specimen.upper(2);
  return box;
}

std::vector<Cut> cuts_of(const Scene &scene, const Findings &f)
{
  std::vector<Cut> cuts;
  const Specimen &s = scene.specimen;
  for (std::size_t k = 0; k < s.cracks.size(); ++k)
    if (const auto key = fmt::format("/specimen/cracks/{}", k);
        f.sound({key}) && !s.cracks[k].points.empty())
      cuts.push_back({key, bounding_box(s.cracks[k].points), true});
  for (std::size_t k = 0; k < s.notches.size(); ++k)
    cuts.push_back(
        {fmt::format("/specimen/notches/{}", k), {s.notches[k].lower, s.notches[k].upper}, false});
  for (std::size_t k = 0; k < s.slots.size(); ++k) {
    const Slot &slot = s.slots[k];
    cuts.push_back({fmt::format("/specimen/slots/{}", k), box_around(slot, s), false,
                    slot.from[0] != slot.to[0] && slot.from[1] != slot.to[1], slot.side});
  }
  return cuts;
}

/// A place on the outer rectangle, in the middle of the third axis, that lies outside the body
/// without its cuts.
std::optional<Point> place_outside(const Scene &scene, const GaugeParameters &g, int along,
                                   int across)
{
  Specimen whole = scene.specimen;
  whole.slots.clear();
  whole.cutouts.clear();
  whole.notches.clear();
  whole.holes.clear();
  const BodyTest body(whole, scene.dimension);
  constexpr int n = 64;
  for (const auto &[way, other] : {std::pair(along, across), std::pair(across, along)})
    for (const double end : {g.lower[other], g.upper[other]})
      for (int k = 0; k <= n; ++k) {
        Point x{};
        for (int c = 0; c < 3; ++c)
          x[c] = (whole.lower(c) + whole.upper(c)) / 2;
        x[way] = g.lower[way] + (g.upper[way] - g.lower[way]) * k / n;
        x[other] = end;
        if (!body.contains(x))
          return x;
      }
  return std::nullopt;
}

/// The inclusions as the rectangles see them: in their plane, whatever the third coordinate.
class OtherMaterials
{
public:
  OtherMaterials(const Scene &scene, int along, int across)
      : scene_(scene), along_(along), across_(across)
  {
  }

  /// An inclusion; without a key: none.
  struct Found
  {
    std::string key;
    bool differs = false; // its elastic constants, from those of /material
  };
  /// That of a place: later ones lie over earlier ones.
  Found at(const Point &x) const
  {
    for (std::size_t k = scene_.inclusions.size(); k-- > 0;)
      if (meets(scene_.inclusions[k], x, x))
        return found(k);
    return {};
  }
  /// One that differs and has a part of the rectangle.
  Found inside(const Point &lower, const Point &upper) const
  {
    for (std::size_t k = 0; k < scene_.inclusions.size(); ++k)
      if (found(k).differs && meets(scene_.inclusions[k], lower, upper))
        return found(k);
    return {};
  }

private:
  Found found(std::size_t k) const
  {
    return {fmt::format("/inclusions/{}", k),
            have_other_constants(scene_.inclusions[k].material, scene_.material)};
  }
  bool meets(const Inclusion &inclusion, const Point &lower, const Point &upper) const
  {
    for (const Hole &ball : inclusion.balls) {
      double squared = 0;
      for (const int c : {along_, across_})
        squared += std::pow(std::clamp(ball.centre[c], lower[c], upper[c]) - ball.centre[c], 2);
      if (squared < ball.radius * ball.radius)
        return true;
    }
    return std::any_of(inclusion.boxes.begin(), inclusion.boxes.end(), [&](const Notch &box) {
      return box.lower[along_] < upper[along_] && box.upper[along_] > lower[along_] &&
             box.lower[across_] < upper[across_] && box.upper[across_] > lower[across_];
    });
  }

  const Scene &scene_;
  int along_, across_;
};

std::vector<Cut> openings_of(const Specimen &s)
{
  std::vector<Cut> openings;
  for (std::size_t k = 0; k < s.cutouts.size(); ++k) {
    Specimen one;
    one.outline = s.cutouts[k].outline;
    enclose_body(one, 2);
    Box box{one.lower(), one.upper()};
    box.lower[2] = s.lower(2);
    box.upper[2] = s.upper(2);
    openings.push_back({fmt::format("/specimen/cutouts/{}", k), box, false});
  }
  for (const core::Polygon &polygon : s.body ? s.body->polygons : std::vector<core::Polygon>())
    if (core::signed_area(polygon) < 0) {
      Eigen::AlignedBox2d box;
      for (const auto &corner : polygon)
        box.extend(corner.place);
      openings.push_back(
          {"a hole of /specimen/file",
           {{box.min()[0], box.min()[1], s.lower(2)}, {box.max()[0], box.max()[1], s.upper(2)}},
           false});
    }
  return openings;
}
} // namespace

void check_j_integral(const Scene &scene, const GaugeParameters &g, const Box &specimen,
                      const std::string &key, Findings &f)
{
  const int dim = scene.dimension;
  const int along = axis_of(g.direction, dim);
  if (along < 0)
    return f.error(key + "/direction", fmt::format("\"direction\" in {} lies along no axis", key),
                   "the crack's faces must be parallel to an axis, so that they add nothing",
                   "give the direction in which the crack grows: [1, 0] or [-1, 0], for example");
  int across = dim == 2 ? 1 - along : axis_of(g.normal, dim);
  if (across < 0 || across == along)
    return f.error(key + "/normal", fmt::format("\"normal\" in {} is no other axis", key),
                   "it says across which axis the crack's faces lie",
                   "give it: [0, 1, 0], for example");
  const double sign = g.direction[along] > 0 ? 1 : -1;
  if (scene.is_viscous())
    return f.error(key + "/kind", fmt::format("\"kind\" in {} is \"j_integral\"", key),
                   "it takes strains for elastic ones, and this material creeps", "remove it");
  if (scene.flows())
    f.warning(key + "/kind", fmt::format("\"kind\" in {} is \"j_integral\"", key),
              "it takes strains for elastic ones: what flows between its rectangles is wrong",
              "keep them around all that flows, and compare rectangles of other sizes");
  const auto axis_name = [](int c) { return "xyz"[c]; };
  // What lies between the rectangles takes part: some particles, some cells.
  const bool particles = scene.zone.extent != DiscreteZone::Extent::none;
  const double width =
      particles ? 4 * scene.zone.spacing : 2 * scene.far_field.value_or(FarField{0}).cell_size;
  for (const int c : {along, across}) {
    if (!(g.lower[c] > specimen.lower[c]) || !(g.upper[c] < specimen.upper[c]))
      return f.error(
          key,
          fmt::format("the outer rectangle of {} reaches the specimen's side in {}", key,
                      axis_name(c)),
          fmt::format("it goes from {} m to {} m, the specimen from {} m to {} m; a side "
                      "between the rectangles would have to be added",
                      g.lower[c], g.upper[c], specimen.lower[c], specimen.upper[c]),
          "make it smaller, or move it");
    if (!(g.inner_lower[c] < g.inner_upper[c]) ||
        g.inner_lower[c] - g.lower[c] < width * (1 - 1e-9) ||
        g.upper[c] - g.inner_upper[c] < width * (1 - 1e-9))
      return f.error(
          key,
          fmt::format("the inner rectangle of {} is empty or too near the outer one in {}", key,
                      axis_name(c)),
          fmt::format("it goes from {} m to {} m, the outer one from {} m to {} m; between "
                      "them must lie {}: {:.4g} m",
                      g.inner_lower[c], g.inner_upper[c], g.lower[c], g.upper[c],
                      particles ? "four spacings" : "two cells", width),
          "move \"inner_lower\" and \"inner_upper\" inward, or \"lower\" and \"upper\" outward");
  }
  if (scene.specimen.has_own_box() && f.sound({"/specimen"}))
    if (const auto x = place_outside(scene, g, along, across))
      return f.error(key, fmt::format("the outer rectangle of {} leaves the specimen", key),
                     fmt::format("({:.6g}, {:.6g}, {:.6g}) m lies outside; a side between the "
                                 "rectangles would have to be added",
                                 (*x)[0], (*x)[1], (*x)[2]),
                     "make it smaller, or move it");
  for (std::size_t k = 0; k < scene.specimen.holes.size() && particles; ++k) {
    const Hole &hole = scene.specimen.holes[k];
    double squared = 0;
    for (const int c : {along, across}) {
      const double nearest = std::clamp(hole.centre[c], g.lower[c], g.upper[c]) - hole.centre[c];
      squared += nearest * nearest;
    }
    if (squared < hole.radius * hole.radius)
      return f.error(
          key, fmt::format("the outer rectangle of {} meets the hole /specimen/holes/{}", key, k),
          "its rim would have to be added", "make the rectangle smaller, or move it");
  }
  for (const Cut &opening : particles ? openings_of(scene.specimen) : std::vector<Cut>()) {
    bool meets = true;
    for (const int c : {along, across})
      meets &= opening.box.lower[c] < g.upper[c] && opening.box.upper[c] > g.lower[c];
    if (meets)
      return f.error(key, fmt::format("the outer rectangle of {} meets {}", key, opening.key),
                     "its rim would have to be added", "make the rectangle smaller, or move it");
  }
  bool has_tip = false;
  for (const Cut &cut : particles ? cuts_of(scene, f) : std::vector<Cut>()) {
    const double low = cut.box.lower[across], high = cut.box.upper[across];
    const double front = sign > 0 ? cut.box.upper[along] : cut.box.lower[along],
                 back = sign > 0 ? cut.box.lower[along] : cut.box.upper[along];
    if (high < g.lower[across] || low > g.upper[across] || cut.box.upper[along] < g.lower[along] ||
        cut.box.lower[along] > g.upper[along])
      continue;
    const bool parallel =
        !cut.is_slanted &&
        (!cut.is_flat || high - low <= 1e-6 * (g.upper[across] - g.lower[across]));
    const bool in_inner = front > g.inner_lower[along] && front < g.inner_upper[along] &&
                          low > g.inner_lower[across] && high < g.inner_upper[across];
    const bool leaves = sign > 0 ? back <= g.lower[along] : back >= g.upper[along];
    if (!parallel || !in_inner || !leaves)
      return f.error(
          key,
          fmt::format("{} does not cross the rectangles of {} as a crack with its tip in them",
                      cut.key, key),
          fmt::format("J is that of one tip: the cut comes from {} {}, along the direction, "
                      "and ends inside the inner rectangle",
                      sign > 0 ? "below" : "above", axis_name(along)),
          "move the rectangles around one tip, or turn \"direction\" round");
    const int third = 3 - along - across;
    if (const double rounding = 1e-9 * (specimen.upper[third] - specimen.lower[third]);
        dim == 3 && (cut.box.lower[third] > specimen.lower[third] + rounding ||
                     cut.box.upper[third] < specimen.upper[third] - rounding))
      return f.error(
          key,
          fmt::format("{} goes over a part of the specimen's {} only", cut.key, axis_name(third)),
          fmt::format("{} takes the mean over all of it, of a front that goes through", key),
          "let the cut go through, or remove the gauge");
    for (std::size_t l = 0; l < scene.loads.size() && !cut.side.empty(); ++l)
      if (scene.loads[l].side == cut.side)
        return f.error(key,
                       fmt::format("/loads/{} acts on the flanks of {}, which cross the rectangles "
                                   "of {}",
                                   l, cut.key, key),
                       "J is known where the flanks are free: the load's part would have to be "
                       "added",
                       "remove the gauge, or load another side");
    if (!f.sound({"/inclusions", "/material"}))
      return;
    const OtherMaterials others(scene, along, across);
    Point ahead{};
    ahead[along] = front + sign * scene.zone.spacing / 2;
    ahead[across] = (low + high) / 2;
    if (const auto at_tip = others.at(ahead); at_tip.differs)
      return f.error(
          key,
          fmt::format("the tip of {} lies in {}, and {} takes it for one in /material", cut.key,
                      at_tip.key, key),
          "what its rectangles see from outside is the tip and the surface of the inclusion "
          "together, from which E' of neither material makes the stress intensity of the tip",
          "let /material be what lies within the rectangles, and make that around them an "
          "inclusion, or remove the gauge");
    if (const auto other = others.inside(g.inner_lower, g.inner_upper); other.differs)
      f.warning(key, fmt::format("a part of {} lies inside the rectangles of {}", other.key, key),
                "they see its surface together with the tip: J is no longer that of the tip alone",
                "make the rectangles smaller, or take J for that of both");
    has_tip = true;
  }
  if (!has_tip)
    f.error(key, fmt::format("the inner rectangle of {} contains no tip", key),
            particles ? "no crack and no notch ends in it"
                      : "pure finite elements have no cracks or notches",
            "move it around the tip of a crack");
}
} // namespace ligament::program
