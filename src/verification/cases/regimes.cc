// Coupled bodies at large rotation and finite strain.
#include "core/check.h"
#include "core/polar_rotation.h"
#include "particles/orientation.h"
#include "src/simulation/damping.h"
#include "src/simulation/regime_control.h"
#include "src/simulation/test_machine.h"
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases.h"
#include "src/verification/instruments/free_flight.h"
#include "src/verification/instruments/noise_run.h"

#include <Eigen/Geometry>

#include <random>

namespace ligament::program
{
namespace
{
template <int dim>
using Matrix = Eigen::Matrix<double, dim, dim>;

/// A zone inside the specimen (2D) or a band (3D), short transition.
Scene small_scene(int dimension, const std::string &regime)
{
  Scene scene =
      dimension == 2 ? unit_scene(2, {58, 54, 0}, 0.3) : unit_scene(3, {9.3, 8.7, 50}, 0.3);
  add_far_field(scene, dimension == 2 ? Point{32, 30, 0} : Point{0, 0, 25}, 3.1);
  scene.coupling.overlap_cells = dimension == 2 ? 3 : 2;
  scene.coupling.transition_cells = 2;
  scene.coupling.regime = named<RegimeChoice>(regime);
  return scene;
}

/// A body in the regime of its scene.
template <int dim>
struct MovingBody
{
  explicit MovingBody(const Scene &scene) : unit(scene), control(scene.coupling.regime, unit.body)
  {
  }

  /// Everything moves as x = R S X.
  void move(const Matrix<dim> &rotation, const Matrix<dim> &stretch)
  {
    const Matrix<dim> h = rotation * stretch - Matrix<dim>::Identity();
    auto &zone = unit.body.zone->state;
    for (int i = 0; i < zone.size(); ++i) {
      set(zone.displacement, i, Vector<dim>(h * get(zone.reference, i)));
      particles::set_orientation<dim>(zone, i, rotation);
    }
    auto &far = *unit.body.far;
    for (int i = 0; i < far.mesh().n_nodes(); ++i)
      set(far.displacement, i, Vector<dim>(h * far.mesh().nodes[i]));
    auto bodies = unit.body.bodies();
    unit.body.coupler->take_velocities(bodies);
  }

  /// Force on every near node in N, from one kick at rest over a unit step.
  Eigen::MatrixXd near_force()
  {
    auto bodies = unit.body.bodies();
    coupling::StepTime step;
    step.dt = 1;
    unit.body.coupler->compute_forces(bodies, step);
    unit.body.coupler->kick(bodies, step);
    const auto &near = unit.body.coupler->overlap()->near_nodes;
    Eigen::MatrixXd v(near.size(), dim);
    for (std::size_t i = 0; i < near.size(); ++i)
      v.row(i) = get(unit.body.far->velocity, near[i]).transpose();
    return unit.body.coupler->near_mass() * v;
  }

