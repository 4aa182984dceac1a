// A crystal at a temperature inside a mesh on which nothing pulls.
#include "core/thermal_noise.h"
#include "src/scene/atoms.h"
#include "src/simulation/body_state.h"
#include "src/simulation/gauges/gauge_set.h"
#include "src/simulation/heat.h"
#include "src/verification/bodies/atom_scene.h"
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases/atoms.h"
#include "src/verification/instruments/noise_run.h"

#include <Eigen/LU>

#include <numeric>

namespace ligament::program
{
namespace
{
/// Least squares gradient of the near nodes' displacements.
template <int dim>
Eigen::Matrix<double, dim, dim> mean_gradient(const CoupledBody<dim> &body)
{
  using Matrix = Eigen::Matrix<double, dim, dim>;
  const auto &near = body.coupler->overlap()->near_nodes;
  const auto &nodes = body.far->mesh().nodes;
  Vector<dim> centre = Vector<dim>::Zero(), shift = Vector<dim>::Zero();
  for (const int n : near) {
    centre += nodes[n] / double(near.size());
    shift += get(body.far->displacement, n) / double(near.size());
  }
  Matrix moment = Matrix::Zero(), product = Matrix::Zero();
  for (const int n : near) {
    const Vector<dim> x = nodes[n] - centre;
    moment += x * x.transpose();
    product += (get(body.far->displacement, n) - shift) * x.transpose();
  }
  return product * moment.inverse();
}

/// A mean over time with its error, from the means of blocks.
struct TimeMean
{
  std::vector<double> blocks;

