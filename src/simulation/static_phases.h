// Loading without steps: from one breaking bond to the next by equilibria.
#pragma once

#include "core/log.h"
#include "src/output/run_record.h"
#include "src/simulation/clock.h"
#include "src/simulation/static_walk.h"

#include <memory>
#include <vector>

namespace ligament::program
{
/// A run alternates: dynamic phases, in which the loop takes its steps, until the body is calm; and
/// static ones, which end at the first step in which a bond bears its strength (theory.md section
/// 6). Signals and checkpoints wait for the end of a static phase.
template <int dim>
class StaticPhases
{
public:
  /// Looks at a state of a static phase, in which forces are those of its step: what ends the run,
  /// or nothing.
  using Look = typename StaticWalk<dim>::Look;

  /// The body must outlive it. Nothing where the scene's loading is dynamic. helpers: see
  /// algebra::make_preconditioner().
  StaticPhases(const Scene &scene, CoupledBody<dim> &body, core::Log &log,
               const core::Ranks &helpers = {});
  ~StaticPhases();
  StaticPhases(StaticPhases &&) noexcept;
  StaticPhases &operator=(StaticPhases &&) noexcept;

  /// Whether are_due() may say yes in a step in which the far field acts: it looks now and then.
  bool look_at(const Clock &clock) const;

  /// Between forces and kick of a step in which the far field acts: whether the body is calm, or
  /// the run begins. All ranks of a body in parts ask.
  bool are_due(const CoupledBody<dim> &body, const Clock &clock);

  /// A static phase: takes body and clock to the next step in which a bond breaks, or to the end;
  /// forces and velocities are then those between forces and kick of that step. `damping` in J so
  /// far. Of a whole body alone.
  std::optional<Stop> advance(CoupledBody<dim> &body, Clock &clock, double damping,
                              const Look &look);

  /// At the end of the phase of the last advance(); without a reading where it found none.
  Borne borne() const;

  /// Whether another static phase follows the last one at once: sequential loading has no steps in
  /// between, nor is there one where a face has softened to the end. Until then the forces are
  /// those of that phase's end: no others are computed, under which a second bond might break.
  bool goes_on() const;

  /// The step between two such phases, in which the clock alone moves: one bond breaks at a time.
  /// Behind it the state may be saved.
  void pass_step(const CoupledBody<dim> &body, Clock &clock, double damping);

  /// Where the run ends: the last phase is complete.
  std::vector<PhaseEntry> entries(const CoupledBody<dim> &body, const Clock &clock) const;

  void save(core::State &state) const;
  void load(const core::State &state);

private:
  struct Work;
  std::unique_ptr<Work> work_; // null: dynamic loading
};
} // namespace ligament::program
