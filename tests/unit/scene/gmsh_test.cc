// Bodies from gmsh's files: what is read, and what is refused.
#include "core/keyed_error.h"
#include "src/scene/body_file.h"
#include "src/scene/body_shape.h"
#include "src/scene/read_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>

namespace
{
using namespace ligament;
using namespace ligament::program;

/// Writes a file for as long as it lives.
struct File
{
  std::string name;
  File(const std::string &name, const std::string &text) : name(name)
  {
    std::ofstream(name) << text;
  }
  ~File() { std::remove(name.c_str()); }
};

std::string reason_of(const std::string &text, int dim)
{
  const File file("wrong.msh", text);
  try {
    read_body(file.name, dim);
  } catch (const core::KeyedError &error) {
    EXPECT_EQ(error.key, "/specimen/file");
    EXPECT_FALSE(error.remedy.empty());
    return error.message + ": " + error.reason;
  }
  return "";
}

// Two squares and a triangle, numbered with gaps; the square on the left runs clockwise.
const std::string nodes_2 = R"($Nodes
7
1 0 0 0
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 0
8 2 1 0
9 3 0 0
$EndNodes
)";
const std::string elements_2 = R"($Elements
5
1 1 2 7 1 1 4
2 1 2 8 2 8 9
3 3 2 9 3 1 4 5 2
4 3 2 9 3 2 3 8 5
5 2 2 9 3 3 9 8
$EndElements
)";
const std::string names = R"($PhysicalNames
3
1 7 "grip"
1 8 "ramp end"
2 9 "body"
$EndPhysicalNames
)";
const std::string head_2 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";

const std::string version_4 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
)" + names + R"($Entities
1 2 1 0
1 0 0 0 0
1 0 0 0 0 1 0 1 7 2 1 -1
2 2 0 0 3 1 0 1 8 2 1 -1
3 0 0 0 3 1 0 1 9 2 1 2
$EndEntities
$Nodes
2 7 1 9
1 1 0 2
1
4
0 0 0
0 1 0
2 3 0 5
2
3
5
8
9
1 0 0
2 0 0
1 1 0
2 1 0
3 0 0
$EndNodes
$Elements
4 5 1 5
1 1 1 1
1 1 4
1 2 1 1
2 8 9
2 3 3 2
3 1 4 5 2
4 2 3 8 5
2 3 2 1
5 3 9 8
$EndElements
)";

std::string replaced(std::string text, const std::string &from, const std::string &to)
{
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

// What is in two groups at once has the name of the first one; version 2.2 repeats its elements.
std::string in_two_groups(std::string text, bool is_new)
{
  text = replaced(text, "$PhysicalNames\n3", "$PhysicalNames\n4");
  text = replaced(text, "2 9 \"body\"\n", "2 9 \"body\"\n2 10 \"all\"\n");
  if (is_new)
    return replaced(text, "3 0 0 0 3 1 0 1 9 ", "3 0 0 0 3 1 0 2 -9 10 ");
  text = replaced(text, "$Elements\n5", "$Elements\n8");
  return replaced(text, "$EndElements", R"(6 3 2 10 3 1 4 5 2
7 3 2 10 3 2 3 8 5
8 2 2 10 3 3 9 8
$EndElements)");
}

TEST(Gmsh, OutlinesOfBothVersionsAreTheSame)
{
  const std::string version_2 = head_2 + names + nodes_2 + elements_2;
  for (const std::string &text :
       {version_2, version_4, in_two_groups(version_2, false), in_two_groups(version_4, true)})
  {
    const File file("body.msh", text);
    Specimen specimen;
    specimen.file = file.name;
    enclose_body(specimen, 2);
    const auto polygons = outline_of(specimen, 2, 1, true);
    ASSERT_EQ(polygons.size(), 1u);
    EXPECT_NEAR(core::signed_area(polygons[0]), 2.5, 1e-15);
    EXPECT_EQ(polygons[0].size(), 7u);
    const auto sides = side_names_of(specimen, 2);
    ASSERT_EQ(sides.size(), 7u);
    std::map<std::string, double> length;
    for (std::size_t k = 0; k < 7; ++k)
      length[sides[polygons[0][k].boundary]] +=
          (polygons[0][(k + 1) % 7].place - polygons[0][k].place).norm();
    EXPECT_NEAR(length["grip"], 1, 1e-15);
    EXPECT_NEAR(length["ramp end"], std::sqrt(2.), 1e-15);
    EXPECT_NEAR(length["bottom"], 3, 1e-15);
    EXPECT_NEAR(length["top"], 2, 1e-15);
    EXPECT_EQ(length.count("left"), 0u);
    EXPECT_EQ(specimen.body->mesh.faces.size(), 3u);
    for (const auto &face : specimen.body->mesh.faces)
      EXPECT_EQ(face.name, "body");
    EXPECT_FALSE(specimen.body->mesh.was_second_order);
  }
}

TEST(Gmsh, SecondOrderKeepsItsCorners)
{
  const File file("body.msh", head_2 + R"($Nodes
6
1 0 0 0
2 2 0 0
3 0 2 0
4 1 0 0
5 1 1 0
6 0 1 0
$EndNodes
$Elements
1
1 9 2 0 1 1 2 3 4 5 6
$EndElements
)");
  const BodyFile body = read_body(file.name, 2);
  EXPECT_TRUE(body.mesh.was_second_order);
  ASSERT_EQ(body.polygons.size(), 1u);
  EXPECT_EQ(body.polygons[0].size(), 3u);
}

TEST(Gmsh, VolumesBoundABody)
{
  const std::string places = R"($Nodes
8
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 0 0 1
6 1 0 1
7 1 1 1
8 0 1 1
$EndNodes
)";
  const std::string cube = R"($Elements
2
1 3 2 4 1 5 6 7 8
2 5 2 1 1 1 2 3 4 5 6 7 8
$EndElements
)";
  const std::string tetrahedra = R"($Elements
