#include "src/scene/check_scene.h"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
/// Normals of the planes (2D: rows) along which a crack runs straight in a lattice, lattice axes.
std::vector<Vector<3>> smooth_planes(PackingKind packing)
{
  std::vector<Vector<3>> normals;
  const auto in_plane = [&](double degrees) {
    const double angle = degrees * M_PI / 180;
    normals.push_back({-std::sin(angle), std::cos(angle), 0});
  };
  if (packing == PackingKind::square)
    for (const double angle : {0, 90})
      in_plane(angle);
  if (packing == PackingKind::hexagonal)
    for (const double angle : {0, 60, 120})
      in_plane(angle);
  if (packing == PackingKind::simple_cubic)
    normals = {Vector<3>::UnitX(), Vector<3>::UnitY(), Vector<3>::UnitZ()};
  if (packing == PackingKind::fcc) { // rows along x and y, cube axis along z: cube and octahedron
    const double s = std::sqrt(2. / 3), c = std::sqrt(1. / 3), q = std::sqrt(0.5);
    normals = {{0, 0, 1}, {q, q, 0}, {q, -q, 0}, {s, 0, c}, {-s, 0, c}, {0, s, c}, {0, -s, c}};
  }
  return normals;
}

Vector<3> normal_of(const Crack &crack, int dim)
{
  const auto point = [&](std::size_t k) { return Vector<3>(crack.points[k].data()); };
  if (dim == 2)
    return Vector<3>::UnitZ()
        .cross(point(crack.points.size() - 1) - point(crack.points.size() - 2))
        .normalized();
  Vector<3> area = Vector<3>::Zero();
  for (std::size_t k = 2; k < crack.points.size(); ++k)
    area += (point(k - 1) - point(0)).cross(point(k) - point(0));
  return area.normalized();
}

Eigen::Matrix3d turn_of(const DiscreteZone &zone, int dim)
{
  const Vector<3> turn =
      dim == 2 ? Vector<3>(0, 0, zone.orientation[0]) : Vector<3>(zone.orientation.data());
  const double angle = turn.norm();
  return Eigen::AngleAxisd(angle, angle > 0 ? Vector<3>(turn / angle) : Vector<3>::UnitZ())
      .toRotationMatrix();
}
} // namespace

void check_path(const Scene &scene, const Crack &crack, const std::string &key, Findings &f)
{
  if (scene.zone.extent == DiscreteZone::Extent::none || !scene.zone.packing ||
      scene.zone.is_irregular() ||
      !f.sound({"/discrete_zone/packing", "/discrete_zone/orientation",
                "/material/fracture/criterion"}) ||
      scene.material.fracture.criterion == Criterion::none)
    return;
  const Vector<3> normal =
      turn_of(scene.zone, scene.dimension).transpose() * normal_of(crack, scene.dimension);
  double nearest = 0;
  for (const Vector<3> &plane : smooth_planes(*scene.zone.packing))
    nearest = std::max(nearest, std::abs(plane.dot(normal)));
  const double off = std::acos(std::min(nearest, 1.)) * 180 / M_PI;
  if (nearest == 0 || off < 1)
    return;
  f.warning(key,
            fmt::format("{} is turned by {:.0f} degrees against the {} of the lattice \"{}\"", key,
                        off, scene.dimension == 2 ? "rows" : "smooth planes",
                        word_of(*scene.zone.packing)),
            "cracks in a lattice follow its rows, up to 20 degrees off the path in a solid",
            "where the path matters choose the packing \"random\", or turn \"orientation\"");
}
} // namespace ligament::program
