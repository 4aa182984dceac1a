// The motion of the particles at the last common times, for comparisons with other runs. Of a body
// in parts each rank keeps that of the particles it owns.
#pragma once

#include "src/output/checkpoints.h"
#include "src/output/run_folder.h"
#include "src/output/snapshot.h"
#include "src/simulation/body_names.h"

#include <array>
#include <memory>
#include <optional>

namespace ligament::program
{
/// Of the particles.
template <int dim>
struct Motion
{
  double time = 0;              // s
  Components<dim> displacement; // m
  Components<dim> velocity;     // m/s
};

/// The motion at `time` between two looks: positions of the times of both, velocities half a step
/// `dt` before them, in s.
template <int dim>
Motion<dim> between(Motion<dim> before, const Motion<dim> &after, double dt, double time);

/// The same between two equilibria, where displacements grow at constant rates.
template <int dim>
Motion<dim> in_proportion(const Motion<dim> &before, const Motion<dim> &after, double time);

/// Runs of one scene with other meshes, zones or steps stop at other times: the motion at exactly
/// the common times (see common_time_index) is the cubic through positions and velocities of the
/// two looks around them.
template <int dim>
class SnapshotKeeper
{
public:
  /// To be called in every step in which both models stand at the same time, between forces and
  /// kick; `interval` in s to the next one. Copies nothing unless a common time is near; with
  /// `wanted` false keeps what there is.
  void look(const CoupledBody<dim> &body, const coupling::StepTime &step, double interval,
            bool wanted);

  /// The same in a static phase, at equilibria any time apart: between two of them the body moves
  /// in proportion to time.
  void look_at_equilibrium(const CoupledBody<dim> &body, const coupling::StepTime &step,
                           bool wanted);

  /// Writes what was kept, the latest first. All ranks call it; the first one writes.
  void write(const CoupledBody<dim> &body, const RunFolder &folder) const;

  void save(core::State &state) const;
  /// The motions, which checkpoints keep beside it; the body must live until they are taken, on all
  /// ranks at once. `names`: of all particles on the first rank.
  std::vector<KeptState> kept(const CoupledBody<dim> &body,
                              const std::shared_ptr<BodyNames<dim>> &names) const;
  /// Motions that are lost are missing.
  void load(const core::State &state, const std::map<std::string, core::State> &kept,
            BodyNames<dim> &names);

private:
  void take_before(const CoupledBody<dim> &body, double time);
  void drop_before();
  void keep(Motion<dim> motion);

  std::array<std::optional<Motion<dim>>, 3> kept_; // the later one first
  std::optional<Motion<dim>> before_; // at the last look, when a common time follows it
  double next_ = 0;                   // s, common time; 0 before the first look
  // Memory for the next copies, of which short runs make one every few steps: pages that are taken
  // anew each time cost as much as the step.
  Motion<dim> now_, spare_;
};
} // namespace ligament::program