  UnitBody<dim> unit;
  RegimeControl<dim> control;
};

template <int dim>
Matrix<dim> right_angle(std::mt19937 &random)
{
  if constexpr (dim == 2)
    return Eigen::Rotation2Dd(M_PI / 2).toRotationMatrix();
  else {
    std::normal_distribution<double> normal;
    const Vector<3> axis(normal(random), normal(random), normal(random));
    return Eigen::AngleAxisd(M_PI / 2, axis.normalized()).toRotationMatrix();
  }
}

const std::array<std::string, 2> turning_regimes = {"corotated", "nonlinear"};

template <int dim>
std::vector<Result> rotate(const std::string &name)
{
  std::mt19937 random(7);
  double force = 0, energy = 0;
  for (const std::string &regime : turning_regimes) {
    const Scene scene = small_scene(dim, regime);
    MovingBody<dim> moving(scene);
    auto &body = moving.unit.body;
    moving.move(right_angle<dim>(random), Matrix<dim>::Identity());
    const double unit = moving.unit.c11();
    const double h = body.coupler->overlap()->cell_size;
    keep_largest(force, moving.near_force().cwiseAbs().maxCoeff() / (unit * std::pow(h, dim - 1)));
    for (int i = 0; i < body.zone->state.size(); ++i) {
      keep_largest(force, get(body.zone->state.force, i).norm() / unit);
      keep_largest(force, get(body.zone->state.torque, i).norm() / unit);
    }
    for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
      keep_largest(force, get(body.far->force, i).norm() / (unit * std::pow(h, dim - 1)));
    const auto e = body.coupler->energy(body.bodies(), {});
    double volume = 1;
    for (int c = 0; c < dim; ++c)
      volume *= scene.specimen.size[c];
    for (const double part : {e.potential_discrete, e.potential_far, e.blended})
      keep_largest(energy, std::abs(part) / (unit * volume));
  }
  return {{name + "/force", force, 1e-12, {}}, {name + "/energy", energy, 1e-12, {}}};
}

/// A closed overlap (2D), turned and strained uniformly.
std::vector<Result> turned_patch()
{
  std::mt19937 random(7);
  double small = 0, finite = 0;
  Matrix<2> strain;
  strain << 0.8, 0.3, 0.3, -0.5;
  for (const std::string &regime : turning_regimes)
    for (const double size : {1e-5, 0.05}) {
      MovingBody<2> moving(small_scene(2, regime));
      moving.move(right_angle<2>(random), Matrix<2>::Identity() + size * strain);
      const double unit = moving.unit.c11() * moving.unit.body.coupler->overlap()->cell_size;
      const double residual = moving.near_force().rowwise().norm().maxCoeff() / unit;
      keep_largest(size < 1e-3 ? small : finite, size < 1e-3 ? residual : residual / (size * size));
    }
  return {{"patch_turned/residual", small, 1e-12, {}},
          {"patch_turned/second_order", finite, 1e-2, {}}};
}

/// Undamped noise of finite amplitude in the nonlinear regime: slope of the shadow energy, per run.
std::vector<Result> noise(const std::string &name, long n_steps)
{
  MovingBody<2> moving(small_scene(2, "nonlinear"));
  constexpr int terms = 10; // of the shadow energy, as for the small strains of `drift`
  const int interval = int(std::max(12L, n_steps / 4000));
  const auto series = run_noise(moving.unit.body, 1e-3, n_steps, interval, terms);
  const double per_run = double(n_steps) / 1e5;
  return {
      {name + "/trend", course_of(series.shadow, interval).drift * per_run, 1e-6, {}},
      {name + "/leap_frog_trend", course_of(series.leap_frog, interval).drift * per_run, 1e-3, {}}};
}

/// Free flight: starts unstrained, turning about an axis at a speed of 0.05 (of sqrt(E/rho)) at the
/// edge, so that it swings under its centrifugal force.
template <int dim>
std::vector<Result> spin(const std::string &name, const std::string &regime, double turns)
{
  const Scene scene = small_scene(dim, regime);
  MovingBody<dim> moving(scene);
  auto &body = moving.unit.body;
  const double rate =
      0.05 / (*std::max_element(scene.specimen.size.begin(), scene.specimen.size.end()) / 2);
  Spin<dim> omega = Spin<dim>::Zero();
  omega[0] = rate; // 3D: across the band
  const auto velocity = [&](const Vector<dim> &x) { return core::spin_cross(omega, x); };
  auto &zone = body.zone->state;
  for (int i = 0; i < zone.size(); ++i) {
    set(zone.velocity, i, velocity(get(zone.reference, i)));
    set(zone.spin, i, omega);
  }
  for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
    set(body.far->velocity, i, velocity(body.far->mesh().nodes[i]));
  auto bodies = body.bodies();
  body.coupler->take_velocities(bodies);
  const Spin<dim> before = angular_momentum<dim>(body);
  const double energy = energy_change(body, std::lround(turns * 2 * M_PI / rate / body.dt));
  const double momentum = (angular_momentum<dim>(body) - before).norm() / before.norm();
  return {{name + "/energy", energy, 1e-6, {}}, {name + "/angular_momentum", momentum, 1e-10, {}}};
}

/// Load and the axial displacements of a bar pulled by 5 %, at rest.
struct Pulled
{
  double load;
  std::vector<std::pair<Vector<2>, Vector<2>>> motion; // place, displacement of particles
};

Pulled pull(Scene scene)
{
  const double strain = 0.05, half = scene.specimen.size[1] / 2;
  for (const bool upper : {false, true}) {
    LoadParameters load;
    load.boundary = upper ? 3 : 2;
    load.kind = LoadKind::displacement;
    load.value = {0., (upper ? 1 : -1) * strain * half, 0.};
    load.displacement = load.value;
    load.ramp = 400;
    scene.loads.push_back(load);
  }
  scene.damping.kinetic = true;
  scene.coupling.fine_damper = 8;
  UnitBody<2> unit(scene);
  auto &body = unit.body;
  RegimeControl<2> control(scene.coupling.regime, body);
  BodyDamping<2> damping(scene.damping);
  auto bodies = body.bodies();
  coupling::StepTime step;
  step.dt = body.dt;
  body.coupler->compute_forces(bodies, step);
  while (step.time < 2500) {
    damping.before_kick(body, step);
    body.coupler->kick(bodies, step);
    damping.after_kick(body, step);
    body.coupler->drift(bodies, step);
    ++step.step;
    step.time = double(step.step) * step.dt;
    body.coupler->compute_forces(bodies, step);
  }
  Pulled result = {TestMachine<2>(body).read(body, step.time).load, {}};
  for (int i = 0; i < body.zone->state.size(); ++i)
    result.motion.emplace_back(get(body.zone->state.reference, i),
                               get(body.zone->state.displacement, i));
  return result;
}

std::vector<Result> tension()
{
  Scene scene = unit_scene(2, {18, 94, 0}, 0.3);
  const Pulled pure = pull(scene);
  add_far_field(scene, {0, 40, 0}, 3.1);
  scene.coupling.transition_cells = 2;
  scene.coupling.regime = RegimeChoice::nonlinear;
  const Pulled coupled = pull(scene);
  double largest = 0;
  std::size_t n = 0;
  for (const auto &[x, u] : coupled.motion)
    for (const auto &[other_x, other_u] : pure.motion)
      if ((x - other_x).norm() < 1e-6) {
        keep_largest(largest, (u - other_u).norm());
        ++n;
      }
  core::require(2 * n > coupled.motion.size(),
                "most of the coupled particles are none of the pure");
  return {{"tension_5_percent/load", std::abs(coupled.load / pure.load - 1), 3e-3, 1e-3},
          {"tension_5_percent/displacement", largest / (0.05 * 94), 1e-2, 3e-3}};
}
} // namespace

std::vector<Case> regime_cases()
{
  const std::string text = "free flight, starts unstrained with 0.05 of the bar's wave speed, ";
  return {{"rotation_coupled_2d", "closed overlap turned by 90 degrees, corotated and nonlinear",
           false, [] { return rotate<2>("rotation_coupled_2d"); }},
          {"rotation_coupled_3d", "band turned by 90 degrees about random axes, both regimes",
           false, [] { return rotate<3>("rotation_coupled_3d"); }},
          {"patch_turned", "uniform strain of 1e-5 and 5 % in a body turned by 90 degrees", false,
           turned_patch},
          {"spin_2d", text + "corotated, half a turn", false,
           [] { return spin<2>("spin_2d", "corotated", 0.5); }},
          {"spin_long_2d", text + "corotated, 5 turns", true,
           [] { return spin<2>("spin_long_2d", "corotated", 5); }},
          {"spin_long_2d_nonlinear", text + "nonlinear, 2 turns", true,
           [] { return spin<2>("spin_long_2d_nonlinear", "nonlinear", 2); }},
          {"spin_long_3d", text + "FCC, corotated, 1 turn", true,
           [] { return spin<3>("spin_long_3d", "corotated", 1); }},
          {"noise_finite", "undamped noise, strain 1e-3, nonlinear, 5e3 steps", false,
           [] { return noise("noise_finite", 5000); }},
          {"noise_finite_long", "undamped noise, strain 1e-3, nonlinear, 1e5 steps", true,
           [] { return noise("noise_finite_long", 100000); }},
          {"tension_5_percent", "bar pulled by 5 % to rest, nonlinear, against pure DEM", true,
           tension}};
}
} // namespace ligament::program
