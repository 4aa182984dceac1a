// Crystals in a closed ring of overlap, and what is left of forces in them.
#pragma once

#include "core/extremes.h"
#include "tests/support/coupled_bodies.h"
#include "tests/support/crystal_force.h"

#include <Eigen/Geometry>

namespace ligament::tests
{
/// Everything in units of the spacing d = 1, density 1; C11 is 4 to 10.
template <int dim>
struct CrystalParameters
{
  double turn = 0;                     // rad, of the lattice
  double reach = dim == 2 ? 1.9 : 1.6; // of the potential: two shells
  double strain = 0;                   // of the bonds in the reference
  bool is_normal = true;
  bool is_harmonic = true;
  CrystalFaults faults;
  // As small as pads, weights and margin let it be, the mesh at no fraction of the lattice.
  double cell_size = dim == 2 ? 4.1 : 2.6;
  int overlap_cells = 4;
  int transition_cells = 2;
  Vector<dim> size, zone_size; // centred at the origin; not coupled where equal
  coupling::FineScaleSplitParameters split;
  double step_fraction = 0.9;
  bool holds_sides = false; // of the mesh

  CrystalParameters()
  {
    split.fine_damper = split.gap_filter = 0;
    if constexpr (dim == 2) {
      size = {77, 75.3};
      zone_size = {44.2, 42.7};
    } else {
      size = {39, 38.3, 39.7};
      zone_size = {24.1, 23.7, 24.6};
    }
  }
};

/// Columns: hexagonal with rows along x, or FCC along the cube axes, turned.
template <int dim>
Eigen::Matrix<double, dim, dim> crystal_basis(double turn)
{
  Eigen::Matrix<double, dim, dim> basis;
  if constexpr (dim == 2) {
    basis << 1, 0.5, 0, std::sqrt(0.75);
    return Eigen::Rotation2Dd(turn) * basis;
  } else {
    basis << 0, 1, 1, 1, 0, 1, 1, 1, 0;
    return Eigen::AngleAxisd(turn, Vector<3>(0.3, -0.5, 0.8).normalized()) * basis / std::sqrt(2.);
  }
}

/// All lattice points at least half a spacing inside the zone.
template <int dim>
particles::Particles<dim> make_atoms(const CrystalParameters<dim> &p)
{
  const auto basis = crystal_basis<dim>(p.turn);
  const int n = int(2 * p.zone_size.norm());
  std::vector<Vector<dim>> places;
  const auto add = [&](auto &add_index, Eigen::Matrix<double, dim, 1> k, int c) -> void {
    for (int i = -n; i <= n; ++i) {
      k[c] = i + 0.25;
      if (c > 0)
        add_index(add_index, k, c - 1);
      else if (const Vector<dim> x = basis * k;
               (x.cwiseAbs().array() < (p.zone_size.array() - 1) / 2).all())
        places.push_back(x);
    }
  };
  add(add, Eigen::Matrix<double, dim, 1>::Zero(), dim - 1);
  particles::Particles<dim> atoms;
  atoms.resize(int(places.size()));
  for (int i = 0; i < atoms.size(); ++i) {
    set(atoms.reference, i, places[i]);
    atoms.volume[i] = atoms.mass[i] = std::abs(basis.determinant());
  }
  return atoms;
}

/// A box of crystal inside a box of mesh.
template <int dim>
CoupledBodies<dim> make_crystal(const CrystalParameters<dim> &p)
{
  CoupledBodies<dim> body;
  coupling::OverlapParameters<dim> overlap;
  overlap.length = p.overlap_cells * p.cell_size;
  overlap.spacing = 1;
  overlap.transition_cells = p.transition_cells;
  auto &box = overlap.zone.boxes.emplace_back();
  for (int c = 0; c < dim; ++c)
    box.upper[c] =
        p.zone_size[c] < p.size[c] ? p.zone_size[c] / 2 : std::numeric_limits<double>::infinity();
  box.lower = -box.upper;
  fem::MeshParameters<dim> mesh;
  mesh.upper = p.size / 2;
  mesh.lower = -mesh.upper;
  mesh.cell_size = p.cell_size;
  mesh.levels = 0;
  mesh.inner = overlap.zone.eroded(overlap.length).boxes;

  auto atoms = make_atoms(p);
  auto force = std::make_unique<CrystalForce<dim>>(
      atoms, 1, EmbeddingPotential(dim, 1, p.reach, p.strain, p.is_normal), 1, p.is_harmonic,
      p.faults);
  const auto constants = force->elastic_constants();
  body.zone = std::make_unique<particles::ParticleSolver<dim>>(std::move(atoms), std::move(force));
  fem::Body<dim> material;
  material.stiffness = constants.stiffness;
  material.stress = constants.stress;
  material.density = constants.density;
  std::vector<core::BoundaryLoad<dim>> loads;
  for (int side = 0; side < 2 * dim && p.holds_sides; ++side) {
    auto &hold = loads.emplace_back();
    hold.boundary = side;
    hold.value.fill(0.);
  }
  body.far = std::make_unique<fem::FemSolver<dim>>(fem::make_mesh(mesh), material, loads);
  body.dt_zone = body.zone->force->stable_step(body.zone->state);
  body.dt = p.step_fraction * body.dt_zone;
  auto bodies = body.bodies();
  body.split = std::make_unique<coupling::FineScaleSplit<dim>>(bodies, overlap, p.split, body.dt,
                                                               *body.timers);
  return body;
}

/// Everything moves as x = (1 + h) X; at rest.
template <int dim>
void move_by_gradient(CoupledBodies<dim> &body, const Eigen::Matrix<double, dim, dim> &h)
{
  auto &zone = body.zone->state;
  for (auto *velocity : {&zone.velocity, &body.far->velocity})
    for (auto &component : *velocity)
      std::fill(component.begin(), component.end(), 0.);
  for (int i = 0; i < zone.size(); ++i)
    set(zone.displacement, i, Vector<dim>(h * get(zone.reference, i)));
  for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
    set(body.far->displacement, i, Vector<dim>(h * body.far->mesh().nodes[i]));
  auto bodies = body.bodies();
  body.split->take_velocities(bodies);
}

/// Forces on the nodes of the overlap in the present state, from one kick at rest, in N.
template <int dim>
coupling::Nodal<dim> overlap_forces(CoupledBodies<dim> &body)
{
  auto bodies = body.bodies();
  coupling::StepTime step;
  step.dt = 1;
  body.split->compute_forces(bodies, step);
  body.split->kick(bodies, step);
  const auto &overlap = *body.split->overlap();
  Eigen::MatrixXd v(overlap.n_nodes(), dim);
  for (int i = 0; i < overlap.n_nodes(); ++i)
    v.row(i) = get(body.far->velocity, overlap.near_nodes[i]).transpose();
  coupling::Nodal<dim> force = body.split->near_mass() * v;
  for (int i = 0; i < overlap.n_nodes(); ++i)
    if (!overlap.is_overlap_node[i])
      force.row(i).setZero();
  return force;
}

/// C11 h^(dim-1), in N.
template <int dim>
double force_scale(const CoupledBodies<dim> &body)
{
  return body.far->body().stiffness(0, 0) * std::pow(body.split->overlap()->cell_size, dim - 1);
}

/// Largest force on an overlap node at rest in the reference, over C11 h^(dim-1).
template <int dim>
double reference_residual(CoupledBodies<dim> &body)
{
  move_by_gradient<dim>(body, Eigen::Matrix<double, dim, dim>::Zero());
  return overlap_forces(body).rowwise().norm().maxCoeff() / force_scale(body);
}

/// The same by which forces change under any of the dim^2 unit displacement gradients.
template <int dim>
double gradient_residual(CoupledBodies<dim> &body)
{
  using Matrix = Eigen::Matrix<double, dim, dim>;
  move_by_gradient<dim>(body, Matrix::Zero());
  const coupling::Nodal<dim> first = overlap_forces(body);
  double largest = 0;
  for (int k = 0; k < dim * dim; ++k) {
    Matrix h = Matrix::Zero();
    h(k / dim, k % dim) = 1;
    move_by_gradient<dim>(body, h);
    const coupling::Nodal<dim> change = overlap_forces(body) - first;
    keep_largest(largest, change.rowwise().norm().maxCoeff());
  }
  return largest / force_scale(body);
}
/// Largest force on an atom that does not move with the mesh, in the reference, over C11 d^(dim-1).
template <int dim>
double free_force(CoupledBodies<dim> &body)
{
  move_by_gradient<dim>(body, Eigen::Matrix<double, dim, dim>::Zero());
  auto bodies = body.bodies();
  body.split->compute_forces(bodies, {});
  const auto &overlap = *body.split->overlap();
  double largest = 0;
  for (int i = 0; i < body.zone->state.size(); ++i) {
    const int m = overlap.member_of_particle[i];
    if (m < 0 || !overlap.members[m].pad)
      keep_largest(largest, get(body.zone->state.force, i).norm());
  }
  return largest / body.far->body().stiffness(0, 0);
}
} // namespace ligament::tests
