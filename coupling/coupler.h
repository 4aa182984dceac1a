// What the time loop asks of whatever joins the two halves.
#pragma once

#include "core/skipped_part.h"
#include "core/timers.h"
#include "coupling/overlap.h"
#include "coupling/regime.h"
#include "fem/fem_solver.h"
#include "particles/particle_solver.h"

#include <Eigen/SparseCore>

#include <memory>
#include <string>
#include <vector>

namespace ligament::coupling
{
/// The two halves of one body; either may be missing.
template <int dim>
struct Bodies
{
  particles::ParticleSolver<dim> *zone = nullptr;
  fem::FemSolver<dim> *far = nullptr;
};

/// Where the step stands: positions are those of `time`, velocities those of half a step before.
struct StepTime
{
  long step = 0;
  double time = 0; // s
  double dt = 0;   // s
};

/// Energy at the time of the present positions, in J; valid between the force computation and kick.
struct CoupledEnergy
{
  double kinetic_discrete = 0;
  double kinetic_far = 0;
  double potential_discrete = 0;
  double potential_far = 0;
  double blended = 0;     // 1/2 U K_near U: what the coupler took over from the far field
  double impulses = 0;    // step error of the far field's impulses, theory.md eq. (E5); 0 for m = 1
  double fine_damper = 0; // taken so far by the fluctuation damper
  double gap_filter = 0;  // taken so far by the gap-band filter
  double thermostat = 0;  // taken so far by the overlap's thermostat, less what it has given
};

/// Share of some steps so far that a part of the body was left out of.
struct RestShare
{
  std::string name;  // of the figure in a run's record
  std::string steps; // which, in words
  double share;
};

/// One time step is drift (positions), forces, kick (velocities); theory.md, "One step".
template <int dim>
class Coupler
{
public:
  /// Charges its work to the sections "discrete forces", "discrete motion", "far field" and
  /// "coupling" of the timers.
  explicit Coupler(core::Timers &timers);
  virtual ~Coupler() = default;

  /// Positions of both halves to the end of the step.
  virtual void drift(Bodies<dim> &bodies, const StepTime &step) = 0;
  /// Forces of both halves at step.time; the far field only in the steps in which it acts.
  virtual void compute_forces(Bodies<dim> &bodies, const StepTime &step) = 0;
  /// Velocities of both halves from these forces.
  virtual void kick(Bodies<dim> &bodies, const StepTime &step) = 0;
  /// Multiplies all velocities that no load prescribes.
  virtual void scale_velocities(Bodies<dim> &bodies, double factor) = 0;
  /// Mass damping of half a step, in which velocities keep this factor, those of the far field by
  /// the rate that it was given. Before the kick, and with the sign of dt changed after it; returns
  /// the energy in J that it takes (theory.md eqs. (E3), (E9)).
  virtual double damp_velocities(Bodies<dim> &bodies, const StepTime &step, double factor) = 0;
  /// Of a step before its kick. With the sign of dt changed: after it, of the same positions.
  virtual CoupledEnergy energy(const Bodies<dim> &bodies, const StepTime &step) const = 0;

  /// Steps between two actions of the far field: positions agree everywhere, and observers look, at
  /// multiples of it.
  virtual int step_ratio() const { return 1; }

  /// Makes the particles' present velocities (at half steps) ones that the coupler carries; the
  /// nodes' velocities beyond the particles' reach are taken as they are. For runs that start in
  /// motion.
  virtual void take_velocities(Bodies<dim> &) {}

  /// What the coupler remembers beyond the halves' own states; between drift and compute_forces of
  /// a step in which the far field acts. load() follows the loads of the halves into a body that
  /// was built in the same way.
  virtual void save(core::State &, const Bodies<dim> &) const {}
  virtual void load(const core::State &, Bodies<dim> &) {}

  /// Overlap and far field may turn and stretch: set_regime() knows more than the linear regime.
  virtual bool can_turn() const { return true; }
  /// And the nonlinear one.
  virtual bool can_strain() const { return can_turn(); }
  /// The regime in which they move from now on, never back to an earlier one; core::InputError when
  /// the discrete law cannot follow. Without more knowledge the far field's cells turn.
  virtual void set_regime(Regime regime, Bodies<dim> &bodies);
  /// Of the near cells at present.
  virtual NearMotion<dim> largest_motion() const { return {}; }

