// Flow that softens gathers in a band: the energy that it takes there.
#include "src/verification/cases/flow.h"

#include "src/verification/instruments/breaking_run.h"

#include <cmath>

namespace ligament::program
{
namespace
{
struct Sample
{
  std::string name;
  int dimension;
  PackingKind packing;
  double degrees; // lattices in the plane
  int seed;       // random packings
};

constexpr double length = 20;   // E G/Y^2, spacings
constexpr double height = 10;   // spacings: lower than what would snap back
constexpr double cohesion = 1e-3; // of E

/// Energy that flow took, over the given one times the section of a body that is sheared along x
/// between two plates, until nothing is left of its cohesion. A layer in the middle is weaker by 2 %.
template <int dim>
double energy_per_area(const Sample &sample)
{
  const double width = dim == 2 ? 24 : 8, section = dim == 2 ? width : width * width;
  Scene scene = unit_scene(dim, {width, height, width}, 0.2);
  scene.zone.packing = sample.packing;
  scene.zone.orientation[dim == 2 ? 0 : 2] = sample.degrees * M_PI / 180;
  scene.zone.seed = sample.seed;
  PlasticityParameters flow;
  flow.law = PlasticityLaw::drucker_prager;
  flow.cohesion = cohesion;
  flow.friction_angle = 0;
  const double yield = flow.shear_strength(), energy = length * yield * yield;
  flow.softening_energy = energy;
  scene.material.plasticity = flow;
  Inclusion weak;
  weak.material = scene.material;
  weak.material.plasticity->cohesion = 0.98 * cohesion;
  weak.boxes.push_back({{-width, -0.5, -width}, {width, 0.5, width}});
  scene.inclusions.push_back(weak);
  // Ends that stand still across the shear, as if the body went on.
  for (const int side : {0, 1, 4, 5}) {
    if (side / 2 >= dim)
      continue;
    LoadParameters smooth;
    smooth.boundary = side;
    smooth.kind = LoadKind::velocity;
    smooth.value[1] = 0;
    smooth.velocity = smooth.value;
    scene.loads.push_back(smooth);
  }
  const double modulus = 1 / 2.4, stroke = 1.3 * (2 * energy / yield + height * yield / modulus),
               duration = 300 * height;
  for (const int side : {2, 3}) {
    LoadParameters plate;
    plate.boundary = side;
    plate.kind = LoadKind::velocity;
    plate.ramp = 0.05 * duration;
    plate.value[0] = (side == 2 ? -0.5 : 0.5) * stroke / duration;
    plate.value[1] = 0;
    plate.velocity = plate.value;
    scene.loads.push_back(plate);
  }
  scene.damping.mass = 1 / height;
  BreakingRun<dim> run(scene);
  while (run.time() < duration)
    run.step();
  return run.body().force()->losses().plastic / (energy * section);
}

std::vector<Result> bands()
{
  std::vector<Result> results;
  for (const Sample &s : {Sample{"square", 2, PackingKind::square, 0, 0},
                          Sample{"hexagonal_0", 2, PackingKind::hexagonal, 0, 0},
                          Sample{"hexagonal_15", 2, PackingKind::hexagonal, 15, 0},
                          Sample{"hexagonal_30", 2, PackingKind::hexagonal, 30, 0},
                          Sample{"random_1", 2, PackingKind::random, 0, 1},
                          Sample{"random_2", 2, PackingKind::random, 0, 2},
                          Sample{"fcc", 3, PackingKind::fcc, 0, 0},
                          Sample{"random_3d", 3, PackingKind::random, 0, 1}})
    results.push_back(
        {"law_flow_band/" + s.name,
         std::abs((s.dimension == 2 ? energy_per_area<2>(s) : energy_per_area<3>(s)) - 1), 0.05,
         0.02});
  return results;
}
} // namespace

std::vector<Case> flow_band_cases()
{
  return {{"law_flow_band", "energy of a band in which the cohesion goes, over the given one", true,
           bands}};
}
} // namespace ligament::program
