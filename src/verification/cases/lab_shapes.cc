// Uniform strain through the overlap of bodies whose far field follows a curved outline, a
// re-entrant corner or a hole.
#include "src/scene/body_shape.h"
#include "src/verification/bodies/outlines.h"
#include "src/verification/cases/lab.h"
#include "src/verification/instruments/held_boundary.h"
#include "src/verification/instruments/linear_motion.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
constexpr double nu = 0.3, size_of_strain = 1e-14; // its square is below round-off

struct Worst
{
  double residual = 0; // over C11 h
  double error = 0;    // of displacements over the largest; of strains over the applied one
};

std::vector<OutlineCorner> corners(const std::vector<Point> &places)
{
  std::vector<OutlineCorner> list(places.size());
  for (std::size_t k = 0; k < places.size(); ++k)
    list[k].at = places[k];
  return list;
}

/// A disc with the zone inside.
Scene disc()
{
  Scene scene = outlined_scene(circle({3, -2, 0}, 52, "rim"), {}, nu);
  couple(scene, {-14.3, -18.6, 0}, {19.2, 14.1, 0});
  return scene;
}

/// A plate with a hole beside the zone.
Scene plate()
{
  Scene scene = outlined_scene(corners({{-60, -40, 0}, {60, -40, 0}, {60, 40, 0}, {-60, 40, 0}}),
                               {circle({32.3, 3.1, 0}, 13, "rim")}, nu);
  couple(scene, {-40.2, -17.4, 0}, {-5.1, 18.3, 0});
  return scene;
}

/// All nodes of the outline, holes included, are held in a strain with all components.
void impose(const Scene &scene, Worst &worst)
{
  const PlaneField field = [](const Vector<2> &x) -> Vector<2> {
    return size_of_strain * Vector<2>(0.8 * x[0] + 0.2 * x[1], 0.2 * x[0] - 0.5 * x[1]);
  };
  UnitBody<2> unit(scene);
  keep_largest(worst.residual, unit.body.figures.at("patch_residual").value);
  const double imposed = settle_with_sides(
      unit.body, [](int side) { return side != inner_surface<2>; }, field);
  keep_largest(worst.error, largest_distance(unit.body, field) / imposed);
}

/// An L with the zone around its inner corner and to the end of its foot: overlaps end at sides
/// that a stress along y leaves free, and nowhere else.
Scene corner()
{
  auto outline =
      corners({{-50, -45, 0}, {48, -45, 0}, {48, 0, 0}, {0, 0, 0}, {0, 52, 0}, {-50, 52, 0}});
  outline[3].side = "shelf";
  Scene scene = outlined_scene(outline, {}, nu);
  couple(scene, {-26, -25, 0}, {80, 26, 0});
  return scene;
}

/// Tractions of a stress along y.
void pull(Scene scene, Worst &worst)
{
  const Strain<2> stress(0, size_of_strain, 0);
  add_tractions<2>(scene, {2, 3, 3}, stress);
  const auto names = side_names_of(scene.specimen, 2);
  scene.loads.back().boundary = int(std::find(names.begin(), names.end(), "shelf") - names.begin());
  UnitBody<2> unit(scene);
  keep_largest(worst.residual, unit.body.figures.at("patch_residual").value);
  LinearMotion<2> motion(unit.body);
  const Strain<2> strain = unit.body.far->body().stiffness.inverse() * stress;
  Eigen::Matrix2d gradient;
  gradient << strain[0], strain[2] / 2, strain[2] / 2, strain[1];
  const Eigen::VectorXd error = motion.solve() - motion.affine(gradient);
  keep_largest(worst.error, motion.largest_strain(error) / gradient.norm());
}

/// Hexagonal packings at 0 and 17 degrees, and a random one.
template <typename Measure>
Worst over_packings(Scene scene, Measure &&measure)
{
  Worst worst;
  measure(scene, worst);
  scene.zone.orientation[0] = 17 * M_PI / 180;
  measure(scene, worst);
  scene.zone.packing = PackingKind::random;
  measure(scene, worst);
  return worst;
}

std::vector<Result> patch(const std::string &name)
{
  std::vector<Result> results;
  const auto add = [&](const std::string &shape, const char *what, const Worst &worst) {
    results.push_back({name + "/" + shape + "_residual", worst.residual, 1e-12, 1e-14});
    results.push_back({name + "/" + shape + "_" + what, worst.error, 1e-12, 1e-14});
  };
  add("disc", "displacement", over_packings(disc(), impose));
  add("hole", "displacement", over_packings(plate(), impose));
  add("corner", "strain", over_packings(corner(), pull));
  return results;
}
} // namespace

std::vector<Case> lab_shapes_cases()
{
  return {{"lab_shapes", "uniform strain of a disc, an L and a plate with a hole beside the zone",
           false, [] { return patch("lab_shapes"); }}};
}
} // namespace ligament::program
