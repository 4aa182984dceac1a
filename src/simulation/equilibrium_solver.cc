#include "src/simulation/equilibrium_solver.h"

#include "core/check.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <random>

namespace ligament::program
{
namespace
{
constexpr int most_iterations = 2000;

/// Columns of the same span, in their order; those that depend on others are left out.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd &columns)
{
  Eigen::MatrixXd kept(columns.rows(), 0);
  for (int k = 0; k < columns.cols(); ++k) {
    Eigen::VectorXd x = columns.col(k);
    const double before = x.norm();
    for (int twice = 0; twice < 2; ++twice)
      x -= kept * (kept.transpose() * x).eval();
    if (x.norm() <= 1e-9 * before)
      continue;
    kept.conservativeResize(Eigen::NoChange, kept.cols() + 1);
    kept.col(kept.cols() - 1) = x.normalized();
  }
  return kept;
}

/// Anderson's acceleration of y <- y + step(y), D. G. Anderson, J. ACM 12 (1965) 547.
class Acceleration
{
public:
  /// The step that the last ones let expect to end nearest.
  void improve(const Eigen::VectorXd &y, Eigen::VectorXd &step)
  {
    if (last_y_.size() > 0) {
      y_changes_.push_back(y - last_y_);
      step_changes_.push_back(step - last_step_);
      if (int(y_changes_.size()) > most) {
        y_changes_.erase(y_changes_.begin());
        step_changes_.erase(step_changes_.begin());
      }
    }
    last_y_ = y;
    last_step_ = step;
    if (y_changes_.empty())
      return;
    Eigen::MatrixXd changes(y.size(), step_changes_.size());
    for (std::size_t k = 0; k < step_changes_.size(); ++k)
      changes.col(k) = step_changes_[k];
    const Eigen::VectorXd shares = (changes.transpose() * changes)
                                       .completeOrthogonalDecomposition()
                                       .solve(changes.transpose() * step);
    for (std::size_t k = 0; k < step_changes_.size(); ++k)
      step -= shares[k] * (y_changes_[k] + step_changes_[k]);
  }

private:
  static constexpr int most = 5;
  std::vector<Eigen::VectorXd> y_changes_, step_changes_;
  Eigen::VectorXd last_y_, last_step_;
};
} // namespace

algebra::Preconditioning preconditioning(StaticSolver solver)
{
  switch (solver) {
  case StaticSolver::cholesky:
    return algebra::Preconditioning::cholesky;
  case StaticSolver::multigrid:
    return algebra::Preconditioning::multigrid;
  case StaticSolver::parallel_multigrid:
    return algebra::Preconditioning::parallel_multigrid;
  default:
    return algebra::Preconditioning::automatic;
  }
}

template <int dim>
EquilibriumSolver<dim>::EquilibriumSolver(CoupledBody<dim> &body, algebra::Preconditioning kind,
                                          core::Ranks helpers)
    : body_(body), kind_(kind), helpers_(std::move(helpers)), system_(body)
{
  core::require(!body.zone || body.force()->has_trials(),
                "/time/loading: this force has no equilibrium to be sought; choose \"dynamic\"");
}

template <int dim>
void EquilibriumSolver<dim>::renew()
{
  preconditioner_.reset();
  if (knows_free_motions_)
    make_free_motions(orthonormal(system_.rigid_motions()), free_shares_);
}

template <int dim>
void EquilibriumSolver<dim>::prepare()
{
  if (!knows_free_motions_)
    find_free_motions();
  Faces faces = system_.touching();
  Faces changed;
  std::set_symmetric_difference(faces.begin(), faces.end(), touching_.begin(), touching_.end(),
                                std::back_inserter(changed));
  constexpr int tolerable = 6; // each costs an iteration or two
  if (preconditioner_ && int(changed.size()) <= tolerable)
    return;
  touching_ = std::move(faces);
  preconditioner_.reset();
  // Where the coupler took over more than the cells had, only a stiffer penalty leaves the matrix
  // positive.
  for (double penalty = 1;; penalty *= 10)
    try {
      preconditioner_ = algebra::make_preconditioner(kind_, system_.near_stiffness(penalty),
                                                     system_.rigid_motions(), dim, helpers_);
      return;
    } catch (const core::EnvironmentError &) {
      // Cholesky's; where several ranks had begun they no longer agree on what comes next.
      if (penalty > 100 || kind_ == algebra::Preconditioning::parallel_multigrid)
        throw;
    }
}

// Of the rigid motions, as far as supports let them be, those that cost no energy.
template <int dim>
void EquilibriumSolver<dim>::find_free_motions()
{
  knows_free_motions_ = true;
  const Eigen::MatrixXd motions = system_.rigid_motions(), kept = orthonormal(motions);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Eigen::VectorXd noise =
      Eigen::VectorXd::NullaryExpr(motions.rows(), [&] { return uniform(random); });
  const double stiff = noise.dot(system_.stiffness_times(noise)) / noise.squaredNorm();
  Eigen::MatrixXd forces(kept.rows(), kept.cols());
  for (int k = 0; k < kept.cols(); ++k)
    forces.col(k) = system_.stiffness_times(kept.col(k));
  const Eigen::MatrixXd stiffness = kept.transpose() * forces;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
      Eigen::MatrixXd((stiffness + stiffness.transpose()) / 2));
  // By forces, not by energies: a support much narrower than the body resists a rotation with an
  // energy of the order of (width/extent)^2/particles, which is near round-off.
  constexpr double nothing = 1e-10;
  Eigen::MatrixXd shares(kept.cols(), 0);
  for (int k = 0; k < kept.cols(); ++k)
    if ((forces * eigen.eigenvectors().col(k)).norm() < nothing * stiff) {
      shares.conservativeResize(Eigen::NoChange, shares.cols() + 1);
      shares.col(shares.cols() - 1) = eigen.eigenvectors().col(k);
    }
  make_free_motions(kept, shares);
}

