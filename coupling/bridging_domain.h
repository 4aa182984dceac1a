// The couplers of the literature: both models weighted by their share of the energy, their
// velocities tied by multipliers.
#pragma once

#include "coupling/algebra/block_matrix.h"
#include "coupling/coupler.h"
#include "coupling/coupler_parameters.h"
#include "coupling/near_nodes.h"
#include "coupling/operators/fluctuation_projector.h"
#include "coupling/operators/velocity_constraint.h"

namespace ligament::coupling
{
/// Energy-weighted bridging domain (theory.md section 3.9). The zone's particles carry their
/// weighted masses and inertias from now on, and its force the weighted energy: kinetic and
/// potential energy of the halves are those of the blended body.
template <int dim>
class BridgingDomain : public Coupler<dim>
{
public:
  /// Weighs the zone and takes the overlap's and the transition's cells over from the far field.
  /// Stable steps are to be asked for afterwards. The overlap has no pads.
  BridgingDomain(Bodies<dim> &bodies, OverlapParameters<dim> overlap,
                 const BridgingDomainParameters &parameters, core::Timers &timers);

  void drift(Bodies<dim> &bodies, const StepTime &step) override;
  void compute_forces(Bodies<dim> &bodies, const StepTime &step) override;
  void kick(Bodies<dim> &bodies, const StepTime &step) override;
  void scale_velocities(Bodies<dim> &bodies, double factor) override;
  double damp_velocities(Bodies<dim> &bodies, const StepTime &step, double factor) override;
  CoupledEnergy energy(const Bodies<dim> &bodies, const StepTime &step) const override;

  void expand(particles::Particles<dim> &zone, Components<dim> &nodal) const override;
  void restrict_forces(particles::Particles<dim> &zone, Components<dim> &nodal) const override;
  void compute_trial(Bodies<dim> &bodies, double time, double noted_share,
                     Components<dim> &nodal_force) const override;
  void subtract_near_stiffness(const Components<dim> &u,
                               Components<dim> &nodal_force) const override;
  Eigen::SparseMatrix<double> near_stiffness() const override { return stiffness_; }

  void take_velocities(Bodies<dim> &bodies) override;
  void save(core::State &state, const Bodies<dim> &bodies) const override;
  void load(const core::State &state, Bodies<dim> &bodies) override;
  bool can_turn() const override { return false; }
  std::vector<core::SkippedPart> skipped_parts() const override;
  const Overlap<dim> *overlap() const override { return &overlap_; }
  Eigen::SparseMatrix<double> near_mass() const override { return mass_; }
  std::vector<double> near_weight(const particles::Particles<dim> &particles) const override;

  /// Largest stable step of the near cells by themselves, in s.
  double near_stable_step() const;
  int n_multipliers() const { return constraint_->n_multipliers(); }

private:
  void find_dead_load(Bodies<dim> &bodies);
  void add_dead_load(particles::Particles<dim> &zone) const;
  bool corrects_at_whole_steps() const;
  void push(Bodies<dim> &bodies, double dt);
  void move(Bodies<dim> &bodies, double dt);
  void move_and_damp(Bodies<dim> &bodies, double dt);
  void damp(Bodies<dim> &bodies, double dt);
  void book_damper(const Bodies<dim> &bodies);
  void project(Bodies<dim> &bodies);
  void compute_near_force(Nodal<dim> &force) const;

  BridgingDomainParameters parameters_;
  Overlap<dim> overlap_;
  NearNodes<dim> near_;                 // U, V
  Transfer<dim> transfer_;              // with the unweighted masses, for the constraint
  std::vector<double> shares_;          // a of the members
  Transfer<dim> weighted_transfer_;     // with the weighted masses, for the damper
  FluctuationProjector<dim> projector_; // orthogonal in the weighted masses, unless printed
  std::vector<double> rate_;            // c_f of the members, 1/s
  std::unique_ptr<VelocityConstraint<dim>> constraint_;

  Eigen::SparseMatrix<double> stiffness_, mass_; // of the near nodes
  std::unique_ptr<BlockMatrix<dim>> stiffness_blocks_;
  std::unique_ptr<LinearSolver> mass_solver_;

  Nodal<dim> force_, acceleration_;      // of the near nodes at the last kick
  Nodal<dim> dead_nodal_;                // N
  Components<dim> dead_;                 // of all particles, N; empty without
  Components<n_spins<dim>> dead_torque_; // likewise, N m
  Components<dim> member_velocity_;
  Components<dim> lost_;          // momentum that the damper took in this step, of the members
  Components<dim> before_damper_; // velocities of the members that its energy is booked with
  double fine_damper_energy_ = 0;
};
} // namespace ligament::coupling
