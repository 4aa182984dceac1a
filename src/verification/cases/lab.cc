// Tests as in the laboratory: bodies in free spin, loads on parts of sides, waves that meet.
#include "src/verification/cases/lab.h"

#include "src/simulation/equilibrium_solver.h"
#include "src/simulation/initial_motion.h"
#include "src/simulation/regime_control.h"
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/instruments/free_flight.h"

#include <fmt/format.h>

#include <cmath>

namespace ligament::program
{
namespace
{
enum class Model
{
  discrete,
  coupled,
  mesh
};
const std::array<std::string, 3> model_names = {"discrete", "coupled", "mesh"};

/// Of the coupled scene.
void choose(Model model, Scene &scene)
{
  if (model == Model::discrete) {
    scene.far_field.reset();
    scene.zone.extent = DiscreteZone::Extent::all;
    for (int c = 0; c < 3; ++c) {
      scene.zone.lower[c] = -scene.specimen.size[c];
      scene.zone.upper[c] = scene.specimen.size[c];
    }
  } else if (model == Model::mesh)
    scene.zone.extent = DiscreteZone::Extent::none;
}

/// A box with a hole in its zone (2D) or with a band (3D); 0.05 of the bar's wave speed at the
/// edge.
Scene spinning_scene(int dim)
{
  Scene scene = dim == 2 ? unit_scene(2, {58, 54, 0}, 0.3) : unit_scene(3, {9.3, 8.7, 50}, 0.3);
  add_far_field(scene, dim == 2 ? Point{38.6, 38.6, 0} : Point{0, 0, 25}, 3.1);
  scene.coupling.overlap_cells = dim == 2 ? 3 : 2;
  scene.coupling.transition_cells = 2;
  scene.coupling.regime = RegimeChoice::corotated;
  if (dim == 2)
    scene.specimen.holes.push_back({{0.3, -0.4, 0}, 3});
  InitialMotion &motion = scene.initial_motion.emplace_back();
  motion.spin[0] = 0.05 / (dim == 2 ? 29 : 25); // 3D: across the band
  return scene;
}

/// By which angle the body has turned about its axis, up to whole turns.
template <int dim>
double angle(const CoupledBody<dim> &body)
{
  constexpr int a = dim == 2 ? 0 : 1, b = a + 1;
  double along = 0, across = 0;
  const auto add = [&](const Vector<dim> &reference, const Vector<dim> &u) {
    const Vector<dim> x = reference + u;
    along += reference[a] * x[a] + reference[b] * x[b];
    across += reference[a] * x[b] - reference[b] * x[a];
  };
  if (body.zone)
    for (int i = 0; i < body.zone->state.size(); ++i)
      add(get(body.zone->state.reference, i), get(body.zone->state.displacement, i));
  else
    for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
      add(body.far->mesh().nodes[i], get(body.far->displacement, i));
  return std::atan2(across, along);
}

template <int dim>
void spin(const std::string &name, double turns, Model model, std::vector<Result> &results)
{
  Scene scene = spinning_scene(dim);
  choose(model, scene);
  if (model == Model::mesh)
    scene.specimen.holes.clear();
  UnitBody<dim> unit(scene);
  auto &body = unit.body;
  const RegimeControl<dim> control(scene.coupling.regime, body);
  start_motion(scene, body);
  const Spin<dim> before = angular_momentum(body);
  const double rate = scene.initial_motion[0].spin[0];
  const long n_steps = std::lround(turns * 2 * M_PI / rate / body.dt);
  const double energy = energy_change(body, n_steps);
  // Centrifugal force makes it larger and slower by the square of the speed, about 1e-3.
  const double whole = double(n_steps) * body.dt * rate,
               late = std::remainder(angle(body) - whole, 2 * M_PI);
  const double momentum = (angular_momentum(body) - before).norm() / before.norm();
  const std::string prefix = fmt::format("{}/{}_{}d", name, model_names[int(model)], dim);
  results.push_back({prefix + "/energy", energy, 1e-6, 1e-8});
  results.push_back({prefix + "/angular_momentum", momentum, 1e-10, {}});
  results.push_back({prefix + "/angle", std::abs(late) / whole, 5e-3, {}});
}

/// Of the mesh at a point.
Vector<2> displacement(const fem::FemSolver<2> &far, const Vector<2> &x)
{
  const auto &mesh = far.mesh();
  const int cell = fem::CellLocator<2>(mesh).find(x);
  const auto value = fem::shape_values<2>(mesh.cell_lower[cell], mesh.cell_size[cell], x);
  Vector<2> u = Vector<2>::Zero();
  for (int a = 0; a < 4; ++a)
    u += value[a] * get(far.displacement, mesh.cells[cell][a]);
  return u;
}

/// Displacements at points below the zone of a block that stands on smooth walls and is pressed on
/// a strip of its top; `scale` makes cells smaller.
std::vector<Vector<2>> pressed_block(Model model, double scale)
{
  Scene scene = unit_scene(2, {112, 80, 0}, 0.3);
  add_far_field(scene, {56, 0, 0}, 3.1 * scale);
  scene.zone.lower[1] = 4; // to the top
  scene.coupling.overlap_cells = 3;
  scene.coupling.transition_cells = 2;
  choose(model, scene);
  LoadParameters &press = scene.loads.emplace_back();
  press.boundary = 3;
  press.kind = LoadKind::traction;
  press.value[1] = -1e-6;
  press.from = -6.7;
  press.to = 8.2;
  for (const int side : {2, 0}) {
    LoadParameters &held = scene.loads.emplace_back();
    held.boundary = side;
    held.kind = LoadKind::displacement;
    held.value[side / 2] = 0;
  }
  UnitBody<2> unit(scene);
  EquilibriumSolver<2>(unit.body, algebra::Preconditioning::cholesky).settle_linear(1);
  std::vector<Vector<2>> u;
  for (double x = -55; x < 56; x += 7.3)
    for (const double y : {-35., -20., -11.})
      u.push_back(displacement(*unit.body.far, {x, y}));
  return u;
}

std::vector<Result> press_part(const std::string &name)
{
  const auto fine = pressed_block(Model::mesh, 0.5), coupled = pressed_block(Model::coupled, 1);
  double largest = 0, difference = 0;
  for (std::size_t k = 0; k < fine.size(); ++k) {
    keep_largest(largest, fine[k].norm());
    keep_largest(difference, (fine[k] - coupled[k]).norm());
  }
  return {{name + "/displacement", difference / largest, 0.02, 0.01}};
}

/// A bar without lateral contraction, pulled at both ends by a half sine: where the two meet its
/// first face breaks.
template <typename Look>
void spall(Model model, Look &&look)
{
  constexpr double pulse = 1e-4, strength = 1.6e-4, length = 300;
  Scene scene = unit_scene(2, {length, 12, 0}, 0);
  add_far_field(scene, {90, 0, 0}, 3.1);
  scene.coupling.transition_cells = 2;
  choose(model, scene);
  scene.material.fracture.criterion = Criterion::maximum_tension;
  scene.material.fracture.strength = strength;
  UnitBody<2> plain(scene); // tells the wave's speed
  const double speed = plain.body.force()->elastic_constants().wave_speed_p, duration = 60 / speed;
  for (const int side : {0, 1}) {
    LoadParameters &pull = scene.loads.emplace_back();
    pull.boundary = side;
    pull.kind = LoadKind::traction;
    pull.value[0] = side == 0 ? -pulse : pulse;
    pull.history.pulse = PulseParameters{PulseShape::half_sine, 0, duration};
  }
  UnitBody<2> unit(scene);
  auto bodies = unit.body.bodies();
  coupling::StepTime step{0, 0, unit.body.dt};
  // On the middle plane the two add up to 2 p sin(pi (t - L/2c)/T).
  const double expected = length / 2 / speed + duration / M_PI * std::asin(strength / (2 * pulse));
  for (; step.time < 1.5 * expected;
       step = {step.step + 1, double(step.step + 1) * step.dt, step.dt}) {
    unit.body.coupler->compute_forces(bodies, step);
    const auto &broken = unit.body.force()->broken_bonds();
    if (!broken.empty())
      return look(std::abs(broken.front().position[0]) / length, step.time / expected);
    unit.body.coupler->kick(bodies, step);
    unit.body.coupler->drift(bodies, step);
  }
  look(NAN, NAN);
}
} // namespace

std::vector<Case> lab_cases()
{
  const std::string spinning = "free spin from rest of strains, 0.05 of the bar's wave speed, ";
  const auto spin_all = [](const std::string &name, double turns, bool in_space) {
    std::vector<Result> results;
    for (const Model model : {Model::discrete, Model::coupled, Model::mesh}) {
      if (in_space)
        spin<3>(name, turns, model, results);
      else
        spin<2>(name, turns, model, results);
    }
    return results;
  };
  return {{"lab_spinning", spinning + "half a turn; box with a hole", false,
           [=] { return spin_all("lab_spinning", 0.5, false); }},
          {"lab_spinning_long", spinning + "ten turns; box with a hole", true,
           [=] { return spin_all("lab_spinning_long", 10, false); }},
          {"lab_spinning_3d", spinning + "ten turns, FCC", true,
           [=] { return spin_all("lab_spinning_3d", 10, true); }},
          {"lab_part_load", "block pressed on a strip of its top, against a mesh twice as fine",
           false, [] { return press_part("lab_part_load"); }},
          {"lab_spall", "two half-sine pulls from the ends of a bar meet: first face", false, [] {
             std::vector<Result> results;
             for (const Model model : {Model::discrete, Model::coupled})
               spall(model, [&](double plane, double time) {
                 const std::string name = "lab_spall/" + model_names[int(model)];
                 results.push_back({name + "/plane", plane, 0.01, {}});
                 results.push_back({name + "/time", std::abs(time - 1), 0.01, {}});
               });
             return results;
           }}};
}
} // namespace ligament::program
