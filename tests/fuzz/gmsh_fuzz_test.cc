// Meshes of gmsh that are right and wrong.
#include "core/keyed_error.h"
#include "src/scene/body_file.h"
#include "tests/fuzz/fuzz_cases.h"
#include "tests/fuzz/text_faults.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>

namespace
{
using namespace ligament;
using namespace ligament::fuzz;
using program::GmshMesh;

/// A block of nx by ny (by nz) boxes in a form that both versions of the file are written from.
struct Block
{
  struct Element
  {
    int type, entity; // of gmsh
    std::vector<int> nodes;
  };
  int dim;
  std::vector<std::array<double, 3>> nodes;
  std::vector<int> tags; // of nodes
  std::vector<Element> elements;
};

int dimension_of_type(int type)
{
  return type == 15 ? 0 : type == 1 ? 1 : type == 2 || type == 3 ? 2 : 3;
}

Block draw_block(Draw &draw)
{
  Block block;
  block.dim = draw.between(2, 3);
  const std::array<int, 3> n = {draw.between(1, 3), draw.between(1, 3),
                                block.dim == 3 ? draw.between(1, 2) : 0};
  const double size = draw.spread(1e-3, 10);
  const bool split = draw.once_in(2);
  const auto node = [&](int i, int j, int k) { return i + (n[0] + 1) * (j + (n[1] + 1) * k); };
  int tag = 0;
  for (int k = 0; k <= n[2]; ++k)
    for (int j = 0; j <= n[1]; ++j)
      for (int i = 0; i <= n[0]; ++i) {
        block.nodes.push_back({size * i, size * j * 0.7, size * k * 1.1});
        block.tags.push_back(tag += draw.between(1, 3)); // numbers may have gaps
      }
  const auto add = [&](int type, std::vector<int> nodes) {
    block.elements.push_back({type, dimension_of_type(type), std::move(nodes)});
  };
  for (int k = 0; k < std::max(n[2], 1); ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        std::vector<int> c = {node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k),
                              node(i, j + 1, k)};
        if (block.dim == 3)
          for (int m = 0; m < 4; ++m)
            c.push_back(c[m] + (n[0] + 1) * (n[1] + 1));
        if (block.dim == 2 && split) {
          add(2, {c[0], c[1], c[2]});
          add(2, {c[0], c[2], c[3]});
        } else if (block.dim == 2)
          add(3, c);
        else if (split) // Kuhn's six, which fit together
          for (const auto &t : {std::array<int, 4>{0, 1, 2, 6},
                                {0, 2, 3, 6},
                                {0, 3, 7, 6},
                                {0, 7, 4, 6},
                                {0, 4, 5, 6},
                                {0, 5, 1, 6}})
            add(4, {c[t[0]], c[t[1]], c[t[2]], c[t[3]]});
        else
          add(5, c);
      }
  if (block.dim == 2)
    for (int i = 0; i < n[0]; ++i)
      add(1, {node(i, 0, 0), node(i + 1, 0, 0)});
  else if (!split)
    for (int i = 0; i < n[0]; ++i)
      add(3, {node(i, 0, 0), node(i + 1, 0, 0), node(i + 1, 1, 0), node(i, 1, 0)});
  return block;
}

/// Elements of one type together, as version 4.1 wants them.
std::map<int, std::vector<const Block::Element *>> by_type(const Block &block)
{
  std::map<int, std::vector<const Block::Element *>> types;
  for (const Block::Element &element : block.elements)
    types[element.type].push_back(&element);
  return types;
}

std::string names(const Block &block)
{
  return fmt::format("$PhysicalNames\n2\n{} 7 \"foot\"\n{} 9 \"the body\"\n$EndPhysicalNames\n",
                     block.dim - 1, block.dim);
}

bool has_sides(const Block &block)
{
  return std::any_of(block.elements.begin(), block.elements.end(),
                     [&](const auto &e) { return e.entity == block.dim - 1; });
}

int group_of(const Block &block, int entity)
{
  return entity == block.dim ? 9 : 7;
}

