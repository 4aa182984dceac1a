// Gauges on bodies whose answer is known: J of a long strip and of a cracked plate.
#include "src/scene/geometry.h"
#include "src/simulation/gauges/gauge_set.h"
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases.h"
#include "src/verification/instruments/linear_motion.h"

#include <fmt/format.h>

#include <cmath>

namespace ligament::program
{
namespace
{
constexpr double nu = 0.3, small = 1e-9; // strains: what is of second order is below round-off

/// J around a tip of a crack that grows along x, in d.
GaugeParameters ring(const std::string &name, const Box &outer, const Box &inner)
{
  GaugeParameters gauge;
  gauge.name = name;
  gauge.kind = GaugeKind::j_integral;
  gauge.direction = {1, 0, 0};
  gauge.lower = outer.lower;
  gauge.upper = outer.upper;
  gauge.inner_lower = inner.lower;
  gauge.inner_upper = inner.upper;
  return gauge;
}

Box box(double left, double bottom, double right, double top)
{
  return {{left, bottom, 0}, {right, top, 0}};
}

/// J and K of all gauges in equilibrium at full loads.
struct Measured
{
  explicit Measured(const Scene &scene)
  {
    UnitBody<2> unit(scene);
    LinearMotion<2>(unit.body).solve();
    values = GaugeSet<2>(scene, unit.body).read(unit.body, 1);
    for (const BrokenBond &face : unit.body.cut_faces)
      cut += face.size * std::abs(face.normal[1]);
  }
  std::vector<double> values;
  double cut = 0; // length of the faces that are cut, along x
};

/// A strip of height H between smooth grips, cut in the middle up to x = 0: what the part ahead
/// stores and that behind doesn't is released, G = E'/2 (u/H)^2 H. Three heights ahead and behind
/// the ends are not felt: fields decay by exp(-pi) per height.
std::vector<Result> strip(const std::string &name)
{
  const double height = 40, half_length = 120, stretch = small * height;
  std::vector<Result> results;
  for (const PackingKind packing : {PackingKind::hexagonal, PackingKind::random}) {
    Scene scene = unit_scene(2, {2 * half_length, height, 0}, nu);
    scene.zone.packing = packing;
    scene.specimen.cracks = {{{{-half_length - 1, 0, 0}, {0, 0, 0}}}};
    for (const int side : {2, 3}) {
      LoadParameters &grip = scene.loads.emplace_back();
      grip.boundary = side;
      grip.kind = LoadKind::displacement;
      grip.ramp = 1;
      grip.value[1] = (side == 3 ? 0.5 : -0.5) * stretch;
      grip.displacement = grip.value;
    }
    scene.gauges = {ring("near", box(-12, -12, 12, 12), box(-5, -5, 5, 5)),
                    ring("wide", box(-45, -18, 40, 18), box(-20, -8, 20, 8))};
    const double released = std::pow(stretch / height, 2) * height / (2 * (1 - nu * nu));
    const Measured measured(scene);
    const std::vector<double> &v = measured.values;
    const std::string start = fmt::format("{}/{}_", name, word_of(packing));
    results.push_back({start + "j_near", std::abs(v[0] / released - 1), 0.02, 0.005});
    results.push_back({start + "j_wide", std::abs(v[2] / released - 1), 0.02, 0.005});
    results.push_back({start + "paths", std::abs(v[2] / v[0] - 1), 0.01, 0.002});
  }
  return results;
}

/// A plate with a central crack of half its width, pulled at its far ends: K = s sqrt(pi a)
/// (1 - 0.025 r^2 + 0.06 r^4) sqrt(sec(pi r/2)), r = 2a/W (Tada 1973, to 0.1 %). One path lies
/// among particles, one goes through overlaps and the far field. The crack is as long as the faces
/// that it cuts; where between two particles its tip is, nobody can say: d/4 of a, half of that of
/// K.
std::vector<Result> plate(const std::string &name)
{
  const double half_width = 80, half_crack = 40;
  std::vector<Result> results;
  for (const PackingKind packing : {PackingKind::hexagonal, PackingKind::random}) {
    Scene scene = unit_scene(2, {2 * half_width, 6 * half_width, 0}, nu);
    add_far_field(scene, {0, 120, 0}, 4.1);
    scene.zone.packing = packing;
    scene.specimen.cracks = {{{{-half_crack, 0, 0}, {half_crack, 0, 0}}}};
    add_tractions<2>(scene, {2, 3}, {0, small, 0});
    scene.gauges = {ring("near", box(20, -20, 60, 20), box(32, -8, 48, 8)),
                    ring("far", box(2, -110, 78, 110), box(22, -65, 58, 65))};
    const Measured measured(scene);
    const std::vector<double> &v = measured.values;
    const double a = measured.cut / 2, ratio = a / half_width;
    const double k = small * std::sqrt(M_PI * a) *
                     (1 - 0.025 * std::pow(ratio, 2) + 0.06 * std::pow(ratio, 4)) /
                     std::sqrt(std::cos(M_PI / 2 * ratio));
    const std::string start = fmt::format("{}/{}_", name, word_of(packing));
    results.push_back({start + "k_near", std::abs(v[1] / k - 1), 0.02, 0.01});
    results.push_back({start + "k_far", std::abs(v[3] / k - 1), 0.02, 0.01});
    results.push_back({start + "paths_j", std::abs(v[2] / v[0] - 1), 0.01, 0.005});
  }
  return results;
}
} // namespace

std::vector<Case> lab_gauges_cases()
{
  return {{"lab_gauges_strip", "J of a strip between grips against what it releases", false,
           [] { return strip("lab_gauges_strip"); }},
          {"lab_gauges_plate", "K by J of a coupled plate with a central crack against Tada", false,
           [] { return plate("lab_gauges_plate"); }}};
}
} // namespace ligament::program