  double value() const
  {
    return std::accumulate(blocks.begin(), blocks.end(), 0.) / double(blocks.size());
  }
  double error() const
  {
    double sum = 0;
    for (const double b : blocks)
      sum += (b - value()) * (b - value());
    return std::sqrt(sum / double(blocks.size() * (blocks.size() - 1)));
  }
};

/// The bath on the overlap alone. After a quarter of the time, in which the nodes take their heat
/// from the atoms; strain along the directions in which the body is free.
template <int dim>
std::vector<Result> free_body(const std::string &name, Scene scene, long n_steps)
{
  GaugeParameters virial;
  virial.name = "virial";
  virial.kind = GaugeKind::virial_stress;
  scene.gauges = {virial};
  UnitBody<dim> unit(scene);
  auto &body = unit.body;
  start_heat(scene, body, unit.log);
  constexpr int n_blocks = 10;
  const long first = n_steps / 4, per_block = (n_steps - first) / n_blocks;
  const int n_free = dim - int(scene.specimen.periodic.size());
  const double kt = thermal_energy_of(scene);
  auto bodies = body.bodies();
  std::array<TimeMean, 3> energy;           // of zone, overlap and nodes, over kT
  std::array<TimeMean, dim> strain, stress; // the second over kT/V
  GaugeSet<dim> gauges(scene, body);
  const double pressure = kt / body.zone->state.volume[0];
  coupling::StepTime step{0, 0, body.dt};
  for (; step.step < first + n_blocks * per_block; ++step.step, step.time += body.dt) {
    const long k = step.step - first;
    const bool looks = k >= 0 && k % 10 == 0;
    body.coupler->compute_forces(bodies, step);
    const auto virial_of_now = looks ? gauges.read(body, step.time) : std::vector<double>();
    body.coupler->kick(bodies, step);
    body.coupler->drift(bodies, step);
    if (!looks)
      continue;
    if (k % per_block == 0) {
      for (auto &mean : energy)
        mean.blocks.push_back(0);
      for (auto *means : {&strain, &stress})
        for (auto &mean : *means)
          mean.blocks.push_back(0);
    }
    const double weight = 1 / double((per_block + 9) / 10);
    const auto e = body.coupler->thermal_energies(bodies);
    for (int part = 0; part < 3; ++part)
      energy[part].blocks.back() += weight * e[part] / kt;
    const auto h = mean_gradient(body);
    for (int c = 0; c < n_free; ++c) {
      strain[c].blocks.back() += weight * h(c, c);
      stress[c].blocks.back() += weight * virial_of_now[c] / pressure;
    }
  }
  double mean_strain = 0, square = 0, mean_stress = 0, stress_square = 0;
  for (int c = 0; c < n_free; ++c) {
    mean_strain += strain[c].value() / n_free;
    square += std::pow(strain[c].error() / n_free, 2);
    mean_stress += stress[c].value() / n_free;
    stress_square += std::pow(stress[c].error() / n_free, 2);
  }
  return {{name + "/zone", std::abs(energy[0].value() - 1), 0.02, 0.005},
          {name + "/overlap", std::abs(energy[1].value() - 1), 0.02, 0.005},
          {name + "/nodes", std::abs(energy[2].value() - 1), 0.05, 0.01},
          {name + "/strain", std::abs(mean_strain), 2e-4, 3e-5},
          // In kT/V, the share of momentum: C11 times the strain above is 0.1 to 0.15 of it.
          {name + "/virial_stress", std::abs(mean_stress), 0.2, 0.05},
          // What these figures know themselves to.
          {name + "/zone_error", energy[0].error(), 0.01, {}},
          {name + "/overlap_error", energy[1].error(), 0.01, {}},
          {name + "/nodes_error", energy[2].error(), 0.025, {}},
          {name + "/strain_error", std::sqrt(square), 1e-4, {}},
          {name + "/virial_stress_error", std::sqrt(stress_square), 0.1, {}}};
}

/// Argon in the plane at 10 K.
Scene argon()
{
  AtomBody b = {"lennard_jones", AtomPotential::lennard_jones, "", PackingKind::hexagonal};
  Scene scene = atom_scene(b, 70, 25, 4.1, 6);
  scene.coupling.fine_damper = 8;
  scene.time.step_fraction = 0.1;
  scene.atoms->temperature = 10;
  resolve_atoms(scene, nullptr);
  return scene;
}

/// Copper at 300 K along x, its own period in y and z; 4 nm of atoms between the overlaps.
Scene copper()
{
  const AtomBody b = {"copper", AtomPotential::zhou, "Cu", PackingKind::fcc};
  constexpr double cell = 3.1; // spacings
  constexpr int overlap_cells = 6;
  Scene scene = atom_scene(b, 15.6 + 2 * overlap_cells * cell, 8 * cell, cell, overlap_cells);
  scene.coupling.fine_damper = 8;
  scene.time.step = 4e-15;
  scene.atoms->temperature = 300;
  resolve_atoms(scene, nullptr);
  return scene;
}

/// Without any bath, about the state that the baths have left.
template <int dim>
Course course_alone(CoupledBody<dim> &body, long n_steps, int interval)
{
  auto bodies = body.bodies();
  std::vector<double> series;
  coupling::StepTime step{0, 0, body.dt};
  for (; step.step < n_steps; ++step.step, step.time += body.dt) {
    body.coupler->compute_forces(bodies, step);
    if (step.step % interval == 0) {
      const auto e = body.coupler->energy(bodies, step);
      series.push_back(e.kinetic_discrete + e.kinetic_far + e.potential_discrete + e.potential_far +
                       e.blended + e.impulses);
    }
    body.coupler->kick(bodies, step);
    body.coupler->drift(bodies, step);
  }
  return course_of(series, interval);
}

std::vector<Result> drift_of_warm_copper(long n_steps)
{
  const std::string name = "atoms_heat_drift";
  constexpr int interval = 20;
  Scene scene = copper();
  UnitBody<3> warm(scene);
  start_heat(scene, warm.body, warm.log);
  scene.coupling.fine_damper = 0;
  UnitBody<3> coupled(scene);
  give_state(take_state(warm.body), coupled.body);
  const Course with_mesh = course_alone(coupled.body, n_steps, interval);

  Scene alone = scene;
  alone.zone.extent = DiscreteZone::Extent::all;
  alone.far_field.reset();
  alone.specimen.periodic = {{Axis::x}, {Axis::y}, {Axis::z}};
  alone.specimen.size[0] = scene.zone.upper[0] - scene.zone.lower[0];
  resolve_atoms(alone, nullptr);
  UnitBody<3> plain(alone);
  auto &atoms = plain.body.zone->state;
  const core::ThermalNoise noise(1, -1);
  for (int i = 0; i < atoms.size(); ++i)
    for (int c = 0; c < 3; ++c)
      atoms.velocity[c][i] =
          std::sqrt(2 * thermal_energy_of(scene) * atoms.inverse_mass(i)) * noise(i, c, 0);
  course_alone(plain.body, 50 * 2 * interval, interval); // half of it becomes strain
  const Course without = course_alone(plain.body, n_steps, interval);
  return {{name + "/drift_over_plain",
           with_mesh.drift / std::max({without.drift, 2 * without.error, 2 * with_mesh.error}), 2,
           1},
          {name + "/fluctuation_over_plain", with_mesh.fluctuation / without.fluctuation, 2, 1},
          {name + "/drift", with_mesh.drift, 1e-4, {}}};
}
} // namespace

std::vector<Case> atom_heat_cases()
{
  return {{"atoms_heat", "argon at 10 K in a free mesh: temperatures, and that it keeps its size",
           true, [] { return free_body<2>("atoms_heat", argon(), 60000); }},
          {"atoms_heat_copper", "the same of copper at 300 K, 1 ns", true,
           [] { return free_body<3>("atoms_heat_copper", copper(), 250000); }},
          {"atoms_heat_drift", "copper at 300 K without a bath, against atoms alone, 1e5 steps",
           true, [] { return drift_of_warm_copper(100000); }}};
}
} // namespace ligament::program