std::string in_version_2(const Block &block, bool named)
{
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + (named ? names(block) : "");
  text += fmt::format("$Nodes\n{}\n", block.nodes.size());
  for (std::size_t k = 0; k < block.nodes.size(); ++k)
    text += fmt::format("{} {} {} {}\n", block.tags[k], block.nodes[k][0], block.nodes[k][1],
                        block.nodes[k][2]);
  text += fmt::format("$EndNodes\n$Elements\n{}\n", block.elements.size());
  int number = 0;
  for (const Block::Element &element : block.elements) {
    text += fmt::format("{} {} 2 {} 1", ++number, element.type, group_of(block, element.entity));
    for (const int node : element.nodes)
      text += fmt::format(" {}", block.tags[node]);
    text += "\n";
  }
  return text + "$EndElements\n";
}

std::string in_version_4(const Block &block, bool named)
{
  std::string text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n" + (named ? names(block) : "");
  text += block.dim == 2 ? "$Entities\n1 1 1 0\n1 0 0 0 0\n" : "$Entities\n1 0 1 1\n1 0 0 0 0\n";
  for (const int entity : {block.dim - 1, block.dim})
    text += fmt::format("{} 0 0 0 1 1 1 1 {} 2 1 -1\n", 1, group_of(block, entity));
  text += fmt::format("$EndEntities\n$Nodes\n1 {0} {1} {2}\n{3} 1 0 {0}\n", block.nodes.size(),
                      block.tags.front(), block.tags[block.nodes.size() - 1], block.dim);
  for (std::size_t k = 0; k < block.nodes.size(); ++k)
    text += fmt::format("{}\n", block.tags[k]);
  for (const auto &x : block.nodes)
    text += fmt::format("{} {} {}\n", x[0], x[1], x[2]);
  const auto types = by_type(block);
  text += fmt::format("$EndNodes\n$Elements\n{0} {1} 1 {1}\n", types.size(), block.elements.size());
  int number = 0;
  for (const auto &[type, elements] : types) {
    text += fmt::format("{} 1 {} {}\n", dimension_of_type(type), type, elements.size());
    for (const Block::Element *element : elements) {
      text += fmt::format("{}", ++number);
      for (const int node : element->nodes)
        text += fmt::format(" {}", block.tags[node]);
      text += "\n";
    }
  }
  return text + "$EndElements\n";
}

std::string draw_text(Draw &draw, const Block &block)
{
  const bool named = has_sides(block) && draw.once_in(2);
  std::string text = draw.once_in(2) ? in_version_2(block, named) : in_version_4(block, named);
  if (draw.once_in(4)) // other programs leave sections of their own
    text.insert(text.find("$Nodes"), "$Comments\nby hand\n$EndComments\n");
  return text;
}

void expect_complete(const core::KeyedError &error, const std::string &place)
{
  EXPECT_EQ(error.key, "/specimen/file");
  EXPECT_NE(error.message.find(place), error.message.npos) << error.message;
  EXPECT_FALSE(error.reason.empty()) << error.message;
  EXPECT_FALSE(error.remedy.empty()) << error.message;
}

/// The same mesh as text of version 2.2.
std::string written(const GmshMesh &mesh)
{
  std::map<std::pair<int, std::string>, int> groups;
  const std::array<const std::vector<GmshMesh::Element> *, 3> lists = {&mesh.lines, &mesh.faces,
                                                                       &mesh.volumes};
  for (int d = 0; d < 3; ++d)
    for (const GmshMesh::Element &element : *lists[d])
      if (!element.name.empty())
        groups.emplace(std::pair(d + 1, element.name), int(groups.size()) + 1);
  std::string text =
      fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{}\n", groups.size());
  for (const auto &[group, tag] : groups)
    text += fmt::format("{} {} \"{}\"\n", group.first, tag, group.second);
  text += fmt::format("$EndPhysicalNames\n$Nodes\n{}\n", mesh.nodes.size());
  for (std::size_t k = 0; k < mesh.nodes.size(); ++k)
    text +=
        fmt::format("{} {} {} {}\n", k + 1, mesh.nodes[k][0], mesh.nodes[k][1], mesh.nodes[k][2]);
  std::string elements;
  int n = 0;
  for (int d = 0; d < 3; ++d)
    for (const GmshMesh::Element &element : *lists[d]) {
      static const std::map<std::size_t, int> flat = {{3, 2}, {4, 3}}, solid = {{4, 4}, {8, 5}};
      const std::size_t size = element.corners.size();
      const int type = d == 0 ? 1 : d == 1 ? flat.at(size) : solid.at(size);
      const auto group = groups.find({d + 1, element.name});
      elements += fmt::format("{} {} 2 {} 1", ++n, type, group == groups.end() ? 0 : group->second);
      for (const int corner : element.corners)
        elements += fmt::format(" {}", corner + 1);
      elements += "\n";
    }
  return text + fmt::format("$EndNodes\n$Elements\n{}\n{}$EndElements\n", n, elements);
}

