// The default coupler: the discrete model keeps its forces and masses, the mesh carries the coarse
// part of its motion, and only the coarse energy and mass are blended.
#pragma once

#include "coupling/algebra/scalar_matrix.h"
#include "coupling/coupler.h"
#include "coupling/coupler_parameters.h"
#include "coupling/fine_motion.h"
#include "coupling/near_nodes.h"
#include "coupling/operators/coarse_energy.h"
#include "coupling/operators/patch_fit.h"
#include "coupling/zone_bath.h"

#include <optional>

namespace ligament::coupling
{
/// Figures of the set-up, for the log and for verification.
struct SplitReport
{
  int overlap_particles = 0;
  int pad_particles = 0;
  int near_nodes = 0;
  double patch_residual_before = 0; // over C11 h^(dim-1)
  double patch_residual = 0;
  double patch_modulus = 0; // max |S|/(C11 V_b)
};

/// A run with the mesh held, theory.md eq. (C30).
struct HeldRun
{
  double equilibration = 0, averaging = 0; // s
  double friction = 0;                     // 1/s, on the particles outside the overlap
};
/// Mean force of particles in thermal motion on the near nodes.
template <int dim>
struct ThermalLoad
{
  Nodal<dim> force; // N
  double error = 0; // standard error of the mean, root mean square over the nodes, in N
  long steps = 0;
};

/// v = Phi V + w in the overlap, Phi^T M w = 0 (theory.md eqs. (C1) to (C3)).
///
/// The fluctuation damper acts on w before the kick, so that one projection serves both; the
/// gap-band filter acts in the steps of the far field.
template <int dim>
class FineScaleSplit : public Coupler<dim>
{
public:
  /// Takes the overlap's and the transition's cells over from the far field. dt in s. `still`: the
  /// body without thermal motion, by whose constants the discrete energy is subtracted; null: the
  /// far field's own. `whole`: of several ranks, which all have the whole far field, the particles
  /// of the overlap and those that their forces see, none of them parted; it must outlive the
  /// coupler. Null: the zone has them.
  FineScaleSplit(Bodies<dim> &bodies, const OverlapParameters<dim> &overlap,
                 const FineScaleSplitParameters &parameters, double dt, core::Timers &timers,
                 const fem::Body<dim> *still = nullptr,
                 const particles::ParticleSolver<dim> *whole = nullptr);

  void drift(Bodies<dim> &bodies, const StepTime &step) override;
  void compute_forces(Bodies<dim> &bodies, const StepTime &step) override;
  void kick(Bodies<dim> &bodies, const StepTime &step) override;
  void scale_velocities(Bodies<dim> &bodies, double factor) override;
  double damp_velocities(Bodies<dim> &bodies, const StepTime &step, double factor) override;
  CoupledEnergy energy(const Bodies<dim> &bodies, const StepTime &step) const override;
  int step_ratio() const override { return parameters_.step_ratio; }

  void save(core::State &state, const Bodies<dim> &bodies) const override;
  void load(const core::State &state, Bodies<dim> &bodies) override;

  void expand(particles::Particles<dim> &zone, Components<dim> &nodal) const override;
  void restrict_forces(particles::Particles<dim> &zone, Components<dim> &nodal) const override;
  void compute_trial(Bodies<dim> &bodies, double time, double noted_share,
                     Components<dim> &nodal_force) const override;
  void subtract_near_stiffness(const Components<dim> &u,
                               Components<dim> &nodal_force) const override;
  void follow(Bodies<dim> &bodies) override;
  void start_velocities(Bodies<dim> &bodies, const StepTime &step) override;

  /// Splits the velocities into V and w.
  void take_velocities(Bodies<dim> &bodies) override;

  /// From now on both halves move in this regime; forces must be computed again before the next
  /// kick. The energy jumps by what the regimes differ in the present motion. Throws
  /// core::InputError when the discrete law cannot follow, and when asked to become linear again.
  void set_regime(Regime regime, Bodies<dim> &bodies) override;
  Regime regime() const { return regime_; }
  /// Forces that bear some in the reference need a law of finite strain, and no stress there.
  bool can_strain() const override { return can_strain_; }
  /// Of the near cells, in the present state.
  NearMotion<dim> largest_motion() const override
  {
    return parts_.largest_motion(near_.displacement());
  }