template <int dim>
void EquilibriumSolver<dim>::make_free_motions(const Eigen::MatrixXd &rigid,
                                               const Eigen::MatrixXd &shares)
{
  free_shares_ = shares;
  free_motions_ = rigid * shares;
  free_forces_.resize(rigid.rows(), shares.cols());
  for (int k = 0; k < shares.cols(); ++k)
    free_forces_.col(k) = system_.momentum_of(free_motions_.col(k));
  const Eigen::MatrixXd works = free_motions_.transpose() * free_forces_;
  free_forces_ *= works.inverse();
}

template <int dim>
typename EquilibriumSolver<dim>::FreeShares EquilibriumSolver<dim>::free_shares() const
{
  if (!knows_free_motions_)
    return {};
  return {int(free_shares_.cols()),
          {free_shares_.data(), free_shares_.data() + free_shares_.size()}};
}

template <int dim>
void EquilibriumSolver<dim>::set_free_shares(const FreeShares &free)
{
  knows_free_motions_ = free.n >= 0;
  if (!knows_free_motions_)
    return;
  const Eigen::MatrixXd rigid = orthonormal(system_.rigid_motions());
  core::require(free.shares.size() == std::size_t(rigid.cols() * free.n),
                "the state's free motions are those of another body");
  make_free_motions(rigid,
                    Eigen::Map<const Eigen::MatrixXd>(free.shares.data(), rigid.cols(), free.n));
}

// What would move the body as a whole is taken out as the inertia of such a motion, T^T M T n: what
// is left still is a T^T f. The transpose leaves the body without momentum, as steps would.
template <int dim>
void EquilibriumSolver<dim>::project_force(Eigen::VectorXd &r) const
{
  if (free_motions_.cols() > 0)
    r -= free_forces_ * (free_motions_.transpose() * r).eval();
}

template <int dim>
void EquilibriumSolver<dim>::project_motion(Eigen::VectorXd &y) const
{
  if (free_motions_.cols() > 0)
    y -= free_motions_ * (free_forces_.transpose() * y).eval();
}

template <int dim>
algebra::CgResult EquilibriumSolver<dim>::solve(const Eigen::VectorXd &right, double absolute,
                                                Eigen::VectorXd &y)
{
  prepare();
  y.resize(0);
  const auto result = algebra::conjugate_gradients(
      [&](const Eigen::VectorXd &p, Eigen::VectorXd &kp) {
        // Particles that have turned and the mesh, which is linear, do not agree to the last digit
        // on what moves freely.
        kp = system_.stiffness_times(p);
        project_force(kp);
      },
      [&](const Eigen::VectorXd &r, Eigen::VectorXd &z) {
        preconditioner_->apply(r, z);
        system_.drop_inert(z);
      },
      [&](Eigen::VectorXd &r) { project_force(r); }, [&](Eigen::VectorXd &z) { project_motion(z); },
      right, y, absolute, most_iterations);
  ++n_solves_;
  n_iterations_ += result.iterations;
  return result;
}

