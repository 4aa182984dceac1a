#include "src/scene/body_file.h"

#include "core/keyed_error.h"
#include "src/scene/surface_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace ligament::program
{
namespace
{
const std::string key = "/specimen/file";

[[noreturn]] void fail(const std::string &file, const std::string &what, const std::string &reason,
                       const std::string &remedy)
{
  throw core::KeyedError(key, fmt::format("\"file\" {} {}", file, what), reason, remedy);
}

int number_of(std::vector<std::string> &names, const std::string &name)
{
  if (name.empty())
    return -1;
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    names.push_back(name);
  return int(std::find(names.begin(), names.end(), name) - names.begin());
}

void add_outline(const std::string &file, BodyFile &body)
{
  const GmshMesh &mesh = body.mesh;
  if (mesh.faces.empty())
    fail(file, "has no faces", "in 2D the body is what its triangles and quadrilaterals cover",
         "mesh the surface");
  double low = 1e300, high = -1e300, size = 0;
  for (const auto &x : mesh.nodes) {
    low = std::min(low, x[2]);
    high = std::max(high, x[2]);
    size = std::max(size, x.norm());
  }
  if (high - low > 1e-9 * size)
    fail(file, "is not plane", fmt::format("its nodes lie between z = {} m and {} m", low, high),
         "give a mesh in the plane of x and y, or set /dimension to 3");
  std::map<std::pair<int, int>, int> side; // directed edges, the body on the left -> next of them
  for (const auto &face : mesh.faces) {
    double area = 0;
    const std::size_t n = face.corners.size();
    for (std::size_t k = 0; k < n; ++k) {
      const Vector<3> &a = mesh.nodes[face.corners[k]], &b = mesh.nodes[face.corners[(k + 1) % n]];
      area += a[0] * b[1] - a[1] * b[0];
    }
    for (std::size_t k = 0; k < n; ++k) {
      int a = face.corners[k], b = face.corners[(k + 1) % n];
      if (area < 0)
        std::swap(a, b);
      if (!side.erase({b, a}))
        side[{a, b}] = 0;
    }
  }
  std::map<std::pair<int, int>, std::string> name_of;
  for (const auto &line : mesh.lines)
    name_of[std::minmax(line.corners[0], line.corners[1])] = line.name;
  std::map<int, int> next;
  for (const auto &[edge, unused] : side)
    if (!next.insert(edge).second) {
      const Vector<3> &x = mesh.nodes[edge.first];
      fail(file, "touches itself",
           fmt::format("four of its outer edges meet at ({:.6g}, {:.6g}) m", x[0], x[1]),
           "part the body there, or join it");
    }
  while (!next.empty()) {
    core::Polygon polygon;
    for (auto edge = next.begin(); edge != next.end();) {
      const auto [a, b] = *edge;
      const auto name = name_of.find(std::minmax(a, b));
      polygon.push_back({mesh.nodes[a].head<2>(),
                         name == name_of.end() ? -1 : number_of(body.names, name->second)});
      next.erase(edge);
      edge = next.find(b);
    }
    body.polygons.push_back(std::move(polygon));
  }
  if (body.polygons.empty())
    fail(file, "has no outline", "its elements have no outer edges", "mesh the body anew");
}

void add_surface(const std::string &file, BodyFile &body)
{
  const GmshMesh &mesh = body.mesh;
  using Corners = std::vector<int>;
  static const std::vector<Corners> of_tetrahedron = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  static const std::vector<Corners> of_hexahedron = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                                     {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  std::map<Corners, Corners> outer; // by sorted corners
  const auto add = [&](const Corners &face) {
    Corners sorted = face;
    std::sort(sorted.begin(), sorted.end());
    if (!outer.erase(sorted))
      outer[sorted] = face;
  };
  for (const auto &volume : mesh.volumes)
    for (const Corners &local : volume.corners.size() == 4 ? of_tetrahedron : of_hexahedron) {
      Corners face;
      for (const int k : local)
        face.push_back(volume.corners[k]);
      add(face);
    }
  std::map<Corners, std::string> name_of;
  for (const auto &face : mesh.faces) {
    Corners sorted = face.corners;
    std::sort(sorted.begin(), sorted.end());
    name_of[sorted] = face.name;
    if (mesh.volumes.empty())
      outer[sorted] = face.corners;
  }
  if (outer.empty())
    fail(file, "has no surface", "there are neither volumes nor faces", "mesh the body");
  body.vertices = mesh.nodes;
  for (const auto &[sorted, face] : outer) {
    const auto name = name_of.find(sorted);
    const int number = name == name_of.end() ? -1 : number_of(body.names, name->second);
    for (std::size_t k = 2; k < face.size(); ++k)
      body.facets.push_back(
          {{{face[0], face[k - 1]}, {face[k - 1], face[k]}, {face[k], face[0]}}, number});
  }
}
} // namespace

BodyFile read_body(const std::string &file, int dim)
{
  const auto ends_with = [&](const std::string &end) {
    return file.size() > end.size() && file.compare(file.size() - end.size(), end.size(), end) == 0;
  };
  BodyFile body;
  if (ends_with(".msh")) {
    body.mesh = read_gmsh(file, key);
    dim == 2 ? add_outline(file, body) : add_surface(file, body);
  } else if (dim == 3 && (ends_with(".stl") || ends_with(".STL")))
    read_surface(file, key, body.vertices, body.facets);
  else
    fail(file, "is of no known kind",
         dim == 2 ? "2D bodies come from gmsh's .msh" : "3D bodies come from .stl or gmsh's .msh",
         "save it as one of these");
  if (dim == 2)
    return body;
  try {
    if (core::Solid<3>(body.vertices, body.facets).volume() <= 0)
      throw core::InputError("the surface is inside out: its volume is not positive");
  } catch (const core::InputError &error) {
    fail(file, "bounds no body", error.what(), "mend the surface, so that it is closed");
  }
  return body;
}
} // namespace ligament::program
