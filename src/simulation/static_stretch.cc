#include "src/simulation/static_stretch.h"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
/// The last step of the far field before a load turns, one at least: within a stretch the growth
/// has one direction.
template <int dim>
long before_turn(const CoupledBody<dim> &body, const Clock &clock, int ratio, long reach)
{
  if (!LoadGrowth<dim>::may_turn(body.loads))
    return reach;
  const double now = clock.now.time, step = ratio * clock.now.dt;
  const double corner = LoadGrowth<dim>::next_corner(body.loads, now, double(reach) * clock.now.dt);
  return std::clamp(clock.now.step + ratio * long((corner - now) / step + 1e-6),
                    clock.now.step + ratio, reach);
}
} // namespace

// Where loads take several courses, a stretch ends where one of them has a corner.
template <int dim>
StaticStretch<dim>::StaticStretch(CoupledBody<dim> &body, EquilibriumSolver<dim> &solver,
                                  const Clock &clock, long reach)
    : body_(body), solver_(solver), dt_(clock.now.dt), ratio_(body.coupler->step_ratio()),
      begin_(clock.now.step), end_(before_turn(body, clock, ratio_, reach)),
      growth_(growth_to(end_)), start_(solver.system().place())
{
  if (growth_.n_courses() == 1)
    return;
  const double now = time_of(begin_);
  const double corner = LoadGrowth<dim>::next_corner(body.loads, now, time_of(end_));
  const double far_step = ratio_ * dt_;
  end_ = std::clamp(begin_ + ratio_ * long(std::ceil((corner - now) / far_step * (1 - 1e-12))),
                    begin_ + ratio_, end_);
  growth_ = growth_to(end_);
}

template <int dim>
typename StaticStretch<dim>::End StaticStretch<dim>::find_response()
{
  const int n = growth_.n_courses();
  responses_.assign(n, Eigen::VectorXd());
  courses_at_responses_.resize(n, n);
  End worst = End::converged;
  for (int k = 0; k < n; ++k) {
    const double time = time_of(begin_) + (time_of(end_) - time_of(begin_)) * (n - k) / n;
    courses_at_responses_.col(k) = growth_.shares(time);
    const End end = solver_.find_response(time_of(begin_), time, responses_[k]);
    if (end != End::converged)
      worst = end;
    if (end == End::indefinite) {
      responses_.clear();
      break;
    }
  }
  return worst;
}

// Courses that hardly differ count as one.
template <int dim>
Eigen::VectorXd StaticStretch<dim>::parts_of(const Eigen::VectorXd &courses) const
{
  if (courses.size() == 1)
    return courses;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(1e-7);
  return solver.compute(courses_at_responses_).solve(courses);
}

template <int dim>
void StaticStretch<dim>::move(double from, double to)
{
  const auto courses = [&](double share) { return growth_.shares(growth_.time_of(share)); };
  const Eigen::VectorXd way = growth_.n_courses() == 1
                                  ? Eigen::VectorXd(Eigen::VectorXd::Constant(1, to - from))
                                  : parts_of(courses(to) - courses(from));
  for (std::size_t k = 0; k < responses_.size(); ++k)
    solver_.system().displace(responses_[k], way[Eigen::Index(k)]);
}

template <int dim>
Eigen::VectorXd StaticStretch<dim>::velocities(double time) const
{
  Eigen::VectorXd y = Eigen::VectorXd::Zero(solver_.system().size());
  if (responses_.empty())
    return y;
  const Eigen::VectorXd parts = parts_of(growth_.rates(time));
  for (std::size_t k = 0; k < responses_.size(); ++k)
    y += parts[Eigen::Index(k)] * responses_[k];
  return y;
}

template <int dim>
double StaticStretch<dim>::bond_share(double time, double noted)
{
  solver_.system().forces(time, noted);
  return body_.force()->trial_share(body_.zone->state);
}

template <int dim>
long StaticStretch<dim>::n_broken() const
{
  return body_.force() ? long(body_.force()->broken_bonds().size()) : 0;
}

template <int dim>
long StaticStretch<dim>::step_of(double share) const
{
  long low = 0, high = (end_ - begin_) / ratio_;
  while (high - low > 1) {
    const long middle = low + (high - low) / 2;
    (growth_.share(time_of(begin_ + middle * ratio_)) >= share * (1 - 1e-14) ? high : low) = middle;
  }
  return begin_ + high * ratio_;
}

// Where the first bond bears its strength along the response: the largest share of the strength is
// convex in the share of the growth. Empty where none does.
template <int dim>
std::optional<double> StaticStretch<dim>::share_that_breaks(double &slope)
{
  if (!body_.force() || !body_.force()->can_break())
    return {};
  double at = 0; // the body is there
  auto &system = solver_.system();
  const auto bears = [&](double share, double noted) {
    move(at, share);
    at = share;
    return bond_share(time_of(step_of(share)), noted);
  };
  constexpr double least = 0.5, near = 0.9, exact = 2e-6;
  const double full = growth_.share(time_of(end_));
  double low = 0, at_low = 0, high = full, at_high = bears(full, least);
  std::optional<double> found;
  if (at_high >= 1) {
    // From rest the share is proportional to the load.
    double next = full / at_high;
    for (int look = 0; look < 40; ++look) {
      const double share = bears(next, at_low < near ? least : near);
      slope = at_high > share && high > next ? (at_high - share) / (high - next) : slope;
      if (share >= 1) {
        high = next;
        at_high = share;
      } else {
        low = next;
        at_low = std::max(share, least);
      }
      if (std::abs(share - 1) < exact || high - low < 1e-12 * full) {
        found = next;
        break;
      }
      next = low + (1 - at_low) / (at_high - at_low) * (high - low);
      if (look % 4 == 3) // one end may stay for long
        next = (low + high) / 2;
    }
    if (!found)
      found = high;
  }
  system.put_back(start_);
  return found;
}

