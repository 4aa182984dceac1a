// The finite half: explicit linear elasticity on the far-field mesh, lumped mass, same verbs as the
// discrete half.
#pragma once

#include "core/dashpots.h"
#include "core/hyperelastic_law.h"
#include "core/largest.h"
#include "core/load.h"
#include "fem/mesh.h"
#include "fem/pressed_faces.h"
#include "fem/side_jumps.h"

#include <array>
#include <map>
#include <memory>

namespace ligament::fem
{
template <int dim>
class CellKernel;
template <int dim>
class CorotatedKernel;

/// Names of the nodes of a mesh of a specimen (m), by their places alone: what zone the mesh leaves
/// out does not change them. Throws core::InputError where two nodes are nearer than a millionth of
/// the specimen.
template <int dim>
core::Names node_names(const Mesh<dim> &mesh, const Vector<dim> &lower, const Vector<dim> &upper);

/// Nodes carry displacement (at n) and velocity (at n + 1/2). Hanging nodes are interpolated from
/// their masters, held components follow their load exactly. Where two loads hold the same
/// component of a node, the first in the list does.
///
/// A coupler takes cells over (`release_cells`): they then add neither force nor mass nor traction
/// here, and the coupler advances their nodes, which `is_released_node` names. Nodes on the border
/// still receive force and mass from the solver's own cells.
template <int dim>
class FemSolver
{
public:
  FemSolver(Mesh<dim> mesh, const Body<dim> &body, std::vector<core::BoundaryLoad<dim>> loads);
  ~FemSolver();
  FemSolver(FemSolver &&) noexcept;
  FemSolver &operator=(FemSolver &&) noexcept;

  /// From now on the cells (by index) belong to the coupler.
  void release_cells(const std::vector<int> &cells);

  /// Mass in kg on which accelerations act at nodes that a coupler moves; at all others it is the
  /// lumped mass.
  void set_weights(const std::vector<int> &nodes, const std::vector<double> &masses);

  /// Whether every cell turns with its material (theory.md eq. (F6)); else rotations must stay
  /// small. Takes effect with the next compute_forces.
  void set_corotated(bool corotated);
  bool is_corotated() const { return corotated_ != nullptr; }
  /// Every cell turns and bears finite strain by this law of the body (eq. (C31)).
  void set_strain_law(std::shared_ptr<const core::HyperelasticLaw<dim>> law);

  /// Largest rotation in rad and largest strain (2-norm) at the centres of the solver's own cells.
  struct Motion
  {
    Largest<dim> rotation, strain;
  };
  Motion largest_motion() const;

  /// Overwrites `force`: minus the internal force of the solver's own cells plus tractions and the
  /// forces of supports, with forces on hanging nodes handed to their masters. The force on a held
  /// component thus is the one that moves its mass as the load prescribes in steps of the last
  /// kick (theory.md eq. (F9)), none before the first. Hanging nodes are distributed first;
  /// external work is booked.
  void compute_forces(double time);

  /// Behind compute_forces(): adds a force (N) on a node that no load of its own explains, as of a
  /// body that touches it. Of a held component its support bears it, and does its work.
  void push(int node, const Vector<dim> &f);

  /// The same of a state at rest that the body may not stay in: nothing is booked. On held
  /// components nothing acts; reaction() is what supports answer the cells with.
  void compute_trial(double time);
  /// Adds factor times how held components of all nodes move from one time to another (s).
  void add_held_motion(double from, double to, double factor, Components<dim> &u) const;
  /// Adds what they lack to where their loads have them at the time.
  void add_held_gap(double time, Components<dim> &u) const;
  /// force -= K u for any motion u of the own cells about the reference, m and N: hanging nodes are
  /// made to follow, and hand what acts on them to their masters.
  void subtract_stiffness(Components<dim> &u, Components<dim> &force) const;

  /// v += dt f/m of all nodes that are not released; held components get the velocity that
  /// brings them to their load's displacement at time + dt after drift(dt). Absorbing sides brake.
  void kick(double dt, double time);

  /// u += dt v of all nodes that are not released; then all hanging nodes follow.
  void drift(double dt);

  /// Velocities of all nodes times factor, except held components, which move as prescribed.
  void scale_velocities(double factor);

  /// The rate in 1/s of the mass damping that damp_velocities() applies. Supports then carry the
  /// drag of the components that they hold.
  void set_mass_damping(double rate);
  /// Mass damping of half the step dt, before kick(dt); after it, with the sign of dt changed, the
  /// other half. Returns the energy in J that it takes (theory.md eq. (E3)), that of held
  /// components with the second half.
  double damp_velocities(double dt);

  /// Hanging nodes take displacement and velocity of their masters, those beyond joined sides with
  /// the jumps of the last compute_forces.
  void distribute();
  /// The same of any nodal field, without jumps.
  void follow_masters(Components<dim> &field) const;

  /// Elastic energy of the solver's own cells, with the displacements as they are; in J.
  double potential_energy() const;

  /// 1/2 u.K u of the solver's own cells for any nodal field, hanging nodes included; K is the
  /// stiffness in the present state when the cells turn.
  double quadratic_form(const Components<dim> &u) const;

  /// Velocities half-way through kick(dt); those of released nodes as they are.
  Components<dim> halfway_velocity(double dt) const;

  /// sum f.f/m, in N^2/kg, of nodes that are not released.
  double squared_force() const;

