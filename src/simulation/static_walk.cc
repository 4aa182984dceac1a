#include "src/simulation/static_walk.h"

#include "src/simulation/energy_ledger.h"

#include <algorithm>

namespace ligament::program
{
namespace
{
constexpr int most_halvings = 5, most_strayed = 10;
// Of the balance of forces: an equilibrium to hand on to where the stretch ends.
constexpr double near = 1e-6;
} // namespace

template <int dim>
StaticWalk<dim>::StaticWalk(CoupledBody<dim> &body, EquilibriumSolver<dim> &solver, Clock &clock,
                            const TestMachine<dim> &machine, double damping, const Look &look,
                            double &stretching_energy)
    : body_(body), solver_(solver), clock_(clock), machine_(machine), damping_(damping),
      look_(look), stretching_energy_(stretching_energy), ratio_(body.coupler->step_ratio()),
      broken_before_(n_broken()),
      released_before_(body.force() ? body.force()->losses().fracture : 0),
      regime_(body.regime_change), reach_(clock.n_steps)
{
}

template <int dim>
std::int64_t StaticWalk<dim>::n_broken() const
{
  return body_.force() ? std::int64_t(body_.force()->n_broken()) : 0;
}

template <int dim>
double StaticWalk<dim>::residual() const
{
  return read_ledger(body_, clock_.now, damping_).residual();
}

template <int dim>
void StaticWalk<dim>::end_without_equilibrium(End found)
{
  end(found == End::indefinite ? PhaseEnd::no_resistance : PhaseEnd::out_of_balance);
}

template <int dim>
bool StaticWalk<dim>::look()
{
  if ((stop_ = look_()))
    end(PhaseEnd::stopped);
  return !stop_;
}

template <int dim>
PhaseEnd StaticWalk<dim>::run(std::optional<double> residual)
{
  solver_.renew();
  residual_ = residual ? *residual : this->residual();
  find_first_equilibrium();
  while (!end_) {
    StaticStretch<dim> stretch(body_, solver_, clock_, reach_);
    const End response = stretch.find_response();
    if (settles_ && !settle(stretch))
      continue;
    const End found = response == End::converged ? stretch.find_end() : response;
    if (found == End::converged)
      follow(stretch);
    else
      retreat(stretch, found);
  }
  return *end_;
}

template <int dim>
void StaticWalk<dim>::find_first_equilibrium()
{
  const auto velocities = solver_.system().velocities();
  const End found = solver_.find_equilibrium(clock_.now.time, moved_, near);
  if (found == End::converged)
    return;
  solver_.system().put_back(velocities);
  auto bodies = body_.bodies();
  body_.coupler->compute_forces(bodies, clock_.now);
  end_without_equilibrium(found);
}

template <int dim>
void StaticWalk<dim>::balance_again()
{
  regime_ = body_.regime_change;
  residual_ = residual();
  settles_ = true;
  solver_.renew();
  const End found = solver_.find_equilibrium(clock_.now.time, moved_, near);
  if (found != End::converged)
    end_without_equilibrium(found);
}

template <int dim>
bool StaticWalk<dim>::settle(const StaticStretch<dim> &stretch)
{
  settles_ = false;
  commit(stretch.velocities(clock_.now.time));
  body_.settled += residual_ - residual();
  if (n_broken() > broken_before_) {
    end(PhaseEnd::above_strength);
    return false;
  }
  if (!look())
    return false;
  if (body_.regime_change == regime_)
    return true;
  balance_again();
  return false;
}

template <int dim>
void StaticWalk<dim>::halve(const StaticStretch<dim> &stretch)
{
  reach_ = clock_.now.step + stretch.n_steps() / (2 * ratio_) * ratio_;
}

template <int dim>
void StaticWalk<dim>::retreat(StaticStretch<dim> &stretch, End found)
{
  stretch.go_back();
  if (n_halvings_ < most_halvings && may_halve(stretch)) {
    ++n_halvings_;
    halve(stretch);
    return;
  }
  commit(stretch.velocities(clock_.now.time));
  end_without_equilibrium(found);
}

template <int dim>
void StaticWalk<dim>::follow(StaticStretch<dim> &stretch)
{
  const long last = clock_.now.step + stretch.n_steps();
  const auto commit_here = [&](const Eigen::VectorXd &velocities) {
    if (clock_.now.step == last) { // before bonds break and the load drops
      solver_.system().forces(clock_.now.time);
      borne_ = {clock_.now.time, machine_.read(body_, clock_.now.time), n_broken()};
    }
    commit(velocities);
  };
  const bool may_end_early = n_strayed_ < most_strayed && may_halve(stretch);
  if ((stop_ = stretch.walk(clock_, commit_here, look_, may_end_early)))
    return end(PhaseEnd::stopped);
  if (stretch.leads_astray()) {
    ++n_strayed_;
    return halve(stretch);
  }
  if (n_broken() > broken_before_) {
    constexpr double nothing = 1e-6;
    const auto losses = body_.force()->losses();
    const bool was_soft =
        body_.force()->softens() && losses.fracture - released_before_ <= nothing * losses.cohesive;
    return end(was_soft ? PhaseEnd::face_torn : PhaseEnd::bond_breaks);
  }
  if (clock_.is_at_end())
    return end(PhaseEnd::end_of_run);
  if (!look())
    return;
  n_halvings_ = n_strayed_ = 0;
  reach_ = std::min(clock_.n_steps, clock_.now.step + 4 * stretch.n_steps());
  if (body_.regime_change != regime_)
    balance_again();
}

// The body stretches at the rate of its loads. That it does so no step has seen: the loads' work is
// that of bodies without inertia, and the energy of this motion is booked beside it.
template <int dim>
void StaticWalk<dim>::commit(const Eigen::VectorXd &velocities)
{
  auto &system = solver_.system();
  if (ratio_ > 1)
    system.forces(clock_.now.time); // of the far field, which its impulses are made of
  system.set_velocities(velocities, clock_.now);
  const double stretching = system.motion_energy(clock_.now);
  body_.settled -= stretching - stretching_energy_;
  stretching_energy_ = stretching;
  if (body_.force())
    body_.force()->resume_at(clock_.now.time - clock_.now.dt);
  auto bodies = body_.bodies();
  body_.coupler->compute_forces(bodies, clock_.now);
}

template class StaticWalk<2>;
template class StaticWalk<3>;
} // namespace ligament::program
