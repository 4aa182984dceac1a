#include "src/verification/instruments/step_operator.h"

#include "src/verification/bodies/body_state.h"
#include "src/verification/instruments/eigenvalues.h"

#include <cmath>

namespace ligament::program
{
namespace
{
/// Size of unit states, in m and m/s: rotations enter forces squared.
constexpr double amplitude = 1e-14;

/// What becomes of (u, v) in m steps.
template <int dim>
Eigen::VectorXd advance(CoupledBody<dim> &body, const Eigen::VectorXd &u, const Eigen::VectorXd &v)
{
  set_displacement(body, u);
  set_velocity(body, v);
  auto bodies = body.bodies();
  body.coupler->take_velocities(bodies);
  coupling::StepTime step;
  step.dt = body.dt;
  for (; step.step < body.coupler->step_ratio(); ++step.step) {
    body.coupler->compute_forces(bodies, step);
    body.coupler->kick(bodies, step);
    body.coupler->drift(bodies, step);
  }
  Eigen::VectorXd state(2 * u.size());
  state << displacement(body), velocity(body);
  return state;
}
} // namespace

template <int dim>
Eigen::MatrixXd step_operator(CoupledBody<dim> &body)
{
  const int n = state_size(body);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(n);
  const Eigen::VectorXd rest = advance(body, zero, zero); // dead loads
  Eigen::MatrixXd matrix(2 * n, 2 * n);
  for (int k = 0; k < n; ++k) {
    set_displacement(body, zero);
    const Eigen::VectorXd unit = admissible<dim>(body, amplitude * Eigen::VectorXd::Unit(n, k));
    matrix.col(k) = (advance(body, unit, zero) - rest) / amplitude;
    matrix.col(n + k) = (advance(body, zero, unit) - rest) / amplitude;
  }
  advance(body, zero, zero);
  return matrix;
}

template <int dim>
double largest_growth(CoupledBody<dim> &body)
{
  double largest = 0;
  for (const auto &value : eigenvalues(step_operator(body)))
    if (!(std::abs(value) <= largest))
      largest = std::abs(value);
  return std::pow(largest, 1. / body.coupler->step_ratio()) - 1;
}

template Eigen::MatrixXd step_operator(CoupledBody<2> &);
template Eigen::MatrixXd step_operator(CoupledBody<3> &);
template double largest_growth(CoupledBody<2> &);
template double largest_growth(CoupledBody<3> &);
} // namespace ligament::program
