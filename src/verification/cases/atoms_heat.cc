// A crystal at a temperature inside a mesh on which nothing pulls.
#include "src/scene/atoms.h"
#include "src/simulation/gauges/gauge_set.h"
#include "src/simulation/heat.h"
#include "src/verification/bodies/atom_scene.h"
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases/atoms.h"

#include <Eigen/LU>

#include <numeric>

namespace ligament::program
{
namespace
{
using Matrix = Eigen::Matrix2d;

/// Least squares gradient of the near nodes' displacements.
Matrix mean_gradient(const CoupledBody<2> &body)
{
  const auto &near = body.coupler->overlap()->near_nodes;
  const auto &nodes = body.far->mesh().nodes;
  Vector<2> centre = Vector<2>::Zero(), shift = Vector<2>::Zero();
  for (const int n : near) {
    centre += nodes[n] / double(near.size());
    shift += get(body.far->displacement, n) / double(near.size());
  }
  Matrix moment = Matrix::Zero(), product = Matrix::Zero();
  for (const int n : near) {
    const Vector<2> x = nodes[n] - centre;
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

/// Argon in the plane at 10 K, the bath on the overlap alone. After a quarter of the time, in which
/// the nodes take their heat from the atoms.
std::vector<Result> free_body()
{
  constexpr double temperature = 10;
  constexpr int n_steps = 60000, first = n_steps / 4, n_blocks = 10,
                per_block = (n_steps - first) / n_blocks;
  AtomBody b = {"lennard_jones", AtomPotential::lennard_jones, "", PackingKind::hexagonal};
  Scene scene = atom_scene(b, 70, 25, 4.1, 6);
  scene.coupling.fine_damper = 8;
  scene.time.step_fraction = 0.1;
  scene.atoms->temperature = temperature;
  resolve_atoms(scene, nullptr);
  GaugeParameters virial;
  virial.name = "virial";
  virial.kind = GaugeKind::virial_stress;
  scene.gauges = {virial};
  UnitBody<2> unit(scene);
  auto &body = unit.body;
  start_heat(scene, body, unit.log);
  const double kt = thermal_energy_of(scene);
  auto bodies = body.bodies();
  std::array<TimeMean, 3> energy; // of zone, overlap and nodes, over kT
  std::array<TimeMean, 2> strain, stress; // the second over kT/V
  GaugeSet<2> gauges(scene, body);
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
    const auto e = body.coupler->thermal_energies(bodies);
    for (int part = 0; part < 3; ++part)
      energy[part].blocks.back() += 10 * e[part] / (kt * per_block);
    const Matrix h = mean_gradient(body);
    for (int c = 0; c < 2; ++c)
      strain[c].blocks.back() += 10 * h(c, c) / per_block;
    for (int c = 0; c < 2; ++c)
      stress[c].blocks.back() += 10 * virial_of_now[c] / (pressure * per_block);
  }
  const double mean_strain = (strain[0].value() + strain[1].value()) / 2,
               strain_error = std::hypot(strain[0].error(), strain[1].error()) / 2,
               mean_stress = (stress[0].value() + stress[1].value()) / 2,
               stress_error = std::hypot(stress[0].error(), stress[1].error()) / 2;
  return {{"atoms_heat/zone", std::abs(energy[0].value() - 1), 0.02, 0.005},
          {"atoms_heat/overlap", std::abs(energy[1].value() - 1), 0.02, 0.005},
          {"atoms_heat/nodes", std::abs(energy[2].value() - 1), 0.05, 0.01},
          {"atoms_heat/strain", std::abs(mean_strain), 2e-4, 3e-5},
          // In kT/V, the share of momentum: C11 times the strain above is 0.15 of it.
          {"atoms_heat/virial_stress", std::abs(mean_stress), 0.2, 0.05},
          // What these figures know themselves to.
          {"atoms_heat/zone_error", energy[0].error(), 0.01, {}},
          {"atoms_heat/overlap_error", energy[1].error(), 0.01, {}},
          {"atoms_heat/nodes_error", energy[2].error(), 0.025, {}},
          {"atoms_heat/strain_error", strain_error, 1e-4, {}},
          {"atoms_heat/virial_stress_error", stress_error, 0.1, {}}};
}
} // namespace

std::vector<Case> atom_heat_cases()
{
  return {{"atoms_heat", "argon at 10 K in a free mesh: temperatures, and that it keeps its size",
           true, free_body}};
}
} // namespace ligament::program
