#include "src/verification/cases/law_viscous.h"

#include "src/simulation/damping.h"
#include "src/simulation/energy_ledger.h"
#include "src/verification/bodies/unit_bodies.h"

#include <cmath>
#include <limits>

namespace ligament::program
{
namespace
{
constexpr double nu = 0.3, shear = 1 / (2 * (1 + nu)), bulk = 1 / (3 * (1 - 2 * nu));

struct Body
{
  std::string name;
  int dimension;
  PackingKind packing;
  double size = 1;
};
const std::vector<Body> bodies = {
    {"square", 2, PackingKind::square},    {"hexagonal", 2, PackingKind::hexagonal, 2},
    {"random_2d", 2, PackingKind::random}, {"simple_cubic", 3, PackingKind::simple_cubic},
    {"fcc", 3, PackingKind::fcc},          {"random_3d", 3, PackingKind::random}};

/// Sides cut cells in two, whose faces at the plates are eccentric: an error of the outermost
/// particles, which falls with the size. Of small bodies in space most particles are outermost.
bool has_cut_cells(const Body &body)
{
  return body.packing == PackingKind::fcc;
}

/// Between smooth stiff plates, but for the ends along x: uniaxial strain once these move apart.
Scene between_plates(const Body &body, const ViscosityParameters &viscosity)
{
  Point size = body.dimension == 2 ? Point{8, 6, 0} : Point{6, 4, 4};
  for (double &length : size)
    length *= body.size;
  Scene scene = unit_scene(body.dimension, size, nu);
  scene.zone.packing = body.packing;
  scene.material.viscosity = viscosity;
  for (int side = 2; side < 2 * body.dimension; ++side) {
    LoadParameters plate;
    plate.boundary = side;
    plate.kind = LoadKind::displacement;
    plate.value[side / 2] = 0.;
    plate.displacement = plate.value;
    scene.loads.push_back(plate);
  }
  return scene;
}

/// Both ends along x, with half of this each; of a displacement by the course.
void move_ends(Scene &scene, LoadKind kind, double value,
               const std::vector<std::array<double, 2>> &course = {})
{
  for (const int side : {0, 1}) {
    LoadParameters end;
    end.boundary = side;
    end.kind = kind;
    end.value[0] = (side == 0 ? -0.5 : 0.5) * value;
    (kind == LoadKind::velocity ? end.velocity : end.displacement) = end.value;
    end.history.table = course;
    scene.loads.insert(scene.loads.begin() + side, end);
  }
}

template <int dim>
double end_stress(const Scene &scene, const UnitBody<dim> &unit)
{
  double area = dim == 2 ? scene.specimen.thickness : 1;
  for (int c = 1; c < dim; ++c)
    area *= scene.specimen.size[c];
  return unit.body.force()->reaction(1)[0] / area;
}

/// Largest error of the stress at the end of a body that is strained at a constant rate, and of its
/// energy balance: the particles begin with the motion that they keep.
template <int dim>
std::array<double, 2> strain_steadily(const Body &body)
{
  constexpr double rate = 1e-10, duration = 60;
  ViscosityParameters viscosity;
  viscosity.branches = {{0.4, 10}, {0.3, 60}};
  Scene scene = between_plates(body, viscosity);
  move_ends(scene, LoadKind::velocity, rate * scene.specimen.size[0]);
  UnitBody<dim> unit(scene);
  auto &zone = *unit.body.zone;
  for (int i = 0; i < zone.state.size(); ++i)
    zone.state.velocity[0][i] = rate * zone.state.reference[0][i];
  auto halves = unit.body.bodies();
  coupling::StepTime now;
  now.dt = unit.body.dt;
  unit.body.coupler->compute_forces(halves, now);
  const double start = read_ledger(unit.body, now, 0).residual();
  double stress_error = 0, residual = 0;
  while (now.time < duration) {
    unit.body.coupler->kick(halves, now);
    unit.body.coupler->drift(halves, now);
    ++now.step;
    now.time = double(now.step) * now.dt;
    unit.body.coupler->compute_forces(halves, now);
    double left = 0.3 * now.time; // integral of G(t) over G
    for (const BranchParameters &b : viscosity.branches)
      left += b.share * b.relaxation_time * -std::expm1(-now.time / b.relaxation_time);
    const double expected = rate * (bulk * now.time + 4. / 3 * shear * left);
    const double full = rate * (bulk + 4. / 3 * shear) * duration;
    keep_largest(stress_error, std::abs(end_stress(scene, unit) - expected) / full);
    const auto ledger = read_ledger(unit.body, now, 0);
    keep_largest(residual, std::abs(ledger.residual() - start) / (full * rate * duration));
  }
  return {stress_error, residual};
}

/// The strain of creep under a constant stress, prescribed: the largest error of the stress that it
/// takes.
template <int dim>
double creep(const Body &body)
{
  constexpr double tau = 100, strain = 1e-10, longitudinal = bulk + 4. / 3 * shear;
  constexpr int n_steps = 3000;
  ViscosityParameters viscosity;
  viscosity.shear_viscosity = 0.75 * longitudinal * tau;
  Scene scene = between_plates(body, viscosity);
  const auto course = [](double t) { return -std::expm1(-t / tau); };
  std::vector<std::array<double, 2>> table;
  for (int s = 0; s <= n_steps; ++s) {
    const double time = 3 * tau * s / n_steps;
    table.push_back({time, course(time)});
  }
  move_ends(scene, LoadKind::displacement, strain * scene.specimen.size[0], table);
  UnitBody<dim> unit(scene);
  auto &zone = *unit.body.zone;
  double worst = 0;
  for (const auto &[time, share] : table) {
    for (int i = 0; i < zone.state.size(); ++i)
      zone.state.displacement[0][i] = share * strain * zone.state.reference[0][i];
    zone.compute_forces(time);
    if (time > 0)
      keep_largest(worst, std::abs(end_stress(scene, unit) / (longitudinal * strain) - 1));
  }
  return worst;
}

/// Standard solid under a constant traction, heavily damped against its inertia: the largest error
/// of its elongation behind the first oscillation, over the last one.
template <int dim>
double creep_of_branch(const Body &body)
{
  constexpr double traction = 1e-10, share = 0.5, time = 20000, settled = 2000;
  ViscosityParameters viscosity;
  viscosity.branches = {{share, time}};
  Scene scene = between_plates(body, viscosity);
  scene.damping.mass = 0.02;
  for (const int side : {0, 1}) {
    LoadParameters end;
    end.boundary = side;
    end.value[0] = side == 0 ? -traction : traction;
    end.traction = end.value;
    scene.loads.insert(scene.loads.begin() + side, end);
  }
  UnitBody<dim> unit(scene);
  auto &state = unit.body.zone->state;
  auto halves = unit.body.bodies();
  BodyDamping<dim> damping(scene.damping);
  coupling::StepTime now;
  now.dt = unit.body.dt;
  unit.body.coupler->compute_forces(halves, now);
  // One exponential: K + 4/3 G(s) of the transformed law has one zero.
  const double first = bulk + 4. / 3 * shear, last = bulk + 4. / 3 * shear * (1 - share),
               retardation = time * first / last;
  double square = 0;
  for (int i = 0; i < state.size(); ++i)
    square += state.reference[0][i] * state.reference[0][i];
  double worst = 0;
  while (now.time < 2 * time) {
    damping.before_kick(unit.body, now);
    unit.body.coupler->kick(halves, now);
    damping.after_kick(unit.body, now);
    unit.body.coupler->drift(halves, now);
    ++now.step;
    now.time = double(now.step) * now.dt;
    unit.body.coupler->compute_forces(halves, now);
    if (now.time < settled || now.step % 50 != 0)
      continue;
    double strain = 0;
    for (int i = 0; i < state.size(); ++i)
      strain += state.reference[0][i] * state.displacement[0][i] / square;
    const double expected =
        traction / last * (1 - (1 - last / first) * std::exp(-now.time / retardation));
    keep_largest(worst, std::abs(strain - expected) / (traction / last));
  }
  return worst;
}

template <typename OfTwo, typename OfThree>
auto of_dimension(const Body &body, const OfTwo &two, const OfThree &three)
{
  return body.dimension == 2 ? two(body) : three(body);
}

/// `error` of a body; of those with cut cells the error itself is stated, and its fall is asked
/// for.
template <typename Error>
void add_error(const std::string &name, const Body &body, double aim, const Error &error,
               std::vector<Result> &results)
{
  const double once = error(body);
  if (!has_cut_cells(body)) {
    results.push_back({name, once, 1e-3, aim});
    return;
  }
  Body larger = body;
  larger.size = 2;
  results.push_back({name, once, std::numeric_limits<double>::infinity(), {}});
  results.push_back({name + "_of_double_size_over_it", error(larger) / once, 0.75, 0.5});
}

std::vector<Result> relaxation()
{
  std::vector<Result> results;
  for (const Body &body : bodies) {
    double residual = 0;
    const auto error = [&](const Body &b) {
      const auto [stress, unbooked] = of_dimension(b, strain_steadily<2>, strain_steadily<3>);
      keep_largest(residual, unbooked);
      return stress;
    };
    add_error("law_relaxation/" + body.name + "/stress", body, 1e-4, error, results);
    results.push_back({"law_relaxation/" + body.name + "/residual", residual, 1e-8, 1e-10});
  }
  return results;
}

std::vector<Result> creep_of_dashpots()
{
  std::vector<Result> results;
  for (const Body &body : bodies)
    add_error(
        "law_creep/" + body.name + "/stress", body, 5.1e-4,
        [](const Body &b) { return of_dimension(b, creep<2>, creep<3>); }, results);
  return results;
}

std::vector<Result> creep_of_branches()
{
  std::vector<Result> results;
  for (const Body &body : bodies)
    if (!has_cut_cells(body))
      add_error(
          "law_creep_branch/" + body.name + "/elongation", body, 3e-4,
          [](const Body &b) { return of_dimension(b, creep_of_branch<2>, creep_of_branch<3>); },
          results);
  return results;
}
} // namespace

std::vector<Case> law_viscous_cases()
{
  return {{"law_relaxation", "bodies with two Maxwell branches, strained at a constant rate", false,
           relaxation},
          {"law_creep", "bodies with a dashpot on the course of creep: is the stress constant?",
           false, creep_of_dashpots},
          {"law_creep_branch", "bodies with a Maxwell branch that creep under a traction", true,
           creep_of_branches}};
}
} // namespace ligament::program
