// Bending of a cantilever of few cells across, by the far field alone and coupled.
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases.h"
#include "src/verification/instruments/linear_motion.h"

#include <fmt/format.h>

#include <cmath>

namespace ligament::program
{
namespace
{
constexpr double traction = 1e-6;

struct Cantilever
{
  double nu;
  bool is_coupled = false;
  double cell_size = 4;
  int levels = 0; // of refinement away from the zone

  /// The largest cells are six across.
  double height() const { return 6 * cell_size * (1 << levels); }
  double length() const { return 10 * height(); }
};

/// Held at its left end, pulled upwards by a uniform traction at the other.
Scene make_scene(const Cantilever &c)
{
  Scene scene = unit_scene(2, {c.length(), c.height(), 0}, c.nu);
  if (c.is_coupled)
    add_far_field(scene, {60, 0, 0}, c.cell_size);
  else {
    scene.zone.extent = DiscreteZone::Extent::none;
    scene.far_field.emplace().cell_size = c.cell_size;
  }
  scene.far_field->levels = c.levels;
  LoadParameters &held = scene.loads.emplace_back();
  held.boundary = 0;
  held.kind = LoadKind::displacement;
  held.value[0] = held.value[1] = 0;
  add_tractions<2>(scene, {1}, {0, 0, traction});
  return scene;
}

/// Displacement of the loaded end over that of Timoshenko's beam in plane strain, E = 1.
double tip_over_theory(const Cantilever &c)
{
  UnitBody<2> unit(make_scene(c));
  LinearMotion<2>(unit.body).solve();
  const auto &far = *unit.body.far;
  const double length = c.length(), height = c.height();
  double sum = 0;
  int n = 0;
  for (int i = 0; i < far.mesh().n_nodes(); ++i)
    if (far.mesh().nodes[i][0] > length / 2 - 1e-9) {
      sum += far.displacement[1][i];
      ++n;
    }
  const double force = traction * height, modulus = 1 / (1 - c.nu * c.nu),
               shear = 1 / (2 * (1 + c.nu));
  const double bending = force * std::pow(length, 3) / (3 * modulus * std::pow(height, 3) / 12);
  const double sheared = force * length / (5. / 6 * shear * height);
  return sum / n / (bending + sheared);
}

/// 0.97 to 1.02 must hold. The theory does not know the clamped end, which is a little stiffer.
std::vector<Result> measure(const std::string &name, const std::vector<Cantilever> &beams)
{
  std::vector<Result> results;
  for (const Cantilever &c : beams) {
    const double ratio = tip_over_theory(c);
    results.push_back({fmt::format("{}/{}_nu_{:g}{}", name, c.is_coupled ? "coupled" : "far_field",
                                   c.nu, c.levels > 0 ? "_hanging" : ""),
                       std::abs(ratio - 1), ratio < 1 ? 0.03 : 0.02, 0.01});
  }
  return results;
}
} // namespace

std::vector<Case> cantilever_cases()
{
  const std::string text = "cantilever 10 : 1, plane strain, six cells across: tip against theory";
  return {{"cantilever", text, false,
           [] {
             return measure("cantilever", {{0.3}, {0.45}, {0.49}, {0.49, true}});
           }},
          {"cantilever_coupled", text + "; coupled, hanging nodes", true, [] {
             return measure("cantilever_coupled",
                            {{0.3, true}, {0.45, true}, {0.49, true}, {0.49, true, 4, 1}});
           }}};
}
} // namespace ligament::program
