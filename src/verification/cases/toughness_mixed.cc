// Mixed mode: the peak load of plates with an inclined crack, on any packing the same.
#include "core/extremes.h"
#include "src/simulation/overlap_guard.h"
#include "src/verification/cases.h"
#include "src/verification/instruments/breaking_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace ligament::program
{
namespace
{
constexpr double width = 40e-3, height = 100e-3, half_crack = 10e-3, inclination = M_PI / 6,
                 toughness = 0.75e6, spacing = 0.5e-3;

/// The glass plate of the straight cracks (toughness.cc), coupled.
struct InclinedPlate
{
  std::string packing;
  double degrees = 0; // lattices
  int seed = 1;       // random packings
  /// Of the crack's middle from the plate's, in spacings: no place of the calibration.
  Vector<2> shift = {0.2, 0.35};
};

Scene pulled_plate(const InclinedPlate &plate)
{
  Scene scene = unit_scene(2, {width, height, 0}, 0.22);
  scene.material.youngs_modulus = 72e9;
  scene.material.density = 2450;
  scene.material.fracture.criterion = Criterion::maximum_tension;
  scene.material.fracture.toughness = toughness;
  scene.zone.packing = named<PackingKind>(plate.packing);
  scene.zone.orientation[0] = plate.degrees * M_PI / 180;
  scene.zone.seed = plate.seed;
  scene.zone.size_ratio = scene.zone.is_irregular() ? 2 : 1;
  scene.zone.spacing = spacing;
  const double x = plate.shift[0] * spacing, y = plate.shift[1] * spacing;
  const double along = half_crack * std::cos(inclination), up = half_crack * std::sin(inclination);
  scene.specimen.cracks = {{{{x - along, y - up, 0}, {x + along, y + up, 0}}}};
  add_far_field(scene, {0, 35.2e-3, 0}, 2.07e-3);
  scene.far_field->levels = 1;
  scene.coupling.fine_damper = 8;
  scene.coupling.gap_filter = 4;
  scene.coupling.step_ratio = 4;
  add_pull(scene, 1, 3.3e-3, 0.4e-3);
  return scene;
}

/// K of mode I that a kink in the direction of the largest hoop stress has (Erdogan and Sih), per
/// Pa of tension; the width counts as for a straight crack.
double estimate(double half_length)
{
  const double k = std::sqrt(M_PI * half_length / std::cos(M_PI * half_length / width));
  const double k1 = k * std::pow(std::cos(inclination), 2),
               k2 = k * std::sin(inclination) * std::cos(inclination);
  const double kink = 2 * std::atan((k1 - std::hypot(k1, std::sqrt(8.) * k2)) / (4 * k2));
  const double half = std::cos(kink / 2);
  return half * (k1 * half * half - 1.5 * k2 * std::sin(kink));
}

/// m: half of what the cut breaks, seen across the crack.
double half_length(const std::vector<BrokenBond> &cut_faces)
{
  double sum = 0;
  for (const BrokenBond &face : cut_faces)
    sum += face.size * std::abs(face.normal[1] * std::cos(inclination) -
                                face.normal[0] * std::sin(inclination));
  return sum / 2;
}

struct Peak
{
  double stress = std::numeric_limits<double>::quiet_NaN(); // Pa, the largest
  double over_estimate = stress;                            // K_eff of it over K_Ic
};

/// Until the load has fallen to half. Not a number when it does not, or when `run` would stop.
Peak break_plate(const InclinedPlate &plate)
{
  BreakingRun<2> run(pulled_plate(plate));
  const auto &body = run.body();
  OverlapGuard<2> guard(body);
  double peak = 0;
  while (run.time() < 5e-3) {
    run.step();
    if (guard.look(body, run.time()))
      return {};
    double load = 0;
    for (const int end : {0, 1})
      load +=
          (end == 0 ? -0.5 : 0.5) * (body.force()->reaction(end)[1] + body.far->reaction(end)[1]);
    keep_largest(peak, load);
    if (load < peak / 2 && !body.force()->broken_bonds().empty()) {
      const double stress = peak / (width * body.thickness);
      return {stress, stress * estimate(half_length(body.cut_faces)) / toughness};
    }
  }
  return {};
}

std::vector<Result> spread(const std::string &name, const std::vector<InclinedPlate> &plates)
{
  const double n = double(plates.size());
  double least = std::numeric_limits<double>::infinity(), largest = 0;
  double sum = 0, squares = 0, over_estimate = 0; // not a number as soon as one plate's is not
  for (const InclinedPlate &plate : plates) {
    const Peak peak = break_plate(plate);
    keep_smallest(least, peak.stress);
    keep_largest(largest, peak.stress);
    sum += peak.stress;
    squares += peak.stress * peak.stress;
    over_estimate += peak.over_estimate / n;
  }
  const double mean = sum / n, variance = squares / n - mean * mean;
  return {{name + "/largest_over_least", std::isnan(sum) ? sum : largest / least - 1, 0.08, 0.04},
          {name + "/standard_deviation", std::sqrt(std::max(variance, 0.)) / mean, 0.04, 0.02},
          {name + "/mean_over_estimate", over_estimate, 0.9, 0.95, Result::Bound::at_least},
          {name + "/mean_over_estimate/at_most", over_estimate, 1.1, 1.05}};
}

InclinedPlate turned(double degrees, double tip)
{
  InclinedPlate plate;
  plate.packing = "hexagonal";
  plate.degrees = degrees;
  plate.shift = {0.2 + tip, 0.35};
  return plate;
}

InclinedPlate random_plate(int seed)
{
  InclinedPlate plate;
  plate.packing = "random";
  plate.seed = seed;
  return plate;
}

std::vector<InclinedPlate> some_plates()
{
  std::vector<InclinedPlate> plates;
  for (const double degrees : {0, 15, 30})
    plates.push_back(turned(degrees, 0));
  for (int seed = 401; seed <= 405; ++seed)
    plates.push_back(random_plate(seed));
  return plates;
}

/// A crack off the axes of the plate has no mirror image: the lattice turns by its full 60 degrees.
std::vector<InclinedPlate> many_plates()
{
  std::vector<InclinedPlate> plates;
  for (double degrees = 0; degrees < 60; degrees += 5)
    for (const double tip : {0., 1 / 3., 2 / 3.})
      plates.push_back(turned(degrees, tip));
  for (int seed = 401; seed <= 410; ++seed)
    plates.push_back(random_plate(seed));
  return plates;
}

Case plates_case(const std::string &name, const std::string &text,
                 std::vector<InclinedPlate> (*plates)())
{
  return {name, "peak load of plates with a crack inclined by 30 degrees: " + text, true,
          [=] { return spread(name, plates()); }};
}
} // namespace

std::vector<Case> toughness_mixed_cases()
{
  return {plates_case("toughness_mixed", "hexagonal at 0, 15, 30 degrees, five random packings",
                      some_plates),
          plates_case("toughness_mixed_places",
                      "hexagonal at 0 to 55 degrees, three tips each, ten random packings",
                      many_plates)};
}
} // namespace ligament::program
