// A bar in tension with free sides that yields: the force on its ends against the continuum.
#include "src/verification/cases/flow.h"

#include "src/verification/instruments/breaking_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
constexpr double nu = 0.3, yield = 2e-3, hardening = 0.1, strain = 0.01;
constexpr double ramp = 2e4, rest = 1000; // in travel times of one spacing
constexpr double drag = 0.02;             // mass damping
// Of the layer that does not flow.
constexpr double stiff = 10, stiff_nu = 0.15;

/// Stress along the bar in plane strain: many small steps, each with one radial return, across
/// which the sides are set free by a fixed point.
double plane_strain_stress()
{
  const double g = 1 / (2 * (1 + nu)), lambda = nu / ((1 + nu) * (1 - 2 * nu));
  double total[3] = {}, flow[3] = {}, accumulated = 0, stress[3] = {};
  const auto find_stress = [&] {
    double trace = 0;
    for (int c = 0; c < 3; ++c)
      trace += total[c] - flow[c];
    for (int c = 0; c < 3; ++c)
      stress[c] = 2 * g * (total[c] - flow[c]) + lambda * trace;
  };
  constexpr int n = 5000;
  for (int step = 1; step <= n; ++step) {
    total[0] = strain * step / n;
    for (int k = 0; k < 40; ++k) {
      find_stress();
      total[1] -= stress[1] / (lambda + 2 * g);
      find_stress();
      const double mean = (stress[0] + stress[1] + stress[2]) / 3;
      double square = 0;
      for (const double s : stress)
        square += (s - mean) * (s - mean);
      const double equivalent = std::sqrt(1.5 * square),
                   more = (equivalent - yield - hardening * accumulated) / (3 * g + hardening);
      if (more <= 0)
        continue;
      accumulated += more;
      for (int c = 0; c < 3; ++c)
        flow[c] += 1.5 * more * (stress[c] - mean) / equivalent;
    }
  }
  find_stress();
  return stress[0];
}

/// With all sides free the stress is uniaxial.
double uniaxial_stress()
{
  return (yield + hardening * strain) / (1 + hardening);
}

struct Bar
{
  PackingKind packing;
  int dimension = 2;
  PlaneMode plane = PlaneMode::strain;
  double across = 6; // spacings
  bool has_core = false; // a layer a third of it thick, along the bar, that is stiff and elastic

  bool is_held() const { return dimension == 2 && plane == PlaneMode::strain; }
};

/// Of the continuum. Layers along the bar have one strain along it; across it nothing holds them.
double stress_of(const Bar &bar)
{
  const double flowing = bar.is_held() ? plane_strain_stress() : uniaxial_stress();
  if (!bar.has_core)
    return flowing;
  const double elastic = stiff * strain / (bar.is_held() ? 1 - stiff_nu * stiff_nu : 1);
  return (2 * flowing + elastic) / 3;
}

Scene scene_of(const Bar &bar)
{
  // Twice as long as it is wide, in whole cells.
  Scene scene = unit_scene(bar.dimension, {2 * bar.across, bar.across, bar.across}, nu);
  if (bar.packing == PackingKind::fcc) // rows half a spacing apart lie along y
    for (const int c : {0, 1})
      scene.specimen.size[c] = std::round(scene.specimen.size[c]);
  scene.plane = bar.plane;
  scene.zone.packing = bar.packing;
  scene.damping.mass = drag;
  PlasticityParameters flow;
  flow.law = PlasticityLaw::von_mises;
  flow.yield_stress = yield;
  flow.hardening = hardening;
  scene.material.plasticity = flow;
  if (bar.has_core) {
    Inclusion core;
    core.material = scene.material;
    core.material.plasticity.reset();
    core.material.youngs_modulus *= stiff;
    core.material.poissons_ratio = stiff_nu;
    const double length = scene.specimen.size[0], half = bar.across / 6;
    core.boxes.push_back({{-length, -half, -1}, {length, half, 1}}); // beyond both ends
    scene.inclusions.push_back(core);
  }
  for (const int side : {0, 1}) {
    LoadParameters load;
    load.boundary = side;
    load.kind = LoadKind::displacement;
    load.ramp = ramp;
    load.value[0] = side * strain * scene.specimen.size[0];
    load.displacement = load.value;
    scene.loads.push_back(load);
  }
  return scene;
}

