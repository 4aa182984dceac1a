// What a side that lets waves out answers to a load that stays.
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
constexpr double length = 160, width = 16, cell_size = 4;

enum class Models
{
  mesh,
  particles
};

constexpr std::array<const char *, 2> model_names = {"mesh", "particles"};

/// The left end moves with the velocity 1 from now on, along x (P) or y (S); the other sides are
/// mirrors, so that the wave stays plane.
Scene strip(Models models, bool is_p, double layer)
{
  Scene scene = unit_scene(2, {length, width, 0}, 0.3);
  if (models == Models::mesh) {
    scene.zone.extent = DiscreteZone::Extent::none;
    scene.far_field.emplace().cell_size = cell_size;
  }
  for (const int side : {0, 2, 3}) {
    LoadParameters &load = scene.loads.emplace_back();
    load.boundary = side_names[side];
    load.kind = side == 0 ? "velocity" : "displacement";
    load.value[is_p == (side == 0) ? 0 : 1] = side == 0 ? 1e-6 : 0;
  }
  scene.loads.front().ramp = 10 * cell_size;
  LoadParameters &end = scene.loads.emplace_back();
  end.boundary = "right";
  end.kind = "traction";
  end.absorbing = true;
  end.absorbing_layer = layer;
  return scene;
}

/// Mean load on the left end over rho c v A, less 1, in the last of `passages` ways there and back.
double error_of_load(Models models, bool is_p, double layer, int passages)
{
  UnitBody<2> unit(strip(models, is_p, layer));
  auto &body = unit.body;
  const double c11 = 1.3461538461538463, c44 = 1 / 2.6; // E = 1, nu = 0.3, plane strain
  const double speed = std::sqrt(is_p ? c11 : c44), way = 2 * length / speed;
  auto bodies = body.bodies();
  coupling::StepTime step;
  step.dt = body.dt;
  double sum = 0;
  long n = 0;
  for (; step.time < passages * way; step.time = double(++step.step) * step.dt) {
    body.coupler->compute_forces(bodies, step);
    if (step.time > (passages - 1) * way) {
      Vector<2> load = Vector<2>::Zero();
      if (body.zone)
        load += body.force()->reaction(0);
      if (body.far)
        load += body.far->reaction(0);
      sum += load[is_p ? 0 : 1];
      ++n;
    }
    body.coupler->kick(bodies, step);
    body.coupler->drift(bodies, step);
  }
  return sum / double(n) / (speed * 1e-6 * width) - 1;
}

std::vector<Result> measure(const std::string &name, Models models,
                            const std::vector<double> &layers)
{
  std::vector<Result> results;
  for (const double layer : layers)
    for (const bool is_p : {true, false})
      results.push_back({fmt::format("{}/{}_{}{}", name, model_names[int(models)], is_p ? "P" : "S",
                                     layer > 0 ? "_layer" : ""),
                         std::abs(error_of_load(models, is_p, layer, 5)), 1e-3, 1e-4});
  return results;
}
} // namespace

std::vector<Case> absorbing_steady_cases()
{
  return {{"absorbing_steady",
           "end moved with a steady velocity, fifth passage: load against rho c v A; mesh", false,
           [] {
             return measure("absorbing_steady", Models::mesh, {0, 16 * cell_size});
           }},
          {"absorbing_steady_zone", "the same, hexagonal packing", true, [] {
             return measure("absorbing_steady_zone", Models::particles, {0, 16 * cell_size});
           }}};
}
} // namespace ligament::program
