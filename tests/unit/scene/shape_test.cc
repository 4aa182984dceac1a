// Bodies of any outline, from the keys of a scene: areas, sides, names, zones around them.
#include "src/scene/body_shape.h"
#include "src/scene/geometry.h"
#include "src/scene/read_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <random>
#include <regex>

namespace
{
using namespace ligament;
using namespace ligament::program;

const std::string rest = R"(,
  "material": {"youngs_modulus": 1e9, "poissons_ratio": 0.2, "density": 1000},
  "time": {"duration": 1})";

Scene scene_of(const std::string &specimen, const std::string &more)
{
  const ReadResult result =
      parse_scene(R"({"specimen": )" + specimen + rest + more + "}", "scene.json", {});
  for (const auto &error : result.errors)
    ADD_FAILURE() << error.message << ": " << error.reason;
  return result.scene.value();
}

const std::string discrete =
    R"(, "discrete_zone": {"extent": "all", "packing": "hexagonal", "spacing": 0.1}, "far_field": "none")";

double area(const std::vector<core::Polygon> &polygons)
{
  double sum = 0;
  for (const auto &polygon : polygons)
    sum += core::signed_area(polygon);
  return sum;
}

std::map<int, double> lengths(const std::vector<core::Polygon> &polygons)
{
  std::map<int, double> sum;
  for (const auto &polygon : polygons)
    for (std::size_t k = 0; k < polygon.size(); ++k)
      sum[polygon[k].boundary] +=
          (polygon[(k + 1) % polygon.size()].place - polygon[k].place).norm();
  return sum;
}

// What cuts take does not depend on the unit of length: bodies of some nanometres have them, too.
TEST(Shapes, CutsTakeTheSameShareAtAnyScale)
{
  const auto left = [](double unit) {
    Specimen specimen;
    for (const auto &[x, y] : {std::pair(0., 0.), {40., 0.}, {40., 30.}, {0., 30.}})
      specimen.outline.push_back({{unit * x, unit * y, 0}, {}, false, ""});
    Cutout cutout;
    for (const auto &[x, y] : {std::pair(10., 10.), {14., 10.}, {14., 13.}, {10., 13.}})
      cutout.outline.push_back({{unit * x, unit * y, 0}, {}, false, ""});
    specimen.cutouts.push_back(cutout);
    Slot slot;
    slot.from = {30 * unit, 0, 0};
    slot.to = {30 * unit, 10 * unit, 0};
    slot.width = unit;
    specimen.slots.push_back(slot);
    enclose_body(specimen, 2);
    return area(outline_of(specimen, 2, unit, true)) / (unit * unit);
  };
  for (const double unit : {1., 1e-9, 1e-3, 1e6})
    EXPECT_NEAR(left(unit), 40 * 30 - 12 - 10, 1e-6) << unit;
}

// A slot across a slanted side, one with a round tip, a hole that opens a side.
const std::string odd = R"({
  "outline": [{"at": [0, 0]}, {"at": [0, 30]}, {"at": [30, 40], "side": "roof"}, {"at": [60, 30], "side": "roof"}, {"at": [60, 0]}],
  "slots": [{"from": [30, 0], "to": [30, 12], "width": 2, "tip": "round", "side": "slot"},
            {"from": [15, 35], "to": [18, 26], "width": 1.5, "tip": "v", "tip_angle": "60 deg", "side": "wedge"}],
  "cutouts": [{"outline": [{"at": [62, 15], "centre": [60, 15]}], "side": "bite"},
              {"outline": [{"at": [40, 20]}, {"at": [50, 20]}, {"at": [45, 25], "side": "flank"}], "side": "pin"}]
})";

TEST(Shape, CutsAndNamesComeThrough)
{
  const Scene scene = scene_of(odd, discrete);
  const auto polygons = outline_of(scene.specimen, 2, 0.02, true);
  const double whole = 60 * 35, round_slot = 2 * 11 + M_PI / 2, bite = M_PI * 4 / 2, pin = 25;
  // Of the wedge all that lies below the roof, whose slope along its mouth is 1 in 3: it begins on
  // it in the middle, so what the slant takes on one flank it gives on the other.
  const double length = std::hypot(3., 9.), tip = 0.75 / std::tan(M_PI / 6);
  const double wedge = 1.5 * (length - tip) + 0.75 * tip;
  EXPECT_NEAR(area(polygons), whole - round_slot - bite - pin - wedge, 1e-2);
  const auto names = side_names_of(scene.specimen, 2);
  const auto length_of = [&, sides = lengths(polygons)](const std::string &name) {
    return sides.at(int(std::find(names.begin(), names.end(), name) - names.begin()));
  };
  EXPECT_NEAR(length_of("left"), 30, 1e-9);
  EXPECT_NEAR(length_of("right"), 30 - 4, 1e-3);
  EXPECT_NEAR(length_of("bottom"), 60 - 2, 1e-9);
  EXPECT_NEAR(length_of("slot"), 22 + M_PI, 1e-3);
  EXPECT_NEAR(length_of("bite"), 2 * M_PI, 1e-2);
  EXPECT_NEAR(length_of("pin"), 10 + std::hypot(5., 5.), 1e-9);
  EXPECT_NEAR(length_of("flank"), std::hypot(5., 5.), 1e-9);
  EXPECT_NEAR(length_of("roof"), 2 * std::hypot(30., 10.) - 1.5, 1e-3);
  EXPECT_EQ(scene.specimen.lower(0), 0);
  EXPECT_EQ(scene.specimen.upper(1), 40);
}