5
1 4 2 1 1 1 2 4 5
2 4 2 1 1 2 3 4 7
3 4 2 1 1 5 7 6 2
4 4 2 1 1 5 8 7 4
5 4 2 1 1 2 4 5 7
$EndElements
)";
  const std::string lid = "$PhysicalNames\n1\n2 4 \"lid\"\n$EndPhysicalNames\n";
  for (const bool is_cube : {true, false}) {
    const File file("body.msh", head_2 + (is_cube ? lid + places + cube : places + tetrahedra));
    const BodyFile body = read_body(file.name, 3);
    EXPECT_NEAR(core::Solid<3>(body.vertices, body.facets).volume(), 1, 1e-14);
    double named = 0;
    for (const auto &facet : body.facets)
      named += facet.boundary >= 0 ? 0.5 : 0;
    EXPECT_EQ(named, is_cube ? 1 : 0);
    EXPECT_EQ(body.names.size(), is_cube ? 1u : 0u);
  }
}

TEST(Gmsh, WrongFilesAreRefused)
{
  const auto says = [&](const std::string &text, int dim, const std::string &part) {
    EXPECT_NE(reason_of(text, dim).find(part), std::string::npos) << reason_of(text, dim);
  };
  says("$MeshFormat\n4.0 0 8\n$EndMeshFormat\n", 2, "version 4.0");
  says("$MeshFormat\n4.1 1 8\n$EndMeshFormat\n", 2, "binary");
  says(head_2 + nodes_2, 2, "no mesh");
  says(head_2 + names + nodes_2 + "$Elements\n1\n1 3 2 9 3 1 4 5 2\n$EndElements\n", 2,
       "no elements of \"grip\"");
  says(head_2 + nodes_2 + "$Elements\n1\n1 3 2 9 3 1 4 5\n$EndElements\n", 2, "ends too early");
  says(head_2 + nodes_2 + "$Elements\n1\n1 3 2 9 3 1 4 5 77\n$EndElements\n", 2,
       "node that is not");
  says(head_2 + nodes_2 + "$Elements\n1\n1 7 2 9 3 1 4 5 2 3\n$EndElements\n", 2, "type 7");
  says(head_2 + nodes_2 + "$Elements\n1\n1 7 2 9 3 1 4 5 2 3\n$EndElements\n", 2,
       "\"wrong.msh:16\" has");
  says(head_2 + "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0.5\n$EndNodes\n$Elements\n1\n1 2 0 1 2 "
                "3\n$EndElements\n",
       2, "not plane");
  says(head_2 + "$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 -1 0 0\n5 0 -1 0\n$EndNodes\n"
                "$Elements\n2\n1 2 0 1 2 3\n2 2 0 1 4 5\n$EndElements\n",
       2, "touches itself");
  says(head_2 + nodes_2 + "$Elements\n1\n1 3 0 2 1 2 3\n$EndElements\n", 2, "no outer edges");
  for (const std::string count : {"-1", "2000000000"}) // no room is taken on a number's word
    says("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 3 1 3\n2 1 0 " + count + "\n1\n2\n", 2,
         count == "-1" ? "has \"1\" where $EndNodes" : "ends too early");
  // A file that was cut behind or within its last number, which is another number then, and wrong
  // counts.
  const std::string whole = head_2 + names + nodes_2 + elements_2;
  says(whole.substr(0, whole.find(" 9 8\n$EndElements") + 4), 2, "$EndElements is missing");
  says(replaced(whole, "$Elements\n5", "$Elements\n4"), 2, "has \"5\" where $EndElements should be");
  says(replaced(version_4, "$EndNodes\n", ""), 2, "has \"$Elements\" where $EndNodes should be");
  says(head_2 + nodes_2 + elements_2, 3, "bounds no body");
  EXPECT_THROW(read_body("no_such_file.msh", 2), core::KeyedError);
  EXPECT_THROW(read_body("body.obj", 3), core::KeyedError);
}

