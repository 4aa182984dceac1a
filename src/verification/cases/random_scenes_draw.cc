#include "src/verification/cases/random_scenes_draw.h"

#include "core/counter_random.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>
#include <vector>

namespace ligament::program
{
namespace
{
using Json = nlohmann::ordered_json;

/// Few digits: what logarithms and powers differ by from machine to machine is rounded away.
double rounded(double value)
{
  return std::strtod(fmt::format("{:.5e}", value).c_str(), nullptr);
}

/// Random numbers by the name of what is drawn.
class Draw
{
public:
  explicit Draw(int seed) : seed_(seed) {}

  double number(const char *name, double low, double high) const
  {
    return rounded(low + (high - low) * uniform(name));
  }
  /// Of even density in the logarithm.
  double magnitude(const char *name, double low, double high) const
  {
    return rounded(low * std::pow(high / low, uniform(name)));
  }
  int whole(const char *name, int low, int high) const
  {
    return low + int(uniform(name) * (high - low + 1));
  }
  bool chance(const char *name, double share) const { return uniform(name) < share; }
  /// One of the words, by their shares, which sum to 1.
  std::string word(const char *name,
                   const std::vector<std::pair<const char *, double>> &words) const
  {
    double left = uniform(name);
    for (const auto &[word, share] : words)
      if ((left -= share) < 0)
        return word;
    return words.back().first;
  }

private:
  double uniform(const char *name) const
  {
    return core::random_number(seed_, core::stream_name(name), 0);
  }

  int seed_;
};

struct Material
{
  double e, nu, rho, friction;

  double speed() const { return std::sqrt(e / rho); } // m/s, of a thin bar
  double speed_ratio() const { return std::sqrt((2 - 2 * nu) / (1 - 2 * nu)); } // P over S
};

Material draw_material(const Draw &draw)
{
  Material m;
  m.e = draw.magnitude("youngs_modulus", 1e9, 5e11);
  m.rho = draw.magnitude("density", 1000, 9000);
  m.friction = draw.chance("has_friction", 0.5) ? draw.number("friction", 0, 0.7) : 0;
  const std::string kind =
      draw.word("kind_of_nu", {{"usual", 0.75}, {"zero", 0.1}, {"high", 0.1}, {"negative", 0.05}});
  m.nu = kind == "usual"  ? draw.number("nu", 0.05, 0.42)
         : kind == "zero" ? 0
         : kind == "high" ? draw.number("nu", 0.42, 0.49)
                          : draw.number("nu", -0.2, 0);
  return m;
}

/// Everything in spacings d, the specimen centred at the origin.
struct Geometry
{
  double cell = 0; // h
  double far = 0;  // least width of the far field beside the zone, in cells
  int overlap_cells = 0;
  double width = 0, height = 0, depth = 0; // of the specimen along x, y, z
  double half_length = 0, angle = 0;       // of the crack, or the radius of a hole
  double x = 0, y = 0;                     // its middle
  struct ZoneBox
  {
    double lower[2], upper[2];
  };
  std::vector<ZoneBox> zone; // infinite: reaches through

