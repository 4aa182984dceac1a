// Preconditioned conjugate gradients for operators that are given as functions.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ligament::algebra
{
struct CgResult
{
  enum class End
  {
    converged,
    stalled,   // at round-off, or max_iterations
    indefinite // a direction that nothing resists, or whose curvature is negative
  };
  int iterations = 0;
  double residual = 0; // |right - A x|
  End end = End::stalled;
};

/// How near the computed residual can come to the true one.
class RoundOff
{
public:
  explicit RoundOff(double right) : right_(right) {}

  void see(double direction, double image, double x)
  {
    if (direction > 0)
      scale_ = std::max(scale_, image / direction);
    x_ = std::max(x_, x);
  }
  /// Largest |A v| / |v| so far: below the norm of A, soon near it.
  double scale() const { return scale_; }
  /// Of one evaluation of right - A x.
  double of_residual() const { return epsilon * (right_ + scale_ * x_); }

  static constexpr double epsilon = std::numeric_limits<double>::epsilon();

private:
  double right_, scale_ = 0, x_ = 0;
};

/// Solves A x = right from x on (zero where it is empty). apply(p, ap): ap = A p, A symmetric and
/// not negative, right in its range. precondition(r, z): z near A^-1 r, symmetric and positive.
/// Where nothing resists some motions, project_right(r) takes out of a right-hand side what they
/// feel of it and project_motion(z) their share out of a motion; each is the other's transpose, and
/// they are projectors. Stops at |r| <= tolerance (absolute). The residual is carried along and
/// taken anew in the end, by one more apply: where x is large beside what it is made of, the two
/// differ. The search then goes on as long as that helps.
template <typename Apply, typename Precondition, typename ProjectRight, typename ProjectMotion>
CgResult conjugate_gradients(Apply &&apply, Precondition &&precondition,
                             ProjectRight &&project_right, ProjectMotion &&project_motion,
                             const Eigen::VectorXd &right, Eigen::VectorXd &x, double tolerance,
                             int max_iterations)
{
  CgResult result;
  Eigen::VectorXd r, z(right.size()), p, ap(right.size());
  RoundOff round_off(right.norm());
  const auto renew_residual = [&] {
    apply(x, ap);
    round_off.see(x.norm(), ap.norm(), x.norm());
    r = right - ap;
    project_right(r);
    result.residual = r.norm();
  };
  if (x.size() == 0) {
    x.setZero(right.size());
    r = right;
    project_right(r);
    result.residual = r.norm();
  } else
    renew_residual();

  double renewed = std::numeric_limits<double>::infinity(); // |r| when it was last taken anew
  double rz_before = 0;
  int since = 0; // iterations since then
  while (true) {
    const double doubt = round_off.of_residual();
    const bool is_last = result.iterations == max_iterations;
    if (since > 0 && (result.residual <= tolerance || result.residual <= doubt || is_last)) {
      renew_residual();
      if (result.residual > tolerance &&
          (result.residual > 0.5 * renewed || result.residual <= doubt || is_last))
        return result;
      renewed = result.residual;
      since = 0;
    }
    if (result.residual <= tolerance) {
      result.end = CgResult::End::converged;
      return result;
    }
    if (is_last)
      return result;

    precondition(r, z);
    project_motion(z);
    const double rz = r.dot(z);
    if (since == 0)
      p = z;
    else
      p = z + (rz / rz_before) * p;
    rz_before = rz;
    apply(p, ap);
    const double curvature = p.dot(ap), pp = p.squaredNorm();
    round_off.see(std::sqrt(pp), ap.norm(), x.norm());
    // Not above round-off (or not a number): nothing resists p, unless r is but noise already.
    if (!(rz > 0) || !(curvature > RoundOff::epsilon * round_off.scale() * pp)) {
      renew_residual();
      if (result.residual <= tolerance)
        result.end = CgResult::End::converged;
      else if (!(result.residual <= 10 * round_off.of_residual()))
        result.end = CgResult::End::indefinite;
      return result;
    }
    const double step = rz / curvature;
    x += step * p;
    r -= step * ap;
    result.residual = r.norm();
    ++result.iterations;
    ++since;
  }
}

/// The same where everything is resisted.
template <typename Apply, typename Precondition>
CgResult conjugate_gradients(Apply &&apply, Precondition &&precondition,
                             const Eigen::VectorXd &right, Eigen::VectorXd &x, double tolerance,
                             int max_iterations)
{
  const auto nothing = [](Eigen::VectorXd &) {};
  return conjugate_gradients(apply, precondition, nothing, nothing, right, x, tolerance,
                             max_iterations);
}
} // namespace ligament::algebra
