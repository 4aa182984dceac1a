// Faces that soften: the energy that a crack takes, and how much notched beams bear.
#include "src/verification/cases/softening.h"
#include "core/extremes.h"

#include "src/verification/instruments/breaking_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace ligament::program
{
namespace
{
constexpr double strength = 1e-3; // of E

struct Sample
{
  std::string name;
  int dimension;
  PackingKind packing;
  double degrees; // lattices
  int seed;       // random packings
};

/// Of this size in spacings; faces soften over a characteristic length E G_c/f_t^2 of `length`.
Scene softening_scene(const Sample &sample, const Point &size, double length)
{
  Scene scene = unit_scene(sample.dimension, size, 0.2);
  scene.zone.packing = sample.packing;
  scene.zone.orientation[0] = sample.degrees * M_PI / 180;
  scene.zone.seed = sample.seed;
  FractureParameters &fracture = scene.material.fracture;
  fracture.criterion = Criterion::maximum_tension;
  fracture.strength = strength;
  fracture.energy = length * strength * strength;
  return scene;
}

LoadParameters moving(int boundary, double velocity)
{
  LoadParameters load;
  load.boundary = boundary;
  load.kind = LoadKind::velocity;
  load.value[1] = velocity;
  load.velocity = load.value;
  return load;
}

/// The plane that lies nearest to the broken faces, across the (x, y) plane: cracks follow rows,
/// and their area is that which they have on their own way.
template <int dim>
Vector<dim> crack_normal(const std::vector<particles::BrokenBond<dim>> &broken)
{
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const auto &b : broken) {
    const double w = b.area, x = b.position[0], y = b.position[1];
    n += w, sx += w * x, sy += w * y, sxx += w * x * x, sxy += w * x * y;
  }
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  Vector<dim> normal = Vector<dim>::Unit(1) - slope * Vector<dim>::Unit(0);
  return normal.normalized();
}

/// Energy that the broken faces took, over G_c times their area as seen across the crack. A plate
/// of 2.5 by 3 characteristic lengths, notched over 0.45 of its width, whose arms are drawn apart
/// until 0.6 of the rest is broken.
template <int dim>
double work_per_area(const Sample &sample, double length)
{
  const double width = 2.5 * length, height = 3 * length, notch = 0.45 * width;
  Scene scene = softening_scene(sample, {width, height, 6}, length);
  constexpr double off_the_middle = 0.23;
  scene.specimen.cracks = {{{{-width, off_the_middle, 0}, {notch - width / 2, off_the_middle, 0}}}};
  if (dim == 3) {
    const double left = -width, tip = notch - width / 2, y = off_the_middle, z = 6;
    scene.specimen.cracks[0].points = {{left, y, -z}, {tip, y, -z}, {tip, y, z}, {left, y, z}};
  }
  const double duration = 100 * height, energy = *scene.material.fracture.energy,
               stroke = 4 * (2.2 * energy / strength + height * strength);
  for (const int arm : {-1, 1}) {
    LoadParameters load = moving(0, arm * 0.5 * stroke / duration);
    load.ramp = 0.05 * duration;
    (arm < 0 ? load.within.upper : load.within.lower)[1] = arm * 0.1 * height;
    scene.loads.push_back(load);
  }
  scene.damping.mass = 0.5 / height;
  BreakingRun<dim> run(scene);
  const auto &broken = run.body().force()->broken_bonds();
  const double wanted = 0.6 * (width - notch) * (dim == 3 ? scene.specimen.size[2] : 1);
  while (run.time() < duration) {
    run.step();
    if (broken.empty())
      continue;
    const Vector<dim> normal = crack_normal<dim>(broken);
    double area = 0, taken = 0;
    for (const auto &b : broken) {
      area += b.area * std::abs(b.normal.dot(normal));
      taken += b.energy;
    }
    if (area > wanted)
      return taken / (area * energy);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::vector<Result> work_results(const std::string &name, const std::vector<Sample> &samples,
                                 double length)
{
  std::vector<Result> results;
  for (const Sample &sample : samples) {
    const double work =
        sample.dimension == 2 ? work_per_area<2>(sample, length) : work_per_area<3>(sample, length);
    results.push_back({fmt::format("{}/{}", name, sample.name), std::abs(work - 1), 0.05, 0.02});
  }
  return results;
}

Sample turned(double degrees)
{
  return {fmt::format("hexagonal_{:g}", degrees), 2, PackingKind::hexagonal, degrees, 0};
}
Sample random_sample(int seed)
{
  return {fmt::format("random_{}", seed), 2, PackingKind::random, 0, seed};
}

std::vector<Sample> all_samples()
{
  std::vector<Sample> samples;
  for (double degrees = 0; degrees <= 30; degrees += 5)
    samples.push_back(turned(degrees));
  for (int seed = 1; seed <= 4; ++seed)
    samples.push_back(random_sample(seed));
  return samples;
}

/// A beam with a notch of 0.3 of its depth in three-point bending over a span of 2.5 depths, plane
/// stress, as of concrete: two straight lines of softening.
struct Beam
{
  Sample sample;
  double depth;  // spacings
  double length; // E G_c/f_t^2 in spacings
};

/// Length of what the cut breaks as seen along the beam: where a notch ends between two faces is a
/// matter of the packing, and counts twice in the section that is left.
double notch_of(const CoupledBody<2> &body)
{
  double sum = 0;
  for (const auto &face : body.cut_faces)
    sum += face.size * std::abs(face.normal[0]);
  return sum;
}

/// Largest nominal stress 3 P S/(2 (D - a)^2) of the section that the notch leaves over the
/// strength.
double nominal_strength(const Beam &beam)
{
  const double depth = beam.depth, span = 2.5 * depth, part = 0.04 * depth, notch = 0.3 * depth;
  Scene scene = softening_scene(beam.sample, {span + 0.4 * depth, depth, 0}, beam.length);
  scene.plane = PlaneMode::stress;
  scene.material.fracture.softening = SofteningCurve::bilinear;
  constexpr double beside = 0.01; // of particles that lie on the axis
  scene.specimen.cracks = {{{{beside, -depth, 0}, {beside, notch - depth / 2, 0}}}};
  const double crossings = 120, duration = crossings * depth,
               elastic = strength * span * span / (6 * depth),
               stroke = 1.5 * elastic + 4 * beam.length * strength;
  for (const int place : {-1, 0, 1}) {
    LoadParameters load = moving(place == 0 ? 3 : 2, place == 0 ? -stroke / duration : 0);
    load.ramp = 0.1 * duration;
    load.from = place * span / 2 - part;
    load.to = place * span / 2 + part;
    scene.loads.push_back(load);
  }
  scene.damping.mass = 0.3 / depth;
  BreakingRun<2> run(scene);
  const double left = depth - notch_of(run.body());
  double peak = 0;
  while (run.time() < duration) {
    run.step();
    const auto &force = *run.body().force();
    const double load = force.reaction(0)[1] + force.reaction(2)[1];
    keep_largest(peak, load);
    if (peak > 0 && load < 0.7 * peak && run.time() > 0.2 * duration)
      return 1.5 * peak * span / (left * left) / strength;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// The spacing halved twice in one beam of one characteristic length: difference to the finest, of
/// the mean over random packings.
std::vector<Result> beams_of_spacings()
{
  const std::vector<std::pair<std::string, std::vector<Sample>>> groups = {
      {"hexagonal", {turned(0)}},
      {"random", {random_sample(1), random_sample(2), random_sample(3), random_sample(4)}}};
  std::vector<Result> results;
  for (const auto &[name, samples] : groups) {
    std::map<int, double> mean;
    for (const int length : {20, 40, 80})
      for (const Sample &sample : samples)
        mean[length] += nominal_strength({sample, double(length), double(length)}) / samples.size();
    for (const int length : {20, 40})
      results.push_back({fmt::format("law_cohesive_beams/{}_{}", name, length),
                         std::abs(mean[length] / mean[80] - 1), 0.03, 0.01});
  }
  return results;
}

/// Beams of 0.5, 1 and 2 characteristic lengths: how far 1/sigma_N^2 of the middle one lies off the
/// straight line over the depth through the other two, theory.md section 1.13, as a strength.
std::vector<Result> beams_of_sizes()
{
  std::vector<Result> results;
  for (const Sample &sample : {turned(0), random_sample(1)}) {
    constexpr double length = 40;
    double inverse[3];
    int k = 0;
    for (const double depth : {20., 40., 80.})
      inverse[k++] = std::pow(nominal_strength({sample, depth, length}), -2);
    const double on_the_line = inverse[0] + (inverse[2] - inverse[0]) / 3;
    results.push_back({"law_cohesive_sizes/" + sample.name,
                       std::abs(std::sqrt(on_the_line / inverse[1]) - 1), 0.03, 0.01});
    // What no effect and that of a sharp crack alone, 1 and 2, would pass.
    constexpr double of_a_line = 1.471 / 0.971; // tests/oracle/cohesive_beam.h
    results.push_back({"law_cohesive_sizes/" + sample.name + "_smallest_over_largest",
                       std::abs(std::sqrt(inverse[2] / inverse[0]) / of_a_line - 1), 0.1, 0.03});
  }
  return results;
}
} // namespace

std::vector<Case> softening_cases()
{
  const auto work_case = [](const std::string &name, const std::string &text, bool slow,
                            std::vector<Sample> samples, double length) {
    return Case{name, "work of a cohesive crack over G_c times its area: " + text, slow,
                [=] { return work_results(name, samples, length); }};
  };
  const Sample fcc = {"fcc", 3, PackingKind::fcc, 0, 0};
  return {
      work_case("law_cohesive_crack", "E G_c/f_t^2 of 20 d", false,
                {turned(0), turned(30), random_sample(1)}, 20),
      work_case("law_cohesive_crack_20", "every packing, 20 d", true, all_samples(), 20),
      work_case("law_cohesive_crack_40", "every packing, 40 d", true, all_samples(), 40),
      work_case("law_cohesive_crack_80", "80 d", true,
                {turned(0), turned(15), turned(30), random_sample(1)}, 80),
      work_case("law_cohesive_crack_3d", "FCC, 20 d", true, {fcc}, 20),
      {"law_cohesive_beams", "peak load of a notched beam, the spacing halved twice", true,
       beams_of_spacings},
      {"law_cohesive_sizes", "peak loads of notched beams of three sizes", true, beams_of_sizes}};
}
} // namespace ligament::program
