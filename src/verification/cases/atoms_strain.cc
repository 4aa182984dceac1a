// Crystals inside a mesh under finite homogeneous strain, in the nonlinear regime.
#include "src/verification/bodies/atom_scene.h"
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases/atoms.h"

#include <random>

namespace ligament::program
{
namespace
{
template <int dim>
using Matrix = Eigen::Matrix<double, dim, dim>;

/// Where the motion is that of the mesh: u = H x of all particles and nodes.
template <int dim>
void move_by_gradient(CoupledBody<dim> &body, const Matrix<dim> &h)
{
  auto &zone = body.zone->state;
  for (int i = 0; i < zone.size(); ++i)
    set(zone.displacement, i, Vector<dim>(h * get(zone.reference, i)));
  for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
    set(body.far->displacement, i, Vector<dim>(h * body.far->mesh().nodes[i]));
}

struct Residual
{
  double nodes = 0, atoms = 0; // N, the largest
};

/// What is left on near nodes and on the atoms' own motion w; the far field's outer sides are no
/// near nodes.
template <int dim>
Residual residual(CoupledBody<dim> &body)
{
  auto bodies = body.bodies();
  body.coupler->compute_forces(bodies, {});
  auto &zone = body.zone->state;
  Components<dim> nodal;
  body.coupler->compute_trial(bodies, 0, 1, nodal);
  body.coupler->restrict_forces(zone, nodal);
  Residual largest;
  for (const int node : body.coupler->overlap()->near_nodes)
    keep_largest(largest.nodes, get(nodal, node).norm());
  const double reach = body.force()->range();
  for (int i = 0; i < zone.size(); ++i)
    if (body.coupler->overlap()->distance_to_edge(get(zone.reference, i)) > reach)
      keep_largest(largest.atoms, get(zone.force, i).norm());
  return largest;
}

/// a (x) e_x, which sides that are joined across it carry, of norm `size`; in 2D any.
template <int dim>
std::vector<Matrix<dim>> gradients(double size)
{
  std::vector<Matrix<dim>> all;
  for (int c = 0; c < dim; ++c) {
    all.push_back(Matrix<dim>::Zero());
    all.back()(c, 0) = size;
    all.push_back(-all.back());
  }
  if (dim == 2)
    for (int k = 0; k < 2; ++k) {
      all.push_back(Matrix<dim>::Zero());
      all.back()(k, 1) = size;
    }
  return all;
}

const std::vector<AtomBody> plane_bodies = {
    {"plane_crystal", AtomPotential::plane_crystal, "", PackingKind::hexagonal, 0.3},
    {"lennard_jones", AtomPotential::lennard_jones, "", PackingKind::hexagonal, 0.2}};

const std::vector<AtomBody> solid_bodies = {
    {"copper", AtomPotential::zhou, "Cu", PackingKind::fcc},
    {"copper_turned", AtomPotential::zhou, "Cu", PackingKind::fcc, 0, {1, 1, -2}, {1, 1, 1}},
    {"iron", AtomPotential::zhou, "Fe", PackingKind::bcc}};

/// Relative error of the power of the forces against differences of the energy, about a state that
/// is strained and turned, along a motion that the coupler carries.
template <int dim>
double slope_error(CoupledBody<dim> &body, const Matrix<dim> &h)
{
  auto bodies = body.bodies();
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (auto *velocity : {&body.zone->state.velocity, &body.far->velocity})
    for (auto &component : *velocity)
      for (double &v : component)
        v = uniform(random);
  body.far->follow_masters(body.far->velocity);
  body.coupler->take_velocities(bodies);
  const auto look = [&](double way) {
    move_by_gradient(body, h);
    coupling::StepTime step;
    step.dt = way;
    body.coupler->drift(bodies, step);
    body.coupler->compute_forces(bodies, {});
  };
  const auto potential = [&] {
    const auto e = body.coupler->energy(bodies, {});
    return e.potential_discrete + e.potential_far + e.blended;
  };
  // About a state in which forces act.
  const double there = 0.02 * body.spacing, way = 1e-5 * body.spacing;
  look(there + way);
  double slope = potential();
  look(there - way);
  slope = (slope - potential()) / (2 * way);
  look(there);
  const auto kinetic = [&](double dt) {
    const auto e = body.coupler->energy(bodies, {0, 0, dt});
    return e.kinetic_discrete + e.kinetic_far;
  };
  // Of (E1): 1/2 v M v + 1/2 dt v f.
  const double power = 2 / body.dt * (kinetic(body.dt) - kinetic(0));
  return std::abs(slope / power + 1);
}

template <int dim>
std::vector<Result> under_strain(const std::string &name, const AtomBody &b)
{
  const Scene scene = atom_scene(b, 60, 21, 4.1, 6);
  UnitBody<dim> unit(scene);
  auto &body = unit.body;
  auto bodies = body.bodies();
  const double scale = std::pow(scene.far_field->cell_size, dim - 1) * body.thickness;
  const auto law = body.force()->finite_strain_law();
  const auto worst = [&](double size) {
    double share = 0;
    for (const Matrix<dim> &h : gradients<dim>(size)) {
      move_by_gradient(body, h);
      keep_largest(share, residual(body).nodes / (law->stress(h).norm() * scale));
    }
    return share;
  };
  const double linear = worst(0.01);
  body.coupler->set_regime(coupling::Regime::nonlinear, bodies);
  std::vector<Result> results = {{name + "/nodes_1", worst(0.01), 5e-4, 1.5e-4},
                                 {name + "/nodes_5", worst(0.05), 3e-3, 8e-4}};
  // That the linear regime is worse by far shows that the case sees something.
  results.push_back({name + "/linear_1", linear, 5e-3, {}, Result::Bound::at_least});

  Matrix<dim> h = Matrix<dim>::Zero();
  h(0, 0) = 0.02;
  h(1, 0) = 0.03;
  results.push_back({name + "/slope", slope_error(body, h), 1e-6, {}});
  return results;
}

template <int dim>
std::vector<Result> all_of(const std::string &name, const std::vector<AtomBody> &bodies)
{
  std::vector<Result> results;
  for (const AtomBody &b : bodies)
    for (const Result &r : under_strain<dim>(name + "/" + b.name, b))
      results.push_back(r);
  return results;
}
} // namespace

std::vector<Case> atom_strain_cases()
{
  return {{"atoms_strain", "crystals inside a mesh in 2D under homogeneous strain", false,
           [] { return all_of<2>("atoms_strain", plane_bodies); }},
          {"atoms_strain_3d", "the same for copper and iron, joined sideways", true,
           [] { return all_of<3>("atoms_strain_3d", solid_bodies); }}};
}
} // namespace ligament::program