  /// From now on overlap and mesh wait for a wave: the near nodes stand still until the far field
  /// pulls at one of them, or particles within two bonds of the overlap are awake, and the far
  /// field does until then unless a load acts on it. `strain` is that of the pull that wakes, 0:
  /// any. To be called with all at rest but for loads, after the zone's let_rest.
  void let_rest(const Bodies<dim> &bodies, double strain) override;
  bool can_rest() const override { return true; }
  /// Shares of the steps so far that the overlap, and the far field, were left out of.
  double share_at_rest() const { return share_of(rested_); }
  double far_share_at_rest() const { return share_of(far_rested_); }
  std::vector<RestShare> shares_at_rest() const override;
  std::vector<core::SkippedPart> skipped_parts() const override;

  /// Particles move at their temperature about the mesh at rest, far field and loads as at time 0.
  /// From velocities drawn anew; afterwards nodes have such velocities, too, and the state is that
  /// which a run at this temperature begins with.
  ThermalLoad<dim> held_thermal_load(Bodies<dim> &bodies, const HeldRun &run, double dt);
  /// The same of nodes that move as well, about wherever they are drawn: theory.md eq. (C30b). From
  /// that state; leaves bodies and coupler somewhere, to be given back their state.
  ThermalLoad<dim> free_thermal_load(Bodies<dim> &bodies, double averaging, double dt);
  /// From now on the load of the reference, in N.
  void set_dead_load(const Nodal<dim> &load, const Bodies<dim> &bodies);
  /// kT in J of the velocities of this moment: of w, of the particles outside the overlap.
  double thermal_energy_of_fine(const Bodies<dim> &bodies) const;
  double thermal_energy_of_zone(const Bodies<dim> &bodies) const;
  std::array<double, 3> thermal_energies(const Bodies<dim> &bodies) const override;
  /// g in N on the near nodes; empty: no bond bears forces at first.
  const Nodal<dim> &dead_load() const { return dead_load_; }

