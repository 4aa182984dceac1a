#include "src/verification/cases/atoms.h"

#include "src/verification/bodies/atom_scene.h"
#include "src/verification/bodies/unit_bodies.h"

namespace ligament::program
{
namespace
{
/// All atoms and nodes, over the spacing.
template <int dim>
double largest_displacement(const CoupledBody<dim> &body)
{
  double largest = 0;
  for (const auto *displacement : {&body.zone->state.displacement, &body.far->displacement})
    for (const auto &component : *displacement)
      for (const double u : component)
        keep_largest(largest, std::abs(u) / body.spacing);
  return largest;
}

/// What the fit leaves under all displacement gradients, and how far a body without load moves
/// within so many steps.
template <int dim>
std::vector<Result> patch_and_rest(const std::string &name, const Scene &scene, int n_steps)
{
  UnitBody<dim> unit(scene);
  auto &body = unit.body;
  const double residual = body.figures.at("patch_residual").value;
  auto bodies = body.bodies();
  coupling::StepTime step{0, 0, body.dt};
  for (; step.step <= n_steps; ++step.step, step.time += body.dt) {
    body.coupler->compute_forces(bodies, step);
    body.coupler->kick(bodies, step);
    body.coupler->drift(bodies, step);
  }
  // Forces of 1e-15 C11 d^2, the rounding of places of some tens of spacings, push each step anew.
  return {{name + "/residual", residual, 1e-13, 1e-15},
          {name + "/moved", largest_displacement(body), 1e-12, {}}};
}

const std::vector<AtomBody> plane_bodies = {
    {"plane_crystal", AtomPotential::plane_crystal, "", PackingKind::hexagonal},
    {"plane_crystal_turned", AtomPotential::plane_crystal, "", PackingKind::hexagonal, 0.3},
    {"lennard_jones_turned", AtomPotential::lennard_jones, "", PackingKind::hexagonal, 0.2}};

const std::vector<AtomBody> solid_bodies = {
    {"copper", AtomPotential::zhou, "Cu", PackingKind::fcc},
    {"copper_turned", AtomPotential::zhou, "Cu", PackingKind::fcc, 0, {1, 1, -2}, {1, 1, 1}},
    {"argon", AtomPotential::lennard_jones, "", PackingKind::fcc},
    {"iron_turned", AtomPotential::zhou, "Fe", PackingKind::bcc, 0, {1, 1, 0}, {-1, 1, 0}}};

template <int dim>
std::vector<Result> all_of(const std::string &name, const std::vector<AtomBody> &bodies,
                           int n_steps)
{
  std::vector<Result> results;
  for (const AtomBody &b : bodies) {
    const Scene scene = dim == 2 ? atom_scene(b, 60, 21, 4.1, 6) : atom_scene(b, 37, 12, 2.6, 5);
    for (const Result &r : patch_and_rest<dim>(name + "/" + b.name, scene, n_steps))
      results.push_back(r);
  }
  return results;
}
} // namespace

std::vector<Case> atom_cases()
{
  return {{"atoms_patch", "crystals inside a mesh in 2D: gradients, and no motion without load",
           false, [] { return all_of<2>("atoms_patch", plane_bodies, 500); }},
          {"atoms_patch_3d", "the same for copper, argon and iron, joined sideways", false,
           [] { return all_of<3>("atoms_patch_3d", solid_bodies, 200); }}};
}
} // namespace ligament::program