// Cells of a file are as large as they are.
TEST(Gmsh, SizesOfCellsBesideThoseOfTheFileAreDoubted)
{
  const File file("sized.msh", head_2 + nodes_2 + elements_2);
  const std::vector<std::string> sizes = {"levels", "growth", "fine_cells", "cells_per_level",
                                          "outline_cell_size"};
  const ReadResult result = parse_scene(R"({
    "dimension": 2, "specimen": {"file": "sized.msh"},
    "material": {"youngs_modulus": 1e9, "poissons_ratio": 0.2, "density": 1000},
    "discrete_zone": "none",
    "far_field": {"cell_size": 1, "cells_from_file": true, "levels": 1, "growth": 1.2,
                  "fine_cells": 3, "cells_per_level": 2, "outline_cell_size": 0.5},
    "loads": [{"boundary": "left", "velocity": [1e-3, 0]}],
    "time": {"duration": 1}
  })",
                                        "scene.json");
  EXPECT_TRUE(result.scene) << (result.errors.empty() ? "" : core::to_string(result.errors[0]));
  ASSERT_EQ(result.warnings.size(), sizes.size());
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    EXPECT_EQ(result.warnings[k].key, "/far_field/" + sizes[k]);
    EXPECT_EQ(result.warnings[k].reason, "the cells are those of /specimen/file");
  }
}

// Groups with names of the box's sides lie there, or are refused: a load would act on both.
TEST(Gmsh, GroupsNamedLikeSidesOfTheBox)
{
  const auto read = [](const std::string &grip, const std::string &ramp) {
    const File file("named.msh", head_2 +
                                     replaced(replaced(names, "grip", grip), "ramp end", ramp) +
                                     nodes_2 + elements_2);
    return parse_scene(R"({
      "dimension": 2, "specimen": {"file": "named.msh"},
      "material": {"youngs_modulus": 1e9, "poissons_ratio": 0.2, "density": 1000},
      "discrete_zone": "none", "far_field": {"cell_size": 0.5},
      "loads": [{"boundary": "left", "velocity": [1e-3, 0]}],
      "time": {"duration": 1}
    })",
                       "scene.json");
  };
  EXPECT_TRUE(read("left", "ramp end").scene);
  const ReadResult wrong = read("grip", "top");
  ASSERT_EQ(wrong.errors.size(), 1u);
  EXPECT_EQ(wrong.errors[0].key, "/specimen/file");
  EXPECT_NE(wrong.errors[0].message.find("\"top\""), std::string::npos) << wrong.errors[0].message;
}

// A hole of the file is one like that of the scene.
TEST(Gmsh, HolesBetweenTheRectanglesOfAJIntegralAreRefused)
{
  std::string nodes = "$Nodes\n16\n", cells = "$Elements\n8\n";
  for (int k = 0; k < 16; ++k)
    nodes += fmt::format("{} {} {} 0\n", k + 1, 20 * (k % 4), 20 * (k / 4));
  int n = 0;
  for (int k = 0; k < 9; ++k)
    if (k != 4) { // the middle one of nine squares is missing
      const int a = 1 + k % 3 + 4 * (k / 3);
      cells += fmt::format("{} 3 2 1 1 {} {} {} {}\n", ++n, a, a + 1, a + 5, a + 4);
    }
  const File file("frame.msh", head_2 + nodes + "$EndNodes\n" + cells + "$EndElements\n");
  for (const double top : {19., 50.}) {
    const ReadResult result = parse_scene(
        R"({
      "dimension": 2,
      "specimen": {"file": "frame.msh", "cracks": [{"points": [[-1, 10], [30, 10]]}]},
      "material": {"youngs_modulus": 1e9, "poissons_ratio": 0.2, "density": 1000,
                   "fracture": {"criterion": "maximum_tension", "strength": 1e6}},
      "discrete_zone": {"extent": "all", "packing": "random", "spacing": 1},
      "loads": [{"boundary": "left", "velocity": [-1e-3, 0], "ramp": 0.1},
                {"boundary": "right", "velocity": [1e-3, 0], "ramp": 0.1}],
      "gauges": [{"name": "j", "kind": "j_integral", "direction": [1, 0], "lower": [18, 1],
                  "upper": [50, 50], "inner_lower": [26, 6], "inner_upper": [34, 14]}],
      "time": {"duration": 1}
    })",
        "scene.json", {fmt::format("/gauges/0/upper/1={}", top)});
    EXPECT_EQ(result.scene.has_value(), top < 20);
    if (top > 20) {
      ASSERT_EQ(result.errors.size(), 1u);
      EXPECT_EQ(result.errors[0].message,
                "the outer rectangle of /gauges/0 meets a hole of /specimen/file");
    }
  }
}
} // namespace
