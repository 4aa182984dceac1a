// The discrete half: particles, their force, and the verbs of the time loop.
#pragma once

#include "core/dashpots.h"
#include "particles/body_force.h"
#include "particles/halo.h"
#include "particles/particle_force.h"

#include <memory>

namespace ligament::particles
{
/// Leap-frog: velocities live at n + 1/2, displacements at n.
template <int dim>
class ParticleSolver
{
public:
  ParticleSolver(Particles<dim> particles, std::unique_ptr<ParticleForce<dim>> force);

  /// v += dt f/m, spin += dt T/J; then absorbing sides brake.
  void kick(double dt);

  /// u += dt v; orientations turn by dt spin (exactly, for a constant spin over the step).
  void drift(double dt);

  /// The particles at hand are a part of a body from now on, the others are on other ranks: forces
  /// see the motion of ghosts, sums are those of the body. To be called once, by all ranks; the
  /// force refuses what it can't part (core::InputError on all ranks).
  void join(const Owners &owners);

  /// After drift: the motion of particles that are seen, but not stepped; what that reaches wakes.
  /// One process has none.
  void update_ghosts();

  void compute_forces(double time)
  {
    force->compute(state, time);
    if (body_force.is_empty())
      return;
    body_force.add_forces(state, time);
    body_force.book_work(state, time);
  }
  /// The same of a state at rest that the body may not stay in: see ParticleForce.
  void compute_trial(double time, double noted_share)
  {
    force->compute_trial(state, time, noted_share);
    if (!body_force.is_empty())
      body_force.add_forces(state, time);
  }

  /// In J, that dashpots took and that accelerations did; of the body, whose ranks all ask.
  double absorbed_energy() const { return ranks_.sum(dashpots.energy_sum()).value(); }
  double body_force_work() const
  {
    return body_force.is_empty() ? 0 : ranks_.sum(body_force.work()).value();
  }

  double potential_energy() const { return force->potential_energy(state); }

  /// 1/2 v(-) M v(+) with v(+) = v(-) + dt f/m: the kinetic part of the leap-frog's exact
  /// invariant at the time of the present forces, in J; call before kick(dt). Exact over blocks
  /// of particles.
  double kinetic_energy(double dt) const { return ranks_.sum(kinetic_sum(dt)).value(); }
  /// Of what is at hand, before it is rounded: sums of parts merge into that of the body.
  core::ExactSum kinetic_sum(double dt) const;

  /// Velocities and spins of all particles times factor.
  void scale_velocities(double factor);
  /// The same; returns the energy in J that it takes from kinetic_energy(dt), exact over blocks of
  /// particles. Before kick(dt), with the sign of dt changed after it (theory.md eq. (E3)).
  core::ExactSum damp_velocities(double factor, double dt);

  /// From now on blocks at rest are passed over. To be called with the forces of the present state;
  /// afterwards particles that are not awake must not be moved from outside.
  void let_rest(const RestLimits &limits = {});

  /// Wakes the blocks of these particles: something is about to move them from outside.
  void wake(const std::vector<int> &particles) { rest_->wake(particles); }

  /// Null: all particles take every step.
  const RestBlocks<dim> *rest() const { return rest_.get(); }

  const core::Ranks &ranks() const { return ranks_; }
  const Halo<dim> &halo() const { return halo_; }

  /// Particles, force, absorbing sides and what rests; between drift and compute_forces. Of a part
  /// the rows of what it owns, without what rests (core/ranks_state.h makes the whole of them).
  void save(core::State &state) const;
  /// Into a body that was built in the same way. let_rest() comes before it where it was called;
  /// parts, which take their share of the state of the whole body, then rest no more.
  void load(const core::State &state);

  Particles<dim> state;
  std::unique_ptr<ParticleForce<dim>> force;
  core::Dashpots<dim> dashpots; // of absorbing sides, at the particles that are stepped
  BodyForce<dim> body_force;

private:
  /// visit(begin, end) for the particles that take the step.
  template <typename Visit>
  void for_each_awake(Visit &&visit) const;

  std::unique_ptr<RestBlocks<dim>> rest_;
  core::Ranks ranks_;
  Halo<dim> halo_;
};
} // namespace ligament::particles
