#include "src/verification/cases/softening_flow.h"

#include "src/simulation/damping.h"
#include "src/simulation/energy_ledger.h"
#include "src/verification/bodies/unit_bodies.h"

#include <cmath>

namespace ligament::program
{
namespace
{
constexpr double nu = 0.3, shear = 1 / (2 * (1 + nu)), bulk = 1 / (3 * (1 - 2 * nu)),
                 longitudinal = bulk + 4. / 3 * shear;
constexpr double strength = 1e-8; // of E
constexpr double height = 2;      // two rows of cells, one row of faces between them
constexpr double energy = 20 * strength * strength, reach = 2 * energy / strength;

struct Body
{
  std::string name;
  int dimension;
  PackingKind packing;
};
const std::vector<Body> bodies = {{"square", 2, PackingKind::square},
                                  {"simple_cubic", 3, PackingKind::simple_cubic}};

/// Two rows of whole cells between smooth walls at the sides, whose ends move apart by `stroke` in
/// `duration`.
Scene bar(const Body &body, double stroke, double duration)
{
  Scene scene = unit_scene(body.dimension,
                           body.dimension == 2 ? Point{4, height, 0} : Point{4, height, 4}, nu);
  scene.zone.packing = body.packing;
  FractureParameters &fracture = scene.material.fracture;
  fracture.criterion = Criterion::maximum_tension;
  fracture.strength = strength;
  fracture.energy = energy;
  for (int side = 0; side < 2 * body.dimension; ++side) {
    LoadParameters load;
    load.boundary = side;
    const int axis = side / 2;
    load.kind = axis == 1 ? LoadKind::velocity : LoadKind::displacement;
    load.value[axis] = axis == 1 ? (side == 2 ? -0.5 : 0.5) * stroke / duration : 0.;
    (axis == 1 ? load.velocity : load.displacement) = load.value;
    scene.loads.push_back(load);
  }
  scene.damping.mass = 0.05;
  return scene;
}

/// Largest errors: of the stress at the end over the strength, of the balance over the work of all
/// faces, and of what these took at the end.
struct Errors
{
  double stress = 0, residual = 0, work = 0;
};

/// `stress_at(elongation, time)` in closed form.
template <int dim, typename Stress>
Errors pull_apart(const Scene &scene, double stroke, double duration, const Stress &stress_at)
{
  UnitBody<dim> unit(scene);
  auto halves = unit.body.bodies();
  BodyDamping<dim> damping(scene.damping);
  coupling::StepTime now;
  now.dt = unit.body.dt;
  double area = dim == 2 ? scene.specimen.thickness * scene.specimen.size[0]
                         : scene.specimen.size[0] * scene.specimen.size[2];
  // The particles begin with the motion that they keep.
  auto &state = unit.body.zone->state;
  for (int i = 0; i < state.size(); ++i)
    state.velocity[1][i] = stroke / duration / height * state.reference[1][i];
  unit.body.coupler->compute_forces(halves, now);
  const double start = read_ledger(unit.body, now, 0).residual();
  Errors worst;
  while (now.time < duration) {
    damping.before_kick(unit.body, now);
    unit.body.coupler->kick(halves, now);
    damping.after_kick(unit.body, now);
    unit.body.coupler->drift(halves, now);
    ++now.step;
    now.time = double(now.step) * now.dt;
    unit.body.coupler->compute_forces(halves, now);
    const double stress = unit.body.force()->reaction(3)[1] / area;
    keep_largest(worst.stress,
                 std::abs(stress - stress_at(stroke * now.time / duration, now.time)) / strength);
    keep_largest(worst.residual,
                 std::abs(read_ledger(unit.body, now, damping.energy()).residual() - start) /
                     (energy * area));
  }
  worst.work = std::abs(unit.body.force()->losses().cohesive / (energy * area) - 1);
  return worst;
}

/// A standard solid: sigma = M e + q, dq/dt + q/T = M_1 de/dt of the strain e, H e + w = v t, and
/// sigma = f_t (1 - w/w_c) from f_t on: every stretch of it is a linear equation for e.
template <int dim>
Errors relaxing_bar(const Body &body)
{
  constexpr double share = 0.6, stroke = 1.15 * reach, duration = 20000, time = duration / 12;
  Scene scene = bar(body, stroke, duration);
  scene.material.viscosity.emplace();
  scene.material.viscosity->branches = {{share, time}};
  constexpr double slow = longitudinal - 4. / 3 * shear * share, fast = 4. / 3 * shear * share,
                   speed = stroke / duration, fall = strength / reach;
  // Before: q = M_1 speed/H T (1 - exp(-t/T)).
  const auto before = [&](double t) {
    return slow * speed * t / height - fast * speed / height * time * std::expm1(-t / time);
  };
  double begin = 0, end = duration; // by bisection
  for (int k = 0; k < 100; ++k) {
    const double middle = (begin + end) / 2;
    (before(middle) < strength ? begin : end) = middle;
  }
  // After, with s = t - begin: w = speed t - H e, q = a - b s + c e.
  constexpr double c = fall * height - slow, b = fall * speed;
  const double a = strength - fall * speed * begin, rate = c / ((c - fast) * time);
  // (c - M_1) e' + c e/T = b - (a - b s)/T has the solution of a straight line ...
  const double slope = b / c, at_begin = (b * time - a - (c - fast) * slope * time) / c;
  // ... and what dies off.
  const double first = speed * begin / height;
  const auto after = [&](double t) {
    const double s = t - begin,
                 strain = at_begin + slope * s + (first - at_begin) * std::exp(-rate * s);
    return std::max(strength - fall * (speed * t - height * strain), 0.);
  };
  return pull_apart<dim>(scene, stroke, duration,
                         [&](double, double t) { return t < begin ? before(t) : after(t); });
}

/// Von Mises' metal between walls yields before it reaches the strength: then it unloads beside the
/// face that opens.
template <int dim>
Errors yielding_bar(const Body &body)
{
  constexpr double stroke = 1.15 * reach, duration = 20000, yield = 0.3 * strength, hardening = 0.2;
  Scene scene = bar(body, stroke, duration);
  scene.material.plasticity.emplace();
  scene.material.plasticity->law = PlasticityLaw::von_mises;
  scene.material.plasticity->yield_stress = yield;
  scene.material.plasticity->hardening = hardening;
  // sigma = K e + 2/3 Y with Y = 2G (e - 3/2 p) = Y_0 + H p.
  constexpr double first = yield / (2 * shear),
                   flowing = bulk + 4. / 3 * shear * hardening / (hardening + 3 * shear),
                   at_yield = longitudinal * first, last = first + (strength - at_yield) / flowing,
                   fall = strength / reach;
  return pull_apart<dim>(scene, stroke, duration, [&](double elongation, double) {
    const double strain = elongation / height;
    if (strain <= first)
      return longitudinal * strain;
    if (strain <= last)
      return at_yield + flowing * (strain - first);
    // H (e - e_last) = elongation - H e_last - w, sigma = f_t + M (e - e_last).
    const double beyond = elongation - height * last,
                 opening = beyond / (1 - fall * height / longitudinal);
    return std::max(strength - fall * opening, 0.);
  });
}

template <typename OfTwo, typename OfThree>
std::vector<Result> results(const std::string &name, const OfTwo &two, const OfThree &three)
{
  std::vector<Result> all;
  for (const Body &body : bodies) {
    const Errors worst = body.dimension == 2 ? two(body) : three(body);
    const std::string of = name + "/" + body.name;
    all.push_back({of + "/stress", worst.stress, 1e-2, 2e-3});
    all.push_back({of + "/residual", worst.residual, 1e-6, 1e-8});
    all.push_back({of + "/work", worst.work, 5e-3, 1e-3});
  }
  return all;
}
} // namespace

std::vector<Case> softening_flow_cases()
{
  return {{"law_cohesive_relaxation", "a bar that relaxes while a row of its faces opens", false,
           [] { return results("law_cohesive_relaxation", relaxing_bar<2>, relaxing_bar<3>); }},
          {"law_cohesive_flow", "a bar that yields before a row of its faces opens", false,
           [] { return results("law_cohesive_flow", yielding_bar<2>, yielding_bar<3>); }}};
}
} // namespace ligament::program
