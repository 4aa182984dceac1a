#include "src/verification/cases/random_scenes_draw.h"

#include "core/types.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
using Json = nlohmann::ordered_json;

void negate_x(Json &point)
{
  if (!point.empty() && point[0].is_number())
    point[0] = -point[0].get<double>();
}

/// Lower and upper corner; null reaches through.
void mirror_box(Json &box)
{
  for (const char *corner : {"lower", "upper"})
    if (!box.contains(corner))
      return;
  negate_x(box["lower"]);
  negate_x(box["upper"]);
  std::swap(box["lower"][0], box["upper"][0]);
}

/// Normal of a plane in which the lattice at orientation 0 is its own image: through the centre of
/// the specimen, which lies on a bond of hexagonal and fcc packings and amid all others.
template <int dim>
Vector<dim> mirror_normal(const std::string &packing)
{
  if constexpr (dim == 2) {
    if (packing == "hexagonal")
      return {0.5, std::sqrt(0.75)};
  } else if (packing == "fcc")
    return {0.5, 0.5, std::sqrt(0.5)};
  return Vector<dim>::UnitX();
}

// Image of a turned lattice: M R L = (M R S) L, where S L = L.
template <int dim>
Eigen::Matrix<double, dim, dim> mirrored_rotation(const Eigen::Matrix<double, dim, dim> &rotation,
                                                  const std::string &packing)
{
  using Matrix = Eigen::Matrix<double, dim, dim>;
  const Vector<dim> n = mirror_normal<dim>(packing);
  const Vector<dim> x = Vector<dim>::UnitX();
  return (Matrix::Identity() - 2 * x * x.transpose()) * rotation *
         (Matrix::Identity() - 2 * n * n.transpose());
}

Json mirrored_orientation(const Json &orientation, int dim, const std::string &packing)
{
  if (dim == 2) {
    const double angle = orientation.is_number() ? orientation.get<double>() : 0;
    const Eigen::Matrix2d image =
        mirrored_rotation<2>(Eigen::Rotation2Dd(angle).toRotationMatrix(), packing);
    return std::atan2(image(1, 0), image(0, 0));
  }
  Eigen::Vector3d v(0, 0, 0);
  for (int c = 0; c < 3 && orientation.is_array(); ++c)
    v[c] = orientation[c];
  const double angle = v.norm();
  const Eigen::Vector3d axis = angle > 0 ? Eigen::Vector3d(v / angle) : Eigen::Vector3d::UnitX();
  const Eigen::AngleAxisd image(
      mirrored_rotation<3>(Eigen::AngleAxisd(angle, axis).toRotationMatrix(), packing));
  const Eigen::Vector3d w = image.angle() * image.axis();
  return {w[0], w[1], w[2]};
}

void mirror_load(Json &load)
{
  const std::string side = load["boundary"];
  if (side == "left" || side == "right")
    load["boundary"] = side == "left" ? "right" : "left";
  for (const char *kind : {"velocity", "displacement", "traction"})
    if (load.contains(kind))
      negate_x(load[kind]);
}
} // namespace

nlohmann::ordered_json all_discrete(nlohmann::ordered_json scene)
{
  scene["far_field"] = "none";
  return scene;
}

nlohmann::ordered_json mirrored(const nlohmann::ordered_json &scene)
{
  Json image = scene;
  auto &specimen = image["specimen"];
  if (specimen.contains("cracks"))
    for (auto &crack : specimen["cracks"]) {
      auto &points = crack["points"];
      for (auto &point : points)
        negate_x(point);
      // A particle on the plane of the crack keeps its side.
      std::reverse(points.begin(), points.end());
    }
  if (specimen.contains("holes"))
    for (auto &hole : specimen["holes"])
      negate_x(hole["centre"]);
  if (specimen.contains("notches"))
    for (auto &notch : specimen["notches"])
      mirror_box(notch);
  auto &zone = image["discrete_zone"];
  if (zone.contains("region"))
    mirror_box(zone["region"]);
  if (zone.contains("boxes"))
    for (auto &box : zone["boxes"])
      mirror_box(box);
  const std::string packing = zone["packing"];
  if (packing != "random" && packing != "file")
    zone["orientation"] = mirrored_orientation(zone.value("orientation", Json()),
                                               scene.value("dimension", 2), packing);
  for (auto &load : image["loads"])
    mirror_load(load);
  return image;
}
} // namespace ligament::program
