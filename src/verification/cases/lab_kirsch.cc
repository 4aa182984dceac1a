// A hole in the far field of a coupled plate: stresses at its rim against Kirsch.
#include "fem/cell_map.h"
#include "src/verification/bodies/kirsch_field.h"
#include "src/verification/bodies/outlines.h"
#include "src/verification/cases/lab.h"
#include "src/verification/instruments/held_boundary.h"

#include <cmath>

namespace ligament::program
{
namespace
{
constexpr double nu = 0.3, small = 1e-14; // a strain whose square is below round-off

/// Stress (xx, yy, xy) at x of an endless plate under a tension 1 along x far away, a hole of this
/// radius at the origin (Kirsch 1898).
Vector<3> kirsch_stress(const Vector<2> &x, double radius)
{
  const double s = std::pow(radius / x.norm(), 2), angle = std::atan2(x[1], x[0]);
  const double c = std::cos(2 * angle);
  Eigen::Matrix2d polar, turn;
  polar(0, 0) = ((1 - s) + (1 - 4 * s + 3 * s * s) * c) / 2;
  polar(1, 1) = ((1 + s) - (1 + 3 * s * s) * c) / 2;
  polar(0, 1) = polar(1, 0) = -(1 + 2 * s - 3 * s * s) * std::sin(2 * angle) / 2;
  turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  const Eigen::Matrix2d stress = turn * polar * turn.transpose();
  return {stress(0, 0), stress(1, 1), stress(0, 1)};
}

struct Errors
{
  double displacement; // over the largest that is imposed
  double stress;       // of the cells at the rim, over the largest of the plate
  double peak;         // of the same cells: the largest stress along x, from that of theory
};

/// The zone lies beside the hole, where the stress is not uniform. All outer sides are held where
/// the endless plate has them.
Errors measure(double radius, double cell_at_rim)
{
  const Point centre = {-35.3, 4.2, 0};
  Scene scene = unit_scene(2, {190, 130, 0}, nu);
  couple(scene, {22, -20, 0}, {60, 20, 0});
  scene.far_field->outline_cell_size = cell_at_rim * scene.far_field->cell_size;
  scene.time.step_fraction = 0.7; // the smaller cells ask for it
  scene.specimen.holes = {{centre, radius}};
  UnitBody<2> unit(scene);
  const KirschField kirsch{radius, 1 / (2 * (1 + nu)), nu};
  const Vector<2> middle(centre[0], centre[1]);
  const PlaneField field = [&](const Vector<2> &x) -> Vector<2> {
    return small * kirsch(x - middle).head<2>();
  };
  const double imposed = settle_with_sides(
      unit.body, [](int side) { return side < inner_surface<2>; }, field);
  Errors e{largest_distance(unit.body, field) / imposed, 0, 0};

  const auto &far = *unit.body.far;
  const auto &mesh = far.mesh();
  double peak = 0, expected_peak = 0;
  for (const auto &face : mesh.boundary_faces) {
    const Vector<2> x =
        fem::cell_point<2>(fem::cell_corners(mesh, face.cell), fem::cell_centre<2>()) - middle;
    if (face.boundary != inner_surface<2> || x.norm() > 1.5 * radius)
      continue;
    const auto gradient = fem::centre_gradients(mesh, face.cell);
    Eigen::Matrix2d h = Eigen::Matrix2d::Zero();
    for (int a = 0; a < 4; ++a)
      h += get(far.displacement, mesh.cells[face.cell][a]) * gradient.col(a).transpose();
    const Vector<3> stress =
        far.body().stiffness * Vector<3>(h(0, 0), h(1, 1), h(0, 1) + h(1, 0)) / small;
    const Vector<3> expected = kirsch_stress(x, radius);
    keep_largest(e.stress, (stress - expected).norm() / 3);
    if (expected[0] > expected_peak) {
      expected_peak = expected[0];
      peak = stress[0];
    }
  }
  e.peak = std::abs(peak / expected_peak - 1);
  return e;
}

std::vector<Result> measure(const std::string &name)
{
  const Errors e = measure(31, 0.5);
  return {{name + "/displacement", e.displacement, 0.01, {}},
          {name + "/rim_stress", e.stress, 0.01, {}},
          {name + "/peak", e.peak, 0.01, {}}};
}
} // namespace

std::vector<Case> lab_kirsch_cases()
{
  return {{"lab_kirsch", "hole in the far field beside the zone: stresses at its rim", false,
           [] { return measure("lab_kirsch"); }}};
}
} // namespace ligament::program