/// Force on the pulled end over that of the continuum, less 1.
template <int dim>
double error_of(const Bar &bar)
{
  const Scene scene = scene_of(bar);
  BreakingRun<dim> run(scene);
  while (run.time() < ramp + rest)
    run.step();
  const double section = bar.across * (dim == 2 ? 1 : scene.specimen.size[1]);
  return std::abs(run.body().force()->reaction(1)[0] / section / stress_of(bar) - 1);
}

/// Rows that end flush with the sides: what is asked of six across.
std::vector<Result> flush_bars()
{
  const std::string name = "law_flow_strip/";
  constexpr double must = 1e-3, aim = 4e-4;
  return {{name + "square_plane_strain", error_of<2>({PackingKind::square}), must, aim},
          {name + "square_plane_stress", error_of<2>({PackingKind::square, 2, PlaneMode::stress}),
           must, aim},
          {name + "simple_cubic", error_of<3>({PackingKind::simple_cubic, 3}), must, aim}};
}

/// Sides that cut cells: how large the error is, and that it falls with the number across. The
/// layers of a lattice lie `layer` spacings apart.
template <int dim>
void add_rough(const std::string &packing, Bar bar, double layer, const std::vector<int> &numbers,
               std::vector<Result> &results)
{
  const std::string name = "law_flow_strip_rough/" + packing;
  std::vector<double> errors;
  for (const int number : numbers) {
    bar.across = number * layer;
    errors.push_back(error_of<dim>(bar));
    results.push_back({fmt::format("{}_{}", name, number), errors.back(), 0.05, {}});
  }
  results.push_back({name + "_last_over_first", errors.back() / errors.front(), 1, {}});
}

std::vector<Result> layered_bars()
{
  const std::string name = "law_flow_layers/";
  constexpr double must = 1e-3;
  std::vector<Result> results;
  for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress})
    results.push_back({name + (plane == PlaneMode::strain ? "square_plane_strain" : "square_plane_stress"),
                       error_of<2>({PackingKind::square, 2, plane, 6, true}), must, {}});
  return results;
}

/// Layers of whole particles: where they end is known to half a spacing on either side.
std::vector<Result> rough_layers()
{
  std::vector<Result> results;
  const auto add = [&](const std::string &packing, PackingKind kind, double row) {
    std::vector<double> errors;
    for (const int number : {12, 24, 48}) {
      errors.push_back(error_of<2>({kind, 2, PlaneMode::strain, number * row, true}));
      results.push_back({fmt::format("law_flow_layers_rough/{}_{}", packing, number),
                         errors.back(), 3. / number, {}});
    }
    results.push_back({fmt::format("law_flow_layers_rough/{}_last_over_first", packing),
                       errors.back() / errors.front(), 0.5, {}});
  };
  add("hexagonal", PackingKind::hexagonal, std::sqrt(3.) / 2);
  add("random", PackingKind::random, 1);
  return results;
}

std::vector<Result> rough_bars()
{
  const double row = std::sqrt(3.) / 2, layer = std::sqrt(0.5);
  std::vector<Result> results;
  add_rough<2>("hexagonal", {PackingKind::hexagonal}, row, {6, 12, 24}, results);
  add_rough<2>("hexagonal_plane_stress", {PackingKind::hexagonal, 2, PlaneMode::stress}, row,
               {6, 12, 24}, results);
  add_rough<2>("random", {PackingKind::random}, 1, {6, 12, 24}, results);
  add_rough<3>("fcc", {PackingKind::fcc, 3}, layer, {6, 12}, results);
  add_rough<3>("random_3d", {PackingKind::random, 3}, 1, {6, 12}, results);
  return results;
}
} // namespace

std::vector<Case> flow_strip_cases()
{
  return {
      {"law_flow_strip", "a bar that yields, six cells across with flush sides", false, flush_bars},
      {"law_flow_strip_rough", "the same whose sides cut cells, by the number across", true,
       rough_bars},
      {"law_flow_layers", "a bar that yields around a stiff layer, sides and layers flush", false,
       layered_bars},
      {"law_flow_layers_rough", "the same whose sides and layers cut cells", true, rough_layers}};
}
} // namespace ligament::program