  double keep_off() const { return (overlap_cells + 2) * cell; }
};

constexpr double through = std::numeric_limits<double>::infinity();

/// Cells and overlap; zones that are coupled on four sides are small only with small cells.
void draw_cells(const Draw &draw, const RandomScene &scene, Geometry &g)
{
  const bool small = scene.dimension == 3 || scene.zone != "band";
  g.cell = draw.number("cell_size", small ? 2.3 : 2.5,
                       scene.dimension == 3 ? 2.5
                       : small              ? 2.8
                                            : 5);
  // What closes the packing must fit in.
  const int least = std::max(2, int(std::ceil(7 / g.cell)));
  g.overlap_cells =
      draw.whole("overlap_cells", least, std::clamp(int(14 / g.cell), least, small ? 3 : 4));
}

void draw_crack(const Draw &draw, const RandomScene &scene, Geometry &g)
{
  const double degree = M_PI / 180;
  if (scene.crack == "none")
    return;
  if (scene.crack == "hole") {
    g.half_length = draw.number("radius", 2.1, 4);
    g.angle = M_PI / 2; // its extent across
    return;
  }
  g.half_length = scene.dimension == 3 ? draw.number("crack_length", 1.6, 2.2)
                                       : draw.number("crack_length", 3, 7);
  if (scene.toughness)
    return;
  const double most = scene.crack == "edge" ? 30 : scene.load == "compression" ? 75 : 60;
  g.angle = draw.chance("crack_is_straight", 0.3) ? 0 : degree * draw.number("angle", -most, most);
}

/// A band through the specimen along x.
void draw_band(const Draw &draw, const RandomScene &scene, Geometry &g)
{
  const double reach = g.half_length * std::abs(std::sin(g.angle)),
               margin = draw.number("margin", 1, scene.dimension == 3 ? 2.5 : 5);
  const double most = scene.dimension == 3 ? 3.5 : 6;
  const double cells[2] = {draw.number("far_below", 3, most), draw.number("far_above", 3, most)};
  const double far[2] = {g.cell * cells[0], g.cell * cells[1]};
  g.far = std::min(cells[0], cells[1]);
  const double zone = 2 * (g.keep_off() + reach + margin);
  g.height = far[0] + zone + far[1];
  if (scene.dimension == 3) {
    g.width = draw.number("width", 7, 9);
    g.depth = draw.number("depth", 5, 6);
  } else {
    const double filled = 0.87 * draw.number("particles", 700, 2000) / g.height;
    g.width = std::max(std::clamp(filled, 18., 44.), 3.5 * g.half_length);
  }
  const double begin = far[0] - g.height / 2;
  g.zone = {{{-through, begin}, {through, begin + zone}}};
  g.y = begin + zone / 2 + margin * draw.number("crack_y", -0.9, 0.9);
  if (scene.crack == "edge") {
    const double sign = draw.chance("crack_at_right", 0.5) ? 1 : -1;
    g.x = sign * (g.width / 2 - g.half_length * std::cos(g.angle));
  } else
    g.x = scene.toughness ? 0 : g.width * draw.number("crack_x", -0.12, 0.12);
}

/// A zone inside the specimen; an L has two arms beyond the block with the crack, and may reach the
/// left side.
void draw_inner_zone(const Draw &draw, const RandomScene &scene, Geometry &g)
{
  const double margin = draw.number("margin", 1, 3);
  const double reach[2] = {scene.crack == "hole" ? g.half_length
                                                 : g.half_length * std::cos(g.angle),
                           g.half_length * std::abs(std::sin(g.angle))};
  const bool is_l = scene.zone == "l_shape";
  const double arm[2] = {is_l ? draw.number("arm_x", 5, 10) : 0,
                         is_l ? draw.number("arm_y", 5, 10) : 0};
  const char *far_names[2][2] = {{"far_left", "far_right"}, {"far_below", "far_above"}};
  double block[2], begin[2];
  double *size[2] = {&g.width, &g.height}, *middle[2] = {&g.x, &g.y};
  for (int c = 0; c < 2; ++c) {
    block[c] = 2 * (g.keep_off() + reach[c] + margin);
    const double cells[2] = {draw.number(far_names[c][0], 3, 3.6),
                             draw.number(far_names[c][1], 3, 3.6)};
    const double low = g.cell * cells[0], high = g.cell * cells[1];
    g.far = std::min({c == 0 ? cells[0] : g.far, cells[0], cells[1]});
    *size[c] = low + block[c] + arm[c] + high;
    begin[c] = low - *size[c] / 2;
    *middle[c] = begin[c] + block[c] / 2;
  }
  Geometry::ZoneBox box{{begin[0], begin[1]}, {begin[0] + block[0] + arm[0], begin[1] + block[1]}};
  if (is_l && scene.load != "shear" && draw.chance("l_reaches_left", 0.5))
    box.lower[0] = -through;
  g.zone = {box};
  if (is_l)
    g.zone.push_back(
        {{box.lower[0], begin[1]}, {begin[0] + block[0], begin[1] + block[1] + arm[1]}});
}

Geometry draw_geometry(const Draw &draw, const RandomScene &scene)
{
  Geometry g;
  draw_cells(draw, scene, g);
  draw_crack(draw, scene, g);
  if (scene.zone == "band")
    draw_band(draw, scene, g);
  else
    draw_inner_zone(draw, scene, g);
  return g;
}

/// Stress tensor far from the crack, in the plane, for a load of 1.
struct PlaneStress
{
  double xx, yy, xy;
};

/// Largest hoop stress around a tip with these stress intensities, times sqrt(2 pi r).
double hoop_intensity(double k_1, double k_2)
{
  double largest = 0;
  for (int degrees = -90; degrees <= 90; ++degrees) {
    const double half = degrees * M_PI / 360;
    largest = std::max(largest, std::cos(half) * (k_1 * std::pow(std::cos(half), 2) -
                                                  1.5 * k_2 * std::sin(2 * half)));
  }
  return largest;
}

/// Largest tension on a face over the load: roughly, it only has to make most scenes break half
/// way. 0: no tension anywhere.
double concentration(const RandomScene &scene, const Geometry &g, const PlaneStress &s,
                     double friction)
{
  const double mean = (s.xx + s.yy) / 2, radius = std::hypot((s.xx - s.yy) / 2, s.xy);
  if (scene.crack == "hole")
    return std::max(3 * (mean + radius) - (mean - radius), 3 * (mean - radius) - (mean + radius)) *
           0.7;
  if (scene.crack == "none")
    return std::max(mean + radius, 0.);
  const double c = std::cos(g.angle), n = std::sin(g.angle);
  const double normal = s.xx * n * n - 2 * s.xy * n * c + s.yy * c * c;
  double shear = std::abs((s.yy - s.xx) * n * c + s.xy * (c * c - n * n));
  if (normal < 0)
    shear = std::max(0., shear + friction * normal);
  const double length = (scene.crack == "edge" ? 2 * 1.25 : 1) * g.half_length; // 1.12^2
  const double tip = 0.85 * std::sqrt(M_PI * length) * hoop_intensity(std::max(normal, 0.), shear);
  return std::max({tip, mean + radius, 0.});
}

Json point(const RandomScene &scene, double x, double y, double z, double d)
{
  Json p = {x * d, y * d};
  if (scene.dimension == 3)
    p.push_back(z * d);
  return p;
}

Json specimen_json(const Draw &draw, const RandomScene &scene, const Geometry &g, double d)
{
  Json json = {{"size", point(scene, g.width, g.height, g.depth, d)}};
  if (scene.dimension == 2)
    json["thickness"] = draw.magnitude("thickness", 1e-3, 1);
  const double dx = g.half_length * std::cos(g.angle), dy = g.half_length * std::sin(g.angle);
  // Cracks from a side begin outside, where rounding doesn't matter.
  const double outer = scene.crack == "edge" ? 1 + 0.5 / g.half_length : 1;
  const auto at = [&](double sign, double z) {
    const double share = sign * (sign * g.x > 0 ? outer : 1);
    return point(scene, g.x + share * dx, g.y + share * dy, z, d);
  };
  const double z = g.depth / 2;
  if (scene.crack == "hole")
    json["holes"] = Json::array({{{"centre", {g.x * d, g.y * d}}, {"radius", g.half_length * d}}});
  else if (scene.crack != "none" && scene.dimension == 2)
    json["cracks"] = Json::array({{{"points", {at(-1, 0), at(1, 0)}}}});
  else if (scene.crack != "none")
    json["cracks"] = Json::array({{{"points", {at(-1, -z), at(1, -z), at(1, z), at(-1, z)}}}});
  return json;
}

Json corner(const RandomScene &scene, const double (&at)[2], double d)
{
  Json json = Json::array();
  for (const double value : at)
    json.push_back(std::isfinite(value) ? Json(value * d) : Json());
  if (scene.dimension == 3)
    json.push_back(Json());
  return json;
}

Json zone_json(const Draw &draw, const RandomScene &scene, const Geometry &g, double d)
{
  Json boxes = Json::array();
  for (const auto &box : g.zone)
    boxes.push_back(
        {{"lower", corner(scene, box.lower, d)}, {"upper", corner(scene, box.upper, d)}});
  Json json = {{"extent", "box"}, {"packing", scene.packing}, {"spacing", d}};
  if (boxes.size() > 1)
    json["boxes"] = boxes;
  else
    json["region"] = boxes[0];
  if (scene.packing == "random") {
    json["seed"] = draw.whole("packing_seed", 1, 100000);
    if (draw.chance("has_size_ratio", 0.5))
      json["size_ratio"] = draw.number("size_ratio", 1, scene.dimension == 3 ? 2 : 5);
  } else if (draw.chance("is_turned", 0.6)) {
    if (scene.dimension == 2)
      json["orientation"] = draw.number("orientation", -M_PI / 2, M_PI / 2);
    else
      json["orientation"] = {draw.number("orientation_x", -1, 1),
                             draw.number("orientation_y", -1, 1),
                             draw.number("orientation_z", -1, 1)};
  }
  return json;
}

/// Steps: fraction of the discrete side's, and how many make one of the far field, both within
/// what the far field stands.
void draw_steps(const Draw &draw, const RandomScene &scene, const Geometry &g, const Material &m,
                Json &json)
{
  const double far = 0.6 * g.cell / std::sqrt(std::pow(m.speed_ratio(), 2) + scene.dimension - 1);
  const double most = 0.9 * far / (scene.dimension == 2 ? 0.354 : 0.316); // of the zone's steps
  double fraction = draw.number("step_fraction", 0.6, 0.95);
  fraction = std::min(fraction, rounded(most));
  json["time"]["step_fraction"] = fraction;
  json["coupling"]["step_ratio"] =
      draw.chance("has_step_ratio", 0.6)
          ? draw.whole("step_ratio", 1, std::max(1, int(most / fraction)))
          : 1;
}

bool cells_grow(const Draw &draw)
{
  return draw.chance("cells_grow", 0.2);
}

Json coupling_json(const Draw &draw, const Geometry &g)
{
  // The transition keeps off held sides.
  Json json = {{"overlap_cells", g.overlap_cells},
               {"transition_cells", cells_grow(draw) ? 1 : int(g.far) - 1}};
  if (draw.chance("other_damper", 0.2))
    json["fine_damper"] = draw.chance("no_damper", 0.5) ? 0 : 4;
  if (draw.chance("no_filter", 0.2))
    json["gap_filter"] = 0;
  return json;
}

/// How the specimen is loaded in time.
struct Loading
{
  double stress;   // Pa, at which the first face should break
  double onset;    // s, when
  double duration; // s
  PlaneStress unit;
};

Json load_json(const char *side, const char *kind, Json value, double ramp)
{
  return {{"boundary", side}, {kind, std::move(value)}, {"ramp", ramp}};
}

Json vector_of(const RandomScene &scene, Json x, Json y)
{
  Json v = {std::move(x), std::move(y)};
  if (scene.dimension == 3)
    v.push_back(Json());
  return v;
}

/// Shear by tractions on four sides, everything else by what top and bottom do.
Json loads_json(const Draw &draw, const RandomScene &scene, const Geometry &g, const Material &m,
                const Loading &l, double d)
{
  const double end = l.stress * l.duration / l.onset;
  if (scene.load == "shear") {
    const double s = draw.chance("shear_to_left", 0.5) ? -end : end;
    return {load_json("top", "traction", {s, nullptr}, l.duration),
            load_json("bottom", "traction", {-s, nullptr}, l.duration),
            load_json("right", "traction", {nullptr, s}, l.duration),
            load_json("left", "traction", {nullptr, -s}, l.duration)};
  }
  const bool one_sided = draw.chance("bottom_is_held", 0.25);
  if (scene.control == "traction") {
    Json loads = Json::array(); // one object in braces is that object to some compilers
    loads.push_back(
        load_json("top", "traction", vector_of(scene, nullptr, end * l.unit.yy), l.duration));
    loads.push_back(one_sided ? load_json("bottom", "velocity", vector_of(scene, nullptr, 0), 0)
                              : load_json("bottom", "traction",
                                          vector_of(scene, nullptr, -end * l.unit.yy), l.duration));
    return loads;
  }
  const bool velocity = scene.control == "velocity";
  const double elongation = l.stress / m.e * g.height * d; // m, at the onset
  const double value = velocity ? elongation / l.onset : elongation * l.duration / l.onset,
               ramp = velocity ? 0.15 * l.onset : l.duration;
  const bool sideways = scene.load == "mixed" || (!scene.must_hold && !scene.toughness &&
                                                  draw.chance("ends_are_gripped", 0.25));
  const auto side = [&](const char *name, double share) {
    Json x = sideways ? Json(share * value * l.unit.xy) : Json();
    return load_json(name, scene.control.c_str(), vector_of(scene, x, share * value * l.unit.yy),
                     ramp);
  };
  return {side("top", one_sided ? 1 : 0.5), side("bottom", one_sided ? 0 : -0.5)};
}

/// Component 0 becomes component 1 and the other way round.
void swap_components(Json &list)
{
  if (list.is_array() && list.size() == 2)
    std::swap(list[0], list[1]);
}

/// x and y change their roles: loads along x.
void transpose(Json &json)
{
  swap_components(json["specimen"]["size"]);
  for (const char *cuts : {"cracks", "holes"})
    if (json["specimen"].contains(cuts))
      for (auto &cut : json["specimen"][cuts]) {
        if (cut.contains("centre"))
          swap_components(cut["centre"]);
        if (cut.contains("points"))
          for (auto &p : cut["points"])
            swap_components(p);
      }
  auto &zone = json["discrete_zone"];
  const auto swap_corners = [](Json &box) {
    swap_components(box["lower"]);
    swap_components(box["upper"]);
  };
  if (zone.contains("region"))
    swap_corners(zone["region"]);
  if (zone.contains("boxes"))
    for (auto &box : zone["boxes"])
      swap_corners(box);
  const std::pair<const char *, const char *> sides[] = {
      {"top", "right"}, {"bottom", "left"}, {"right", "top"}, {"left", "bottom"}};
  for (auto &load : json["loads"]) {
    const std::string side = load["boundary"];
    for (const auto &[from, to] : sides)
      if (side == from)
        load["boundary"] = to;
    for (const char *kind : {"velocity", "displacement", "traction"})
      if (load.contains(kind))
        swap_components(load[kind]);
  }
}

void round_numbers(Json &json)
{
  if (json.is_number_float())
    json = rounded(json.get<double>());
  else if (json.is_structured())
    for (auto &value : json)
      round_numbers(value);
}

/// What kind of scene it is.
void draw_kind(const Draw &draw, RandomScene &s)
{
  s.dimension = draw.chance("is_3d", 0.12) ? 3 : 2;
  s.packing = s.dimension == 2
                  ? draw.word("packing", {{"hexagonal", 0.35}, {"square", 0.25}, {"random", 0.4}})
                  : draw.word("packing", {{"fcc", 0.4}, {"simple_cubic", 0.2}, {"random", 0.4}});
  s.load = draw.word("load",
                     {{"tension", 0.45}, {"mixed", 0.18}, {"compression", 0.22}, {"shear", 0.15}});
  if (s.dimension == 3 && s.load == "shear")
    s.load = "mixed";
  s.zone = s.dimension == 3 ? "band"
           : s.load == "shear"
               ? draw.word("zone_in_shear", {{"box", 0.7}, {"l_shape", 0.3}})
               : draw.word("zone", {{"band", 0.6}, {"box", 0.22}, {"l_shape", 0.18}});
  s.crack = draw.word("crack", {{"centre", 0.55}, {"edge", 0.25}, {"hole", 0.2}});
  if (s.load == "compression")
    s.crack = draw.chance("has_no_crack", 0.5) ? "none" : "centre";
  else if ((s.crack == "edge" && s.zone != "band") || (s.crack == "hole" && s.dimension == 3))
    s.crack = "centre";
  s.control =
      s.load == "shear" ? "traction"
      : s.load == "mixed"
          ? "velocity"
          : draw.word("control", {{"velocity", 0.7}, {"displacement", 0.12}, {"traction", 0.18}});
  s.damping = draw.word("damping", {{"mass", 0.6}, {"local", 0.15}, {"none", 0.25}});
  s.must_hold = s.crack == "none";
  if (s.dimension == 2 && s.zone == "band" && s.load == "tension" && s.crack == "centre" &&
      s.control == "velocity" && draw.chance("has_formula", 0.5))
    s.toughness.emplace();
}

Loading draw_loading(const Draw &draw, const RandomScene &s, const Geometry &g, const Material &m,
                     double d)
{
  Loading l;
  const double way = std::max(g.width, g.height) * d / m.speed(); // s, of a wave
  const double sideways = draw.number("sideways", -0.5, 0.5);
  l.unit = s.load == "tension" ? PlaneStress{0, 1, 0}
           : s.load == "mixed" ? PlaneStress{0, 1, sideways}
           : s.load == "shear" ? PlaneStress{0, 0, 1}
                               : PlaneStress{0, -1, 0};
  l.stress = m.e * draw.magnitude("strain", 1e-5, 1e-3);
  l.onset =
      way * (s.dimension == 3 ? draw.number("slowness", 5, 7) : draw.number("slowness", 9, 15));
  l.duration = l.onset * (s.must_hold ? 1 : s.load == "compression" && s.dimension == 2 ? 2 : 1.5);
  return l;
}

/// Strength or toughness.
Json fracture_json(const Draw &draw, RandomScene &s, const Geometry &g, const Material &m,
                   const Loading &l, double d)
{
  const double k = concentration(s, g, l.unit, m.friction);
  const double strength = s.must_hold ? l.stress / draw.number("over_strength", 3, 13)
                          : k > 0     ? k * l.stress
                                      : l.stress / 2;
  if (!s.toughness)
    return {{"criterion", "maximum_tension"}, {"strength", strength}};
  s.toughness->half_length = g.half_length * d;
  s.toughness->width = g.width * d;
  s.toughness->toughness = rounded(strength * std::sqrt(d) / 0.85);
  return {{"criterion", "maximum_tension"}, {"toughness", s.toughness->toughness}};
}

Json damping_json(const Draw &draw, RandomScene &s, const Geometry &g, const Material &m,
                  const Loading &l, double d)
{
  if (s.damping == "local")
    return {{"local", draw.number("local_damping", 0.1, 0.7)}};
  if (s.damping == "none")
    return Json::object();
  const double length = g.height * d,
               rate = draw.number("mass_damping", 0.5, 1.5) * M_PI * m.speed() / length;
  if (s.toughness)
    s.toughness->drag = m.rho * rate * l.stress / m.e / l.onset * length * length / 8;
  return {{"mass", rate}};
}

Json far_json(const Draw &draw, const Geometry &g, double d)
{
  Json json = {{"cell_size", g.cell * d}};
  if (cells_grow(draw)) {
    json["levels"] = 1;
    json["fine_cells"] = g.overlap_cells + 1;
    if (draw.chance("cells_grow_smoothly", 0.5))
      json["growth"] = 1.3;
  }
  return json;
}
} // namespace

RandomScene draw_scene(int seed)
{
  const Draw draw(seed);
  RandomScene s;
  s.seed = seed;
  draw_kind(draw, s);
  const double d = draw.magnitude("spacing", 1e-5, 1e-1);
  const Material m = draw_material(draw);
  const Geometry g = draw_geometry(draw, s);
  const Loading l = draw_loading(draw, s, g, m, d);

  Json &json = s.json;
  json = {{"title", fmt::format("Random scene {}", seed)}, {"dimension", s.dimension}};
  if (s.dimension == 2)
    json["plane"] = draw.chance("plane_stress", 0.4) ? "stress" : "strain";
  json["specimen"] = specimen_json(draw, s, g, d);
  json["material"] = {{"youngs_modulus", m.e},
                      {"poissons_ratio", m.nu},
                      {"density", m.rho},
                      {"friction", m.friction},
                      {"fracture", fracture_json(draw, s, g, m, l, d)}};
  json["discrete_zone"] = zone_json(draw, s, g, d);
  json["far_field"] = far_json(draw, g, d);
  json["coupling"] = coupling_json(draw, g);
  json["damping"] = damping_json(draw, s, g, m, l, d);
  json["loads"] = loads_json(draw, s, g, m, l, d);
  json["time"] = {{"duration", l.duration}, {"stop_when", s.must_hold ? "end" : "specimen_broken"}};
  draw_steps(draw, s, g, m, json);
  json["output"] = {{"history_interval", l.duration / 400}};
  if (s.dimension == 2 && draw.chance("loads_along_x", 0.3))
    transpose(json);
  round_numbers(json);
  return s;
}
} // namespace ligament::program