  /// 1/2 v(-) M v(+) with v(+) = v(-) + dt f/m, in J, of nodes that are not released; before kick.
  /// Inertia and drag of held components are in `force`, in external_work and in reaction, too.
  double kinetic_energy(double dt) const;

  /// Work done on the body by supports and tractions at nodes that are not released, in J: the
  /// force of the previous and the present compute_forces, averaged, times the displacement in
  /// between. kinetic + potential - external work is then an exact invariant. Where a motion jumps
  /// at the first kick, what this gives the held nodes.
  double external_work() const { return external_work_; }

  /// Energy that absorbing sides and their layers have taken, in J.
  double absorbed_energy() const { return dashpots_.energy(); }

  /// Largest stable leap-frog step of the own cells, in s (element bound 2/omega_max); infinite if
  /// there are none.
  double stable_step() const;

  /// Lumped mass of the own cells at every node in kg (hanging nodes' share given to their
  /// masters).
  const std::vector<double> &lumped_mass() const { return mass_; }

  /// Whether a load moves or pulls any of the nodes at a time in s.
  bool is_loaded(double time) const;

  /// Sum over the nodes that the load holds of the force the support exerts on the body, in N,
  /// without inertia where it is a displacement that jumps; for traction loads the sum of applied
  /// forces. Index as in the list given to the constructor.
  Vector<dim> reaction(int load) const;

  /// Of a traction: the area in m^2 on which it acts on the own cells.
  double loaded_area(int load) const;
  /// Number of the nodes that the load holds.
  int n_held_nodes(int load) const;

  /// Motion, absorbing sides and what the next work is booked against, between drift and
  /// compute_forces, as the tables "nodes", "loaded_nodes", "far_dashpots" and "far_field". Names
  /// of nodes: node_names(). Nodes without rows stay as they are.
  void save(core::State &state, const core::Names &names) const;
  void load(const core::State &state, const core::Names &names);

  const Mesh<dim> &mesh() const { return mesh_; }
  const Body<dim> &body() const { return body_; }
  bool is_released_node(int node) const { return released_node_[node]; }
  bool is_own_cell(int cell) const { return is_own_cell_[cell]; }
  bool is_held(int node, int component) const { return held_[component][node]; }

  Components<dim> displacement, velocity, force;

private:
  /// A component of a node on which a load acts.
  struct LoadedComponent
  {
    int node, component, load;
    double area; // m^2, of tractions: the node's share of the side; of accelerations its mass, kg
    bool counts_when_released = false;          // its work is booked whoever moves the node
    double force = 0;                           // N, on the body, at the last compute_forces
    double old_force = 0, old_displacement = 0; // at the one before
    double way = 0;                             // m, that the last work was booked for
  };

  void find_held_components();
  void update_own_cells();
  /// Of the own cells, per node, in m^2; times the cells' extent along the normal in m^3.
  std::vector<double> side_areas(int boundary, bool times_depth = false) const;
  /// Shares of the nodes in the part that the load acts on, in m^2; of the own cells.
  std::vector<double> loaded_areas(const core::BoundaryLoad<dim> &load) const;
  void add_body_forces();
  void find_pressed_faces();
  void add_pressures(double time);
  void find_dashpots();
  void hand_to_masters(std::vector<double> &values) const;
  /// Displacement of a held component at a time in s, in m.
  double prescribed(const LoadedComponent &h, double time) const
  {
    return loads_[h.load].displacement(h.component, time);
  }
  double support_force(const LoadedComponent &h, double time) const; // on the body, in N
  double held_drag(double dt) const; // J, taken from held components in the last kick
  void book_work();
  /// Overwrites `force` by that of cells and tractions.
  void add_up_forces(double time);

  /// visit(key, component of a node) for every one on which a load acts, key its name, component
  /// and 0 where it is held, 1 + the number of the load else.
  template <typename Solver, typename Visit>
  static void for_each_loaded(Solver &solver, const core::Names &names, Visit &&visit);

  Mesh<dim> mesh_;
  Body<dim> body_;
  std::vector<core::BoundaryLoad<dim>> loads_;
  std::vector<char> is_own_cell_, released_node_;
  std::array<std::vector<char>, dim> held_;
  std::vector<std::pair<int, int>> own_ranges_; // nodes that are not released
  std::unique_ptr<CellKernel<dim>> kernel_;
  std::unique_ptr<CorotatedKernel<dim>> corotated_;              // null: linear
  std::shared_ptr<const core::HyperelasticLaw<dim>> strain_law_; // null: linear in turned axes
  std::vector<double> mass_, inverse_mass_;
  std::vector<std::pair<int, double>> weights_; // kg, of nodes where it is not the mass
  std::vector<LoadedComponent> held_components_, traction_components_;
  std::map<std::array<int, 2>, int> place_of_held_; // of node and component in held_components_
  /// A part of what a pressed face gives to a node: hanging ones hand it to their masters.
  struct PressedShare
  {
    int first; // of the node's components in traction_components_
    double share;
  };
  std::vector<std::pair<PressedFace<dim>, std::vector<PressedShare>>> pressed_;
  core::Dashpots<dim> dashpots_;
  SideJumps<dim> jumps_;
  double external_work_ = 0;
  double damping_rate_ = 0; // 1/s
  double step_ = 0;         // s, of the last kick; 0: none yet
  double support_step_ = 0; // s, of which supports gave inertia and drag at the last compute_forces
  bool has_previous_forces_ = false;
};
} // namespace ligament::fem
