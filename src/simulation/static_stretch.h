// A stretch of a static phase: loads grow without a corner, and the body answers by equilibria.
#pragma once

#include "src/simulation/clock.h"
#include "src/simulation/equilibrium_solver.h"
#include "src/simulation/load_growth.h"
#include "src/simulation/recorder.h"

namespace ligament::program
{
/// From where the body is in equilibrium along its response, and a little off it, to the first step
/// of the far field in which a bond bears its strength, or as far as it reaches (theory.md section
/// 6).
template <int dim>
class StaticStretch
{
public:
  using End = typename EquilibriumSolver<dim>::End;
  /// Makes a state that of the clock's step, with these velocities (m/s and rad/s, as y).
  using Commit = std::function<void(const Eigen::VectorXd &velocities)>;
  using Look = std::function<std::optional<Stop>()>;

  /// From the clock's step, at most to the step `reach`. Body and solver must outlive it.
  StaticStretch(CoupledBody<dim> &body, EquilibriumSolver<dim> &solver, const Clock &clock,
                long reach);

  /// How the body answers to the loads' growth.
  End find_response();
  /// After it: of equilibria at the time; zero where there is no response.
  Eigen::VectorXd velocities(double time) const;

  /// The last step and its equilibrium, where the body is then. Where it fails: n_steps() leads to
  /// the step in which none was found.
  End find_end();
  void go_back() { solver_.system().put_back(start_); }
  long n_steps() const { return end_ - begin_; }

  /// Takes body and clock to the end, or to where something breaks or the kinematics of the overlap
  /// change before; looks at all states but the last one, and passes over rows in which it finds no
  /// equilibrium. Where it may end early it does so before a state that lies far off its way:
  /// leads_astray() then.
  std::optional<Stop> walk(Clock &clock, const Commit &commit, const Look &look,
                           bool may_end_early = false);
  bool leads_astray() const { return leads_astray_; }

private:
  LoadGrowth<dim> growth_to(long step) const
  {
    return {body_.loads, time_of(begin_), time_of(step)};
  }
  double time_of(long step) const { return double(step) * dt_; }
  /// How much of each response makes what the loads have grown by.
  Eigen::VectorXd parts_of(const Eigen::VectorXd &courses) const;
  /// Along the responses, from one share of the growth to another.
  void move(double from, double to);
  /// The first step of the far field after the beginning by which the loads have grown that far.
  long step_of(double share) const;
  std::optional<double> share_that_breaks(double &slope);
  /// Largest share of its strength that a bond bears in the present place.
  double bond_share(double time, double noted);
  long n_broken() const;

  CoupledBody<dim> &body_;
  EquilibriumSolver<dim> &solver_;
  double dt_; // s
  int ratio_;
  long begin_, end_; // steps
  LoadGrowth<dim> growth_;
  typename StaticSystem<dim>::Place start_, finish_;
  /// y at several times, the end first: as many as there are courses of loads, of which the linear
  /// answers to each are made.
  std::vector<Eigen::VectorXd> responses_;
  Eigen::MatrixXd courses_at_responses_; // shares of each course, one column a response
  Eigen::VectorXd bend_;                 // y
  double share_ = 0;                     // of the growth, at the end
  bool leads_astray_ = false;
};
} // namespace ligament::program