void expect_sound(const GmshMesh &mesh)
{
  for (const Vector<3> &x : mesh.nodes)
    EXPECT_TRUE(x.allFinite());
  for (const auto *list : {&mesh.lines, &mesh.faces, &mesh.volumes})
    for (const GmshMesh::Element &element : *list)
      for (const int corner : element.corners) {
        EXPECT_GE(corner, 0);
        EXPECT_LT(corner, int(mesh.nodes.size()));
      }
}

void expect_equal(const std::vector<GmshMesh::Element> &a, const std::vector<GmshMesh::Element> &b)
{
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].corners, b[k].corners);
    EXPECT_EQ(a[k].name, b[k].name);
  }
}

/// True when the text is accepted as a mesh and, in this dimension, as a body.
bool read_any(const std::string &text, int dim)
{
  note_document(text);
  const File file("fuzz.msh", text);
  std::string place = file.name() + (text.empty() ? "" : ":"); // with a line while it is read
  try {
    const GmshMesh mesh = program::read_gmsh(file.name(), "/specimen/file");
    expect_sound(mesh);
    const File echo("fuzz_echo.msh", written(mesh));
    const GmshMesh again = program::read_gmsh(echo.name(), "/specimen/file");
    EXPECT_EQ(again.nodes, mesh.nodes);
    expect_equal(again.lines, mesh.lines);
    expect_equal(again.faces, mesh.faces);
    expect_equal(again.volumes, mesh.volumes);
    place = file.name();
    const program::BodyFile body = program::read_body(file.name(), dim);
    EXPECT_FALSE(dim == 2 ? body.polygons.empty() : body.facets.empty());
  } catch (const core::KeyedError &error) {
    expect_complete(error, place);
    return false;
  }
  return true;
}

void right_case(Draw &draw)
{
  const Block block = draw_block(draw);
  const std::string text = draw_text(draw, block);
  EXPECT_TRUE(read_any(text, block.dim));
}

/// An element with a node that is not there.
void foreign_node_case(Draw &draw)
{
  Block block = draw_block(draw);
  int foreign = draw.between(-2, block.tags.back() + 3);
  while (std::count(block.tags.begin(), block.tags.end(), foreign) > 0)
    ++foreign;
  const std::size_t n = block.nodes.size();
  block.tags.push_back(foreign);
  auto &nodes = block.elements[draw.below(block.elements.size())].nodes;
  nodes[draw.below(nodes.size())] = int(n);
  EXPECT_FALSE(read_any(draw_text(draw, block), block.dim));
}

void wrong_case(Draw &draw)
{
  const Block block = draw_block(draw);
  std::string text = draw_text(draw, block);
  for (int n = draw.between(1, 4); n > 0; --n)
    text = draw.once_in(4) ? with_wrong_bytes(draw, text) : with_wrong_line(draw, text, " ");
  read_any(text, draw.once_in(10) ? 5 - block.dim : block.dim);
}
} // namespace

TEST(GmshFuzz, RightMeshesAreAccepted)
{
  run_cases(21, 1000, right_case);
}

TEST(GmshFuzz, WrongMeshesAreToldWithReasonAndRemedy)
{
  run_cases(22, 10000, wrong_case);
}

TEST(GmshFuzz, NodesThatAreNotThereAreNoticed)
{
  run_cases(23, 1000, foreign_node_case);
}

TEST(GmshFuzz, SlowManyMeshes)
{
  run_cases_for(900, [](Draw &draw) { draw.once_in(5) ? right_case(draw) : wrong_case(draw); });
}