  const SplitReport &report() const { return report_; }
  /// Its members are the particles at hand.
  const Overlap<dim> *overlap() const override { return &here(); }
  /// Coarse stiffness K_near including the patch fit, N/m.
  Eigen::SparseMatrix<double> near_stiffness() const override { return stiffness_; }
  /// M_c
  Eigen::SparseMatrix<double> near_mass() const override { return mass_; }
  std::vector<double> near_weight(const particles::Particles<dim> &particles) const override;

private:
  bool is_far_step(const StepTime &step) const { return step.step % parameters_.step_ratio == 0; }
  void kick_coarse(const StepTime &step);
  void join_bath(const Bodies<dim> &bodies, double dt);
  void exchange_heat(Bodies<dim> &bodies, const StepTime &step);
  /// Phi^T f of the particles at these places, loads as at time 0.
  Nodal<dim> handed_forces(Bodies<dim> &bodies, const Components<dim> &displacement) const;
  /// Velocities of all nodes, kT in J.
  void draw_nodes(Bodies<dim> &bodies, double thermal_energy);
  void save_bath(core::State &state) const;
  void load_bath(const core::State &state, const Bodies<dim> &bodies);
  /// Without net force, and without moment where no axis repeats itself.
  Nodal<dim> balanced(Nodal<dim> load, const fem::Mesh<dim> &mesh) const;
  bool far_rests(const Bodies<dim> &bodies, const StepTime &step);
  /// Whether a wave has come; then particles and nodes of the overlap move from now on.
  void look(Bodies<dim> &bodies, const StepTime &step);
  void wake_members(Bodies<dim> &bodies);
  double share_of(long rested) const { return kicks_ > 0 ? double(rested) / double(kicks_) : 0; }
  /// Mass damping of V by the factor; the energy in J that it takes is known after the kick.
  double damp_coarse_before_kick(double dt, double factor);
  double damp_coarse_after_kick(double dt, double factor);
  /// What mass damping of all velocities by the factor, before the kick and after it, takes of
  /// (E5), in J: eq. (E5b). After the kick.
  double damped_impulse_energy(const Bodies<dim> &bodies, double dt, double factor) const;
  void make_coarse_energy(Regime regime, const Bodies<dim> &bodies);
  std::unique_ptr<CoarseEnergy<dim>> strained_energy(const Bodies<dim> &bodies) const;
  /// force += factor times what acts once per m steps: the far field's forces, and what the
  /// nonlinear energy has beyond the corotated one. That is a small part of the stiffness and most
  /// of the work, and as slow as the mesh.
  void add_impulse(double factor, Nodal<dim> &force) const;
  Nodal<dim> slow_force_at(const Nodal<dim> &u) const;
  /// Its part of 1/2 v.K v in J, from the forces of now and dt later.
  double slow_quadratic_form(const Nodal<dim> &v, double dt) const;
  /// Force on the near nodes at this step: near cells, and in the steps in which it acts the
  /// impulse; without what the particles hand over.
  void compute_mesh_force(const StepTime &step, Nodal<dim> &force) const;
  /// The near nodes half-way through kick and impulse, in a step in which the far field acts.
  struct Halfway
  {
    Nodal<dim> velocity;                    // V
    Nodal<dim> force, acceleration;         // F and M_c^-1 F; all that acts, the impulse as force
    Nodal<dim> far_force, far_acceleration; // what of them acts once per m steps
  };
  Halfway halfway(const Bodies<dim> &bodies, const StepTime &step) const;
  /// Kinetic part of the invariant (E1) of the near nodes.
  double coarse_kinetic(const Halfway &near, double dt) const;
  /// Step error of the impulses, (E5).
  double impulse_energy(const Bodies<dim> &bodies, const Halfway &near, double dt) const;
  /// 1/2 v M v + 1/2 dt v f of w with all spins and with the velocities outside the overlap.
  double fine_kinetic(const Bodies<dim> &bodies, double dt) const;
  /// The same of the overlap's particles as they move, and of the spins of pads: of one's own,
  /// before it is rounded.
  core::ExactSum member_kinetic(const particles::Particles<dim> &zone, double dt) const;
  /// Of the members at hand.
  const Overlap<dim> &here() const { return at_hand_ ? *at_hand_ : overlap_; }

  FineScaleSplitParameters parameters_;
  const particles::ParticleSolver<dim> *whole_; // what the operators are made of
  Overlap<dim> overlap_;                        // of it
  std::unique_ptr<Overlap<dim>> at_hand_;       // null: the same
  NearNodes<dim> near_;                         // U, V
  FineMotion<dim> fine_;
  SplitReport report_;

  Eigen::SparseMatrix<double> stiffness_, correction_; // K_near with the patch fit Z; Z alone
  Nodal<dim> dead_load_;                               // g; empty: no bond bears forces at first
  bool can_strain_ = true;
  RigidFrames<dim> parts_;
  Regime regime_ = Regime::linear;
  std::unique_ptr<CoarseEnergy<dim>> coarse_, linear_; // at present, and about the reference
  std::unique_ptr<CoarseEnergy<dim>> fast_; // of coarse_ what acts in every step; null: all
  std::unique_ptr<CoarseEnergy<dim>> strained_; // of the nonlinear regime until then, if kept
  Nodal<dim> slow_force_;                   // the rest of it, in N
  Eigen::SparseMatrix<double, Eigen::RowMajor> mass_; // M_c
  ScalarMatrix<dim> filter_;                          // D
  std::unique_ptr<LinearSolver> mass_solver_;

  Nodal<dim> force_;            // on the near nodes at the last kick, N
  Nodal<dim> change_;           // of V
  Nodal<dim> middle_, lost_;    // V half-way through it, and what the filter takes there
  Nodal<dim> undamped_, swing_; // mean of V before mass damping; what V differs by from it
  double gap_filter_energy_ = 0;
  std::optional<ZoneBath<dim>> zone_bath_; // at a temperature
  bool is_periodic_ = false;

  bool rests_ = false, far_rests_ = false;
  double waking_force_ = 0; // N, on a component of a near node
  long kicks_ = 0, rested_ = 0, far_rested_ = 0;
};
} // namespace ligament::coupling
