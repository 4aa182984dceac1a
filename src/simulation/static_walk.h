// A static phase: by equilibria from where the body is calm to the next bond that breaks.
#pragma once

#include "src/simulation/phase_list.h"
#include "src/simulation/static_stretch.h"
#include "src/simulation/test_machine.h"

#include <optional>

namespace ligament::program
{
/// What a body in equilibrium bore at the end of a static phase, before bonds broke there.
struct Borne
{
  double time = 0; // s
  std::optional<Reading> reading;
  std::int64_t n_broken = 0; // before
};

/// Settles the body under the loads of the clock's step, then follows its equilibria stretch by
/// stretch to the first step of the far field in which a bond bears its strength (theory.md section
/// 6). The energy that the body loses on its way to the first equilibrium is booked as settled.
template <int dim>
class StaticWalk
{
public:
  using End = typename StaticStretch<dim>::End;
  using Look = typename StaticStretch<dim>::Look;

  /// All must outlive it.
  /// @param damping J so far
  /// @param stretching_energy J of the motion with the loads that is in the velocities; kept up to
  ///   date
  StaticWalk(CoupledBody<dim> &body, EquilibriumSolver<dim> &solver, Clock &clock,
             const TestMachine<dim> &machine, double damping, const Look &look,
             double &stretching_energy);

  /// Takes body and clock to the end; forces and velocities are then those between forces and kick
  /// of its step.
  /// @param residual of the ledger before it in J; nullopt: the body has its forces and can be
  ///   asked
  PhaseEnd run(std::optional<double> residual);

  /// What ends the run.
  const std::optional<Stop> &stop() const { return stop_; }
  /// Without a reading where no equilibrium was found.
  const Borne &borne() const { return borne_; }
  std::int64_t n_broken() const;

private:
  double residual() const;
  void end(PhaseEnd reason) { end_ = reason; }
  void end_without_equilibrium(End found);
  /// Whether it goes on.
  bool look();

  void find_first_equilibrium();
  /// Where the kinematics of the overlap have changed the body is no longer in balance.
  void balance_again();
  /// Books what the way to equilibrium took; whether the stretch that begins here is still one.
  bool settle(const StaticStretch<dim> &stretch);
  void follow(StaticStretch<dim> &stretch);
  /// From a stretch in whose end is no equilibrium: to a shorter one, or none.
  void retreat(StaticStretch<dim> &stretch, End found);
  /// Half the stretch, in steps of the far field.
  void halve(const StaticStretch<dim> &stretch);
  bool may_halve(const StaticStretch<dim> &stretch) const
  {
    return stretch.n_steps() >= 4 * ratio_;
  }
  /// Makes a state in equilibrium that of the clock's step, with velocities (m/s, rad/s) of the
  /// body's motion with its loads.
  void commit(const Eigen::VectorXd &velocities);

  CoupledBody<dim> &body_;
  EquilibriumSolver<dim> &solver_;
  Clock &clock_;
  const TestMachine<dim> &machine_;
  double damping_; // J
  const Look &look_;
  double &stretching_energy_; // J
  int ratio_;

  const std::int64_t broken_before_;
  const double released_before_; // J
  double residual_ = 0;          // J, of the ledger before the body settles
  double regime_;                // of the overlap, that the last equilibrium is of
  bool settles_ = true;
  /// How far at once: less where no equilibrium was found so far away, or none that is stable.
  long reach_; // step
  int n_halvings_ = 0, n_strayed_ = 0;
  Eigen::VectorXd moved_;

  std::optional<PhaseEnd> end_;
  std::optional<Stop> stop_;
  Borne borne_;
};
} // namespace ligament::program