// Both ends of a prism are the outline without its openings, and parts of them are parts of that.
TEST(Shape, EndsOfPrismsHaveTheAreaOfTheOutline)
{
  std::string prism = std::regex_replace(odd, std::regex(R"((\[\d+, \d+)\])"), "$1, 0]");
  prism.insert(prism.rfind('}'), R"(, "thickness": 8)");
  const Scene scene = scene_of(
      prism,
      R"(, "dimension": 3, "discrete_zone": {"extent": "all", "packing": "fcc", "spacing": 1}, "far_field": "none")");
  const double side = 60. / 400, whole = area(outline_of(scene.specimen, 3, side, true));
  for (const int boundary : {4, 5}) {
    double sum = 0, below = 0;
    for (const auto &face : faces_of<3>(scene.specimen, boundary)) {
      sum += core::face_area<3>(face);
      const auto part = core::Part<3>::box({-100, -100, -100}, {100, 11, 100});
      below += core::face_area<3>(part.clip(face));
    }
    EXPECT_NEAR(sum / whole, 1, 1e-9) << boundary;
    EXPECT_NEAR(below / (60 * 11 - 2 * 10 - M_PI / 2), 1, 1e-3) << boundary; // beside the slot
  }
}

// Turned and mirrored bodies have the same area; the order of corners counts nothing.
TEST(Shape, RandomCutsTakeTheirAreaWhateverTheirOrder)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  for (int k = 0; k < 30; ++k) {
    Specimen s, r;
    const auto corner = [](double x, double y) {
      OutlineCorner c;
      c.at = {x, y, 0};
      return c;
    };
    s.outline = {corner(0, 0), corner(40, 0), corner(40, 30), corner(0, 30)};
    std::vector<double> areas;
    for (int n = 0; n < 4; ++n) {
      Cutout cut;
      const double x = 5 + 10 * n, y = 8 + 14 * share(random), size = 1 + 2.5 * share(random);
      const int corners = 3 + int(5 * share(random));
      for (int c = 0; c < corners; ++c)
        cut.outline.push_back(corner(x + size * std::cos(2 * M_PI * c / corners),
                                     y + size * std::sin(2 * M_PI * c / corners)));
      areas.push_back(corners / 2. * size * size * std::sin(2 * M_PI / corners));
      if (share(random) < 0.5)
        std::reverse(cut.outline.begin(), cut.outline.end());
      s.cutouts.push_back(cut);
    }
    double expected = 1200;
    for (const double a : areas)
      expected -= a;
    // Wherever it lies: at coordinates of a map, too.
    const double away = k % 3 == 0 ? 1e8 : 0;
    for (auto *outline : {&s.outline, &s.cutouts[0].outline, &s.cutouts[1].outline,
                          &s.cutouts[2].outline, &s.cutouts[3].outline})
      for (OutlineCorner &c : *outline)
        c.at[0] += away;
    enclose_body(s, 2);
    r = s;
    std::reverse(r.outline.begin(), r.outline.end());
    std::reverse(r.cutouts.begin(), r.cutouts.end());
    for (const Specimen *one : {&s, &r})
      EXPECT_NEAR(area(outline_of(*one, 2, 0.1, true)), expected, away > 0 ? 1e-5 : 1e-9);
  }
}

TEST(Shape, ArcsBoundTheBox)
{
  const Scene half = scene_of(
      R"({"outline": [{"at": [-3, 0], "centre": [0, 0], "side": "dome"}, {"at": [3, 0]}]})",
      discrete);
  EXPECT_NEAR(half.specimen.upper(1), 3, 1e-12);
  EXPECT_NEAR(half.specimen.lower(1), 0, 1e-12);
  EXPECT_NEAR(area(outline_of(half.specimen, 2, 0.1, true)), 9 * M_PI / 2, 1e-12);
}

