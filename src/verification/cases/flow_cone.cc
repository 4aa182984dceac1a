// Drucker and Prager's flow with dilatancy: peak and swelling under triaxial compression, the mean
// stress at the apex.
#include "src/verification/cases/flow.h"

#include "src/verification/instruments/breaking_run.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
constexpr double nu = 0.25, cohesion = 1e-3, friction = M_PI / 6, dilatancy = M_PI / 18;
constexpr double pressure = 1e-3;
constexpr int edge = 6; // spacings
constexpr double drag = 0.02, ramp = 2e4;

struct Body
{
  std::string name;
  PackingKind packing;
  double size; // of the cube, in spacings
};

std::vector<Body> bodies()
{
  return {{"simple_cubic", PackingKind::simple_cubic, edge},
          {"fcc", PackingKind::fcc, edge},
          {"random", PackingKind::random, edge}};
}

Scene cube(const Body &body)
{
  Scene scene = unit_scene(3, {body.size, body.size, body.size}, nu);
  scene.zone.packing = body.packing;
  scene.damping.mass = drag;
  PlasticityParameters flow;
  flow.law = PlasticityLaw::drucker_prager;
  flow.cohesion = cohesion;
  flow.friction_angle = friction;
  flow.dilatancy_angle = dilatancy;
  scene.material.plasticity = flow;
  return scene;
}

/// Of the side along its normal, outward.
LoadParameters motion(int side, double value)
{
  LoadParameters load;
  load.boundary = side;
  load.kind = LoadKind::displacement;
  load.value[side / 2] = (side % 2 ? 1 : -1) * value;
  load.displacement = load.value;
  return load;
}

/// Mean gradient of the displacement, by least squares over all particles.
Eigen::Matrix3d mean_gradient(const particles::Particles<3> &p)
{
  Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, 3, 4> products = Eigen::Matrix<double, 3, 4>::Zero();
  for (int i = 0; i < p.size(); ++i) {
    Eigen::Vector4d x;
    x << get(p.reference, i), 1;
    squares += x * x.transpose();
    products += get(p.displacement, i) * x.transpose();
  }
  return (products * squares.inverse()).leftCols<3>();
}

/// Confined, then pressed along z at constant confinement: peak of the axial stress over that of
/// Coulomb's cone, and swelling per shortening over the law's.
std::vector<Result> triaxial()
{
  std::vector<Result> results;
  constexpr double shortening = 0.02, measured_from = 0.75;
  const double n = (1 + std::sin(friction)) / (1 - std::sin(friction)),
               peak = pressure * n + 2 * cohesion * std::sqrt(n),
               swelling = 2 * std::sin(dilatancy) / (1 - std::sin(dilatancy));
  for (const Body &body : bodies()) {
    Scene scene = cube(body);
    // Smooth walls opposite the pressures: between dead pressures alone a body turns round.
    for (const int side : {0, 2, 4})
      scene.loads.push_back(motion(side, 0));
    for (const int side : {1, 3}) {
      LoadParameters load;
      load.boundary = side;
      load.kind = LoadKind::traction;
      load.value[side / 2] = -pressure;
      load.traction = load.value;
      load.ramp = ramp / 10;
      scene.loads.push_back(load);
    }
    LoadParameters press = motion(5, -shortening * body.size);
    press.history.table = {{ramp / 10, 0}, {1.1 * ramp, 1}};
    scene.loads.push_back(press);
    BreakingRun<3> run(scene);
    const auto &state = run.body().zone->state;
    while (run.time() < ramp * (0.1 + measured_from))
      run.step();
    const Eigen::Matrix3d before = mean_gradient(state);
    while (run.time() < 1.1 * ramp)
      run.step();
    const Eigen::Matrix3d change = mean_gradient(state) - before;
    while (run.time() < 1.1 * ramp + 1000)
      run.step();
    const double stress = -run.body().force()->reaction(5)[2] / (body.size * body.size);
    const std::string name = "law_flow_triaxial/" + body.name;
    results.push_back({name + "_peak", std::abs(stress / peak - 1), 5e-3, 1e-3});
    results.push_back(
        {name + "_dilatancy", std::abs(-change.trace() / change(2, 2) / swelling - 1), 5e-3, 1e-3});
  }
  return results;
}

/// Pulled along all axes until no shear is left: the mean stress that the cone bears.
std::vector<Result> apex()
{
  std::vector<Result> results;
  const double largest = cohesion / std::tan(friction);
  for (const Body &body : bodies()) {
    Scene scene = cube(body);
    for (int side = 0; side < 6; ++side) {
      // Four times the strain at the apex, more along x first: the flank is met before it.
      LoadParameters load = motion(side, (side < 2 ? 3e-3 : 2e-3) * body.size);
      load.ramp = ramp;
      scene.loads.push_back(load);
    }
    BreakingRun<3> run(scene);
    while (run.time() < ramp + 1000)
      run.step();
    double worst = 0;
    for (int side = 0; side < 6; ++side) {
      const double force = run.body().force()->reaction(side)[side / 2];
      keep_largest(worst, std::abs(std::abs(force) / (body.size * body.size) / largest - 1));
    }
    results.push_back({"law_flow_apex/" + body.name, worst, 5e-3, 1e-3});
  }
  return results;
}
} // namespace

std::vector<Case> flow_cone_cases()
{
  return {{"law_flow_triaxial", "peak and dilatancy of a cone under confinement", false, triaxial},
          {"law_flow_apex", "the mean stress that a cone bears", false, apex}};
}
} // namespace ligament::program
