// The body as a static solver sees it: unknowns, what is out of balance, and how stiff it answers.
#pragma once

#include "algebra/block_matrix.h"
#include "src/simulation/coupled_body.h"

namespace ligament::program
{
/// Vectors have a block of dim displacements (m) and the spins' rotations (rad) for each particle,
/// then for each node, whose rotations are none. Motions z of the body are T y (theory.md eq.
/// (Q1)); forces on y are T^T f. Pads, hanging nodes, held components and rotations that nothing
/// has are inert: no unknown, and no force on them.
template <int dim>
class StaticSystem
{
public:
  static constexpr int block = n_particle_dofs<dim>;

  explicit StaticSystem(CoupledBody<dim> &body);

  int size() const { return int(is_inert_.size()); }
  long n_unknowns() const;

  /// What acts on the unknowns in the present state at the loads of `time` (s), in N and N m; see
  /// ParticleForce::compute_trial.
  Eigen::VectorXd forces(double time, double noted_share = 1);
  /// Sum over the loads of what each exerts on the body, in N; of the last forces(), at `time` (s).
  /// Of a pressure the force on all of its faces, however they balance: on a closed rim they do.
  /// Of a body force the body's weight.
  double load_force(double time) const;

  /// A force in N that is round-off in this body: what a strain of 1e-15 would make act on a face.
  double round_off() const;

  /// K y: minus what a small motion y makes act. Inert numbers of y count.
  Eigen::VectorXd stiffness_times(const Eigen::VectorXd &y);
  /// From now on K is that about the present place; or again, as at first, about the reference.
  void linearise_here();
  void linearise_at_reference();

  /// T^T M T y: the momentum of a motion; there is none in the y that T takes for no motion at all.
  Eigen::VectorXd momentum_of(const Eigen::VectorXd &y);

  /// Motion of held components alone between two times, over a factor.
  Eigen::VectorXd held_motion(double from, double to, double factor = 1) const;

  /// What they lack to where the loads of `time` have them.
  Eigen::VectorXd held_gap(double time) const;

  /// Moves the body by factor T y; its velocities are lost.
  void displace(const Eigen::VectorXd &y, double factor = 1);
  /// Velocities T y of the body before the kick of a step in which the far field acts.
  void set_velocities(const Eigen::VectorXd &y, const coupling::StepTime &step);

  /// Energy in J of its present motion, that of the far field's impulses included, as if nothing
  /// broke in the step.
  double motion_energy(const coupling::StepTime &step);

  /// Where the body is, and back there.
  struct Place
  {
    Components<dim> zone, far;
    Components<particles::Particles<dim>::n_rotations> rotation;
  };
  Place place() const;
  void put_back(const Place &place);

  /// How it moves, and so again; as the coupler carries it.
  struct Velocities
  {
    Components<dim> zone, far;
    Components<n_spins<dim>> spin;
  };
  Velocities velocities() const;
  void put_back(const Velocities &velocities);

  /// A sparse matrix near to K on all y (theory.md eq. (Q3)); overlap particles hang on the mesh by
  /// `penalty` times the springs that serve best.
  algebra::BlockMatrix near_stiffness(double penalty) const;

  void drop_inert(Eigen::VectorXd &y) const;

  /// Faces that touched in the state of the last forces(): both particles, and 1 where they stick;
  /// with 2 those that soften and would open further.
  std::vector<std::array<int, 3>> touching() const;

  /// Translations of the present body and small rotations about the middle of the specimen, one
  /// column each, as motions y.
  Eigen::MatrixXd rigid_motions() const;

private:
  int node_block(int node) const { return n_particles_ + node; }
  void find_inert();
  void find_node_masses();
  double whole_mass() const; // kg
  /// Forces and torques of the bonds about_, moved by scale times motion_'s velocities.
  void compute_bonds_near(double scale);
  void take(const Eigen::VectorXd &y, particles::Particles<dim> &zone,
            Components<dim> &nodal) const;
  Eigen::VectorXd give(const particles::Particles<dim> &zone, const Components<dim> &nodal,
                       double factor) const;
  Components<dim> nodal_zero() const;
  void put_nodal(const Components<dim> &nodal, Eigen::VectorXd &y) const;

  CoupledBody<dim> &body_;
  int n_particles_, n_nodes_;
  std::vector<char> is_inert_;       // of each number of y
  std::vector<double> node_mass_;    // kg, beside that of the particles
  particles::Particles<dim> motion_; // scratch: a small motion of the zone
  Place about_;                      // what K is linearised about; far is not asked for
  bool is_at_reference_ = true;      // about_ is
};
} // namespace ligament::program