TEST(Shape, SurfacesOfTrianglesAreRead)
{
  const char *file = "tetrahedron.stl";
  std::ofstream stl(file);
  const double x[4][3] = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const auto write = [&](int n) {
    stl << "solid t\n";
    for (int f = 0; f < n; ++f) {
      stl << "facet normal 0 0 0\nouter loop\n";
      for (const int v : faces[f])
        stl << "vertex " << x[v][0] << ' ' << x[v][1] << ' ' << x[v][2] << '\n';
      stl << "endloop\nendfacet\n";
    }
    stl << "endsolid t\n";
    stl.close();
  };
  write(4);
  const std::string scene =
      R"({"dimension": 3, "specimen": {"file": "tetrahedron.stl"})" + rest +
      R"(, "discrete_zone": {"extent": "all", "packing": "fcc", "spacing": 0.2}, "far_field": "none"})";
  const ReadResult good = parse_scene(scene, "scene.json", {});
  ASSERT_TRUE(good.scene) << good.errors[0].message << good.errors[0].reason;
  EXPECT_NEAR(solid_of<3>(good.scene->specimen, 0.1)->volume(), 8. / 6, 1e-6);
  // What lies on the box around it is that side's: three of the four triangles.
  const SurfaceFaces<3> surface(good.scene->specimen);
  for (int side = 0; side < 6; ++side)
    EXPECT_EQ(surface.of(side).size(), side % 2 ? 0u : 1u) << side;
  const auto loaded = [&](const char *side) {
    return parse_scene(
        scene, "scene.json",
        {R"(/loads=[{"boundary": ")" + std::string(side) + R"(", "displacement": [0, 0, 0]}])"});
  };
  EXPECT_TRUE(loaded("bottom").scene);
  ASSERT_EQ(loaded("top").errors.size(), 1u);
  EXPECT_NE(loaded("top").errors[0].remedy.find("name a part of the surface"), std::string::npos);
  // A run is resumed from the resolved scene in its own folder.
  const ReadResult again = parse_scene(good.resolved.dump(), "elsewhere/scene.json", {});
  EXPECT_TRUE(again.scene) << again.errors[0].message;
  stl.open(file);
  write(3);
  const ReadResult open = parse_scene(scene, "scene.json", {});
  ASSERT_EQ(open.errors.size(), 1u);
  EXPECT_NE(open.errors[0].reason.find("gap"), std::string::npos) << open.errors[0].reason;
  std::remove(file);
}

TEST(Shape, ZonesFollowWhatTheyAreAround)
{
  const std::string far = R"(, "far_field": {"cell_size": 0.4}, )";
  const auto zone = [&](const std::string &around) {
    return far + R"("discrete_zone": {"packing": "hexagonal", "spacing": 0.1, "around": {)" +
           around + R"(, "margin": 2}})";
  };
  const Scene corner = scene_of(
      R"({"outline": [{"at": [0, 0]}, {"at": [40, 0]}, {"at": [40, 20]}, {"at": [20, 20]}, {"at": [20, 40]}, {"at": [0, 40]}]})",
      zone("\"corners\": true"));
  EXPECT_NEAR(corner.zone.lower[0], 20 - 2 - 1.2, 1e-9);
  EXPECT_NEAR(corner.zone.upper[1], 20 + 2 + 1.2, 1e-9);
  const Scene edge =
      scene_of(R"({"size": [40, 40], "cracks": [{"points": [[-20, 0], [-10, 0], [-8, 3]]}]})",
               zone("\"cracks\": true"));
  EXPECT_LT(edge.zone.lower[0], -20); // reaches through
  EXPECT_NEAR(edge.zone.upper[0], -8 + 3.2, 1e-9);
  EXPECT_NEAR(edge.zone.upper[1], 3 + 3.2, 1e-9);
  const Scene two = scene_of(
      R"({"size": [80, 40], "holes": [{"centre": [-25, 0], "radius": 2}, {"centre": [25, 0], "radius": 2}]})",
      zone("\"holes\": true"));
  EXPECT_EQ(two.zone.boxes.size(), 2u);
  // A scene without a zone is told one.
  const ReadResult none = parse_scene(
      R"({"specimen": {"size": [40, 40], "cracks": [{"points": [[-20, 0], [-10, 0]]}]})" + rest +
          R"(, "discrete_zone": {"packing": "hexagonal", "spacing": 0.1}, "far_field": {"cell_size": 0.4}})",
      "scene.json", {});
  ASSERT_EQ(none.errors.size(), 1u);
  EXPECT_NE(none.errors[0].remedy.find("\"lower\": [null, -2.4]"), std::string::npos)
      << none.errors[0].remedy;
}
} // namespace