// Equilibrium at the end of the stretch, moved to the first step in which a bond bears its strength
// or more.
template <int dim>
typename StaticStretch<dim>::End StaticStretch<dim>::find_end()
{
  auto &system = solver_.system();
  double slope = 0;
  const auto predicted = share_that_breaks(slope);
  long step = predicted ? step_of(*predicted) : end_;
  bend_ = Eigen::VectorXd::Zero(system.size());
  double at = 0, bore = 0; // share of the growth, of the strength
  constexpr int most_corrections = 8;
  // Where loads grow by less in a step, its number is below what the strength says.
  constexpr double over = 1e-6; // of the strength
  for (int k = 0;; ++k) {
    const double share = growth_.share(time_of(step));
    move(at, share);
    if (at > 0) { // along the parabola of walk()
      const double longer = share * share / (at * at);
      system.displace(bend_, longer - 1);
      bend_ *= longer;
    }
    // What this leaves out of balance, the next one corrects on its way.
    constexpr double rough = 1e-5;
    const bool is_rough = k == 0 && predicted;
    Eigen::VectorXd moved;
    const End end = solver_.find_equilibrium(time_of(step), moved,
                                             is_rough ? rough : EquilibriumSolver<dim>::exact);
    if (end != End::converged) {
      end_ = step;
      return end;
    }
    bend_ += moved;
    const double bears =
        body_.force() && body_.force()->can_break() ? bond_share(time_of(step), 0.5) : 0;
    if (k > 0 && share != at && (bears - bore) * (share - at) > 0)
      slope = (bears - bore) / (share - at);
    if (slope == 0 && share > 0)
      slope = bears / share;
    at = share;
    bore = bears;
    const double one_step = share - growth_.share(time_of(std::max(begin_, step - ratio_)));
    const bool is_first = bears - std::max(slope * one_step, over) < 1 || step - ratio_ <= begin_;
    const bool done = bears >= 1 ? is_first : step == end_;
    if (done && is_rough)
      continue;
    if (done || k == most_corrections) {
      end_ = step;
      share_ = share;
      finish_ = system.place();
      return end;
    }
    const double aim = slope * one_step < over ? 1 + over / 2 : 1;
    const long wanted = step_of(share + (aim - bears) / slope);
    const long other =
        bears >= 1 ? std::min(wanted, step - ratio_) : std::max(wanted, step + ratio_);
    step = std::clamp(other, begin_ + ratio_, end_);
  }
}

// Along a parabola, on which forces stay in balance to the third order in the loads: they do the
// work that the ledger books. Where faces soften a response has corners, and every row is balanced;
// so are rows that large rotations take off the parabola.
template <int dim>
std::optional<Stop> StaticStretch<dim>::walk(Clock &clock, const Commit &commit, const Look &look,
                                             bool may_end_early)
{
  auto &system = solver_.system();
  system.put_back(start_);
  const long broken_before = n_broken();
  const bool softens = body_.force() && body_.force()->softens();
  constexpr double rows_of_whole = 50;
  const int n_rows = std::max(softens ? 1 : 2,
                              int(std::ceil(rows_of_whole * double(end_ - begin_) / double(end_))));
  const double regime = body_.regime_change;
  double at = 0; // share of the growth
  const auto bent = [&](double share) {
    return share_ > 0 ? share * share / (share_ * share_) : 0;
  };
  for (int row = 1; row <= n_rows; ++row) {
    const long step = row == n_rows ? end_ : step_of(share_ * row / n_rows);
    if (step <= clock.now.step)
      continue;
    const Clock then = clock;
    clock.advance(step - clock.now.step);
    const double share = growth_.share(clock.now.time);
    if (step == end_)
      system.put_back(finish_);
    else {
      move(at, share);
      system.displace(bend_, bent(share) - bent(at));
      constexpr double off_balance = 1e-4, // of the load; work and energy lack the square of it
          astray = 1e-2;
      const double off = softens ? 0 : solver_.imbalance(clock.now.time);
      Eigen::VectorXd moved;
      const bool is_near = !may_end_early || off < astray;
      const bool is_balanced = !softens && off <= off_balance;
      const bool is_found =
          is_balanced ||
          (is_near && solver_.find_equilibrium(clock.now.time, moved) == End::converged);
      if (!is_found) { // no state to commit: the next row is asked from the last one's place
        system.displace(bend_, bent(at) - bent(share));
        move(share, at);
        clock = then;
        leads_astray_ = !softens && may_end_early;
        if (leads_astray_)
          return {};
        continue;
      }
    }
    at = share;
    commit(velocities(clock.now.time));
    if (n_broken() > broken_before || step == end_)
      return {};
    if (const auto stop = look())
      return stop;
    if (body_.regime_change != regime) // the rest of the way is that of another body
      return {};
  }
  return {};
}

template class StaticStretch<2>;
template class StaticStretch<3>;
} // namespace ligament::program