  // A body in equilibrium, theory.md section 6. Motions are the velocities and spins of the
  // particles and a field of all nodes; forces those of the particles and a field of all nodes.

  /// Makes a motion one that the coupler carries: z = T y.
  virtual void expand(particles::Particles<dim> &, Components<dim> & /*nodal*/) const {}
  /// Makes of forces those on the y of z = T y: T^T f.
  virtual void restrict_forces(particles::Particles<dim> &, Components<dim> & /*nodal*/) const {}
  /// Forces of a state at rest at the loads of a time (s), in which neither half stays: see
  /// particles::ParticleForce and fem::FemSolver. Overwrites forces of particles and nodes.
  virtual void compute_trial(Bodies<dim> &bodies, double time, double noted_share,
                             Components<dim> &nodal_force) const;
  /// nodal_force -= K u of the cells that the coupler took over, about the reference.
  virtual void subtract_near_stiffness(const Components<dim> & /*u*/,
                                       Components<dim> & /*nodal_force*/) const
  {
  }
  /// That K in N/m: rows of all near nodes in x, then in y, then in z; empty without overlap.
  virtual Eigen::SparseMatrix<double> near_stiffness() const { return {}; }
  /// The body was moved from outside; what follows the nodes but is no part of their motion.
  virtual void follow(Bodies<dim> &) {}
  /// The present velocities are means over a step of the far field: those before its kick are made
  /// of them, between forces and kick.
  virtual void start_velocities(Bodies<dim> &bodies, const StepTime &) { take_velocities(bodies); }

  /// It wakes what it moves: blocks of the zone may rest.
  virtual bool can_rest() const { return false; }
  /// From now on overlap and far field wait for a wave, too; `strain` is that of the pull that
  /// wakes, 0: any. To be called with all at rest but for loads, after the zone's let_rest.
  virtual void let_rest(const Bodies<dim> &, double /*strain*/) {}
  virtual std::vector<RestShare> shares_at_rest() const { return {}; }

  /// What its parameters switch off.
  virtual std::vector<core::SkippedPart> skipped_parts() const { return {}; }

  /// Twice the mean kinetic energy in J of a component of the velocities of this moment: of the
  /// particles outside the overlap, of what the mesh cannot carry, of the near nodes. Known to
  /// couplers with a heat bath.
  virtual std::array<double, 3> thermal_energies(const Bodies<dim> &) const { return {}; }

  /// Null when the halves don't overlap.
  virtual const Overlap<dim> *overlap() const { return nullptr; }
  /// Scalar mass of the overlap's near nodes including the far field's share, kg.
  virtual Eigen::SparseMatrix<double> near_mass() const { return {}; }

  /// Mass in kg on which a body force acts at each near node, beside the masses of the particles:
  /// together with these it moves the overlap as one body.
  virtual std::vector<double> near_weight(const particles::Particles<dim> &) const { return {}; }

protected:
  core::Timers &timers_;
  const int forces_, motion_, far_, coupling_; // sections
};

/// Energy in J that multiplying velocities by `factor` takes: `still` is 1/2 v M v and `moving`
/// 1/2 v M v + 1/2 dt v f of these velocities before kick(dt), dt < 0 after it (theory.md eq.
/// (E3)).
inline double scaling_loss(double still, double moving, double factor)
{
  return (1 - factor * factor) * still + (1 - factor) * (moving - still);
}

/// One half alone: the same loop without an overlap.
template <int dim>
class NullCoupler : public Coupler<dim>
{
public:
  using Coupler<dim>::Coupler;
  void drift(Bodies<dim> &bodies, const StepTime &step) override;
  void compute_forces(Bodies<dim> &bodies, const StepTime &step) override;
  void kick(Bodies<dim> &bodies, const StepTime &step) override;
  void scale_velocities(Bodies<dim> &bodies, double factor) override;
  double damp_velocities(Bodies<dim> &bodies, const StepTime &step, double factor) override;
  CoupledEnergy energy(const Bodies<dim> &bodies, const StepTime &step) const override;
  bool can_rest() const override { return true; }
};
} // namespace ligament::coupling