template <int dim>
Eigen::VectorXd EquilibriumSolver<dim>::balance(double time, double &norm)
{
  Eigen::VectorXd r = system_.forces(time);
  const double load = system_.load_force(time);
  largest_load_ = std::max(largest_load_, load);
  if (free_motions_.cols() > 0) {
    const Eigen::VectorXd before = r;
    project_force(r);
    if (load > 0 && load >= 0.5 * largest_load_) // where it all but vanishes round-off is left
      unresisted_share_ = std::max(unresisted_share_, (before - r).lpNorm<1>() / load);
  }
  norm = r.norm();
  return r;
}

template <int dim>
typename EquilibriumSolver<dim>::End
EquilibriumSolver<dim>::find_equilibrium(double time, Eigen::VectorXd &moved, double tolerance)
{
  if (!knows_free_motions_)
    find_free_motions();
  const auto start = system_.place();
  moved = system_.held_gap(time);
  system_.displace(moved);
  constexpr int most_steps = 30, patience = 8;
  Acceleration acceleration;
  double least = std::numeric_limits<double>::infinity();
  int since_least = 0;
  End end = End::stalled;
  for (int step = 0; step < most_steps && since_least < patience; ++step) {
    double norm = 0;
    const Eigen::VectorXd r = balance(time, norm);
    const double goal = std::max(tolerance * largest_load_, system_.round_off());
    if (!(norm > goal))
      return End::converged;
    since_least = norm < 0.9 * least ? 0 : since_least + 1;
    least = std::min(least, norm);
    system_.linearise_here();
    Eigen::VectorXd y;
    const auto result = solve(r, std::max(0.3 * goal, 1e-6 * norm), y);
    if (result.end == algebra::CgResult::End::indefinite) {
      end = End::indefinite;
      break;
    }
    acceleration.improve(moved, y);
    system_.displace(y);
    moved += y;
  }
  system_.put_back(start);
  return end;
}

// Each round starts from the true residual.
template <int dim>
void EquilibriumSolver<dim>::settle_linear(double time)
{
  if (!knows_free_motions_)
    find_free_motions();
  system_.linearise_at_reference();
  system_.displace(system_.held_gap(time));
  constexpr int rounds = 3;
  for (int round = 0; round < rounds; ++round) {
    double norm = 0;
    const Eigen::VectorXd r = balance(time, norm);
    if (norm == 0)
      return;
    Eigen::VectorXd y;
    solve(r, 1e-9 * norm, y);
    system_.displace(y);
  }
}

template <int dim>
typename EquilibriumSolver<dim>::End EquilibriumSolver<dim>::find_response(double from, double to,
                                                                           Eigen::VectorXd &y)
{
  if (!knows_free_motions_)
    find_free_motions();
  const Eigen::VectorXd held = system_.held_motion(from, to);
  system_.linearise_here();
  Eigen::VectorXd growth = system_.forces(to);
  growth -= system_.forces(from);
  // Faces that are about to touch or to part: those that do at the end decide.
  constexpr int most_changes = 3; // what then is wrong yet, the next equilibrium corrects
  for (int change = 0;; ++change) {
    Eigen::VectorXd right = growth - system_.stiffness_times(held);
    constexpr double round_off = 1e-12; // what moves the body as a whole may leave it
    const double least = round_off * right.norm();
    project_force(right);
    const double norm = right.norm();
    if (norm <= least) {
      y = held;
      return End::converged;
    }
    const auto result = solve(right, 1e-6 * norm, y); // rotations matter more
    y += held;
    if (result.end == algebra::CgResult::End::indefinite)
      return End::indefinite;
    if (result.end == algebra::CgResult::End::stalled && result.residual > 1e-6 * norm)
      return End::stalled;
    const Faces known = system_.touching();
    const auto start = system_.place();
    system_.displace(y);
    system_.forces(to);
    system_.put_back(start);
    if (change == most_changes || system_.touching() == known)
      return End::converged;
  }
}

template class EquilibriumSolver<2>;
template class EquilibriumSolver<3>;
} // namespace ligament::program
