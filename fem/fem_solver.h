// The finite half: explicit linear elasticity on the far-field mesh, lumped mass, same verbs as the
// discrete half.
#pragma once

#include "core/load.h"
#include "fem/mesh.h"

#include <memory>

namespace ligament::fem
{
/// Isotropic body of the mesh: stiffness equal to that of the discrete law.
template <int dim>
struct Body
{
  Stiffness<dim> stiffness; // Pa
  double density;           // kg/m^3
  double thickness = 1;     // m, 2D
};

/// Nodes carry displacement (at n) and velocity (at n + 1/2). Hanging nodes are interpolated from
/// their masters, held components follow their load exactly.
///
/// A coupler takes cells over (`release_cells`): they then add neither force nor mass here, and the
/// coupler advances their nodes, which `is_released_node` names.
template <int dim>
class FemSolver
{
public:
  FemSolver(Mesh<dim> mesh, const Body<dim> &body,
            const std::vector<core::BoundaryLoad<dim>> &loads);
  ~FemSolver();

  /// From now on the cells (by index) belong to the coupler.
  void release_cells(const std::vector<int> &cells);

  /// Overwrites `force`: minus the internal force of the solver's own cells plus tractions, with
  /// forces on hanging nodes handed to their masters. Held components get the internal force too:
  /// it is their reaction.
  void compute_forces(double time);

  /// v += dt f/m of all nodes that are not released; held components get the velocity that
  /// brings them to their load's displacement at time + dt after drift(dt).
  void kick(double dt, double time);

  /// u += dt v of all nodes that are not released; hanging nodes (of own cells) follow.
  void drift(double dt);

  /// Hanging nodes take the displacement of their masters.
  void distribute();

  double potential_energy() const;        // J, own cells; displacements as they are
  double kinetic_energy(double dt) const; // J, 1/2 v(-) M v(+), nodes not released; before kick

  /// Largest stable leap-frog step of the own cells, in s (element bound 2/omega_max).
  double stable_step() const;

  /// Lumped mass of the own cells at every node (hanging nodes' share given to their masters).
  const std::vector<double> &lumped_mass() const { return mass_; }

  /// Sum over the boundary's held nodes of the force the support exerts on the body, in N;
  /// for traction loads the sum of applied forces. Index as in the list given to the constructor.
  Vector<dim> reaction(int load) const;

  const Mesh<dim> &mesh() const { return mesh_; }
  const Body<dim> &body() const { return body_; }
  bool is_released_node(int node) const { return released_node_[node]; }
  bool is_held(int node, int component) const { return held_[component][node]; }

  Components<dim> displacement, velocity, force;

private:
  struct Kernel; // batches of equal cells
  Mesh<dim> mesh_;
  Body<dim> body_;
  std::vector<core::BoundaryLoad<dim>> loads_;
  std::unique_ptr<Kernel> kernel_;
  std::vector<double> mass_, inverse_mass_;
  std::vector<char> released_node_;
  std::array<std::vector<char>, dim> held_;
};
} // namespace ligament::fem
