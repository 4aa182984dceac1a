#include "src/verification/instruments/noise_run.h"

#include "core/check.h"
#include "core/extremes.h"
#include "src/verification/instruments/linear_motion.h"

#include <Eigen/Dense>

#include <cmath>
#include <optional>
#include <random>

namespace ligament::program
{
namespace
{
/// Velocities of consecutive steps around a sample, and the part of (E7) that they make.
template <int dim>
class ShadowTerms
{
public:
  ShadowTerms(CoupledBody<dim> &body, int terms)
      : motion_(body), coefficients_(shadow_coefficients(body.dt / body.dt_zone, terms))
  {
    motion_.rest();
  }

  int window() const { return int(coefficients_.size()) + 2; }
  void add_velocities() { past_.push_back(motion_.velocities()); }

  /// Of the velocities added since the last call.
  double take()
  {
    double sum = 0;
    for (int k = 0; k < int(coefficients_.size()); ++k) {
      const int first = (window() - 3 - k) / 2; // in the middle, as far as it goes
      sum += coefficients_[k] * (motion_.inner(past_[first + 1], past_[first + 1 + k]) -
                                 motion_.inner(past_[first], past_[first + 2 + k]));
    }
    past_.clear();
    return sum;
  }

private:
  LinearMotion<dim> motion_;
  std::vector<double> coefficients_;
  std::vector<Eigen::VectorXd> past_;
};
} // namespace

template <int dim>
void start_noise(CoupledBody<dim> &body, double amplitude)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-amplitude, amplitude);
  const auto fill = [&](auto &components) {
    for (auto &component : components)
      for (double &v : component)
        v = uniform(random);
  };
  if (body.zone)
    fill(body.zone->state.velocity);
  if (body.far) {
    fill(body.far->velocity);
    body.far->distribute();
  }
  auto bodies = body.bodies();
  body.coupler->take_velocities(bodies);
}

template <int dim>
EnergySeries run_noise(CoupledBody<dim> &body, double amplitude, long n_steps, int interval,
                       int shadow_terms)
{
  std::optional<ShadowTerms<dim>> shadow;
  if (shadow_terms > 0)
    shadow.emplace(body, shadow_terms);
  core::require(!shadow || shadow->window() <= interval, "samples of the shadow energy overlap");
  start_noise(body, amplitude);
  auto bodies = body.bodies();
  EnergySeries series = {interval, {}, {}};
  coupling::StepTime step;
  step.dt = body.dt;
  const int sample = shadow ? shadow->window() / 2 : 0; // place in the interval
  for (; step.step < n_steps; ++step.step, step.time = step.step * step.dt) {
    const int place = step.step % interval;
    body.coupler->compute_forces(bodies, step);
    if (shadow && place < shadow->window())
      shadow->add_velocities();
    if (place == sample) {
      const auto e = body.coupler->energy(bodies, step);
      series.leap_frog.push_back(e.kinetic_discrete + e.kinetic_far + e.potential_discrete +
                                 e.potential_far + e.blended + e.impulses);
      core::require(std::isfinite(series.leap_frog.back()),
                    "the energy of step " + std::to_string(step.step) + " is not a number");
    }
    if (shadow && place == shadow->window() - 1)
      series.shadow.push_back(series.leap_frog.back() + shadow->take());
    body.coupler->kick(bodies, step);
    body.coupler->drift(bodies, step);
  }
  return series;
}

Course course_of(const std::vector<double> &series, int interval)
{
  constexpr int n_blocks = 50;
  const int per_block = int(series.size()) / n_blocks;
  double mean = 0;
  for (const double e : series)
    mean += e / double(series.size());
  std::vector<double> block(n_blocks, 0.);
  double xx = 0, xy = 0, yy = 0, y = 0;
  for (int b = 0; b < n_blocks; ++b) {
    for (int k = 0; k < per_block; ++k)
      block[b] += (series[b * per_block + k] / mean - 1) / per_block;
    const double x = b - (n_blocks - 1) / 2.;
    xx += x * x;
    xy += x * block[b];
    y += block[b];
    yy += block[b] * block[b];
  }
  const double slope = xy / xx, scale = 1e5 / (double(per_block) * interval);
  const double scatter = std::max(0., yy - y * y / n_blocks - slope * slope * xx);
  Course course = {std::abs(slope) * scale, std::sqrt(scatter / (n_blocks - 2) / xx) * scale, 0};
  for (const double e : series)
    keep_largest(course.fluctuation, std::abs(e / mean - 1));
  return course;
}

std::vector<double> shadow_coefficients(double fraction, int terms)
{
  // Interpolation of (E8) in the cosine of the mode's turn per step, at Chebyshev points.
  const double least = 1 - 2 * fraction * fraction;
  Eigen::MatrixXd matrix(terms, terms);
  Eigen::VectorXd right(terms);
  for (int i = 0; i < terms; ++i) {
    const double cosine = (1 + least) / 2 + (1 - least) / 2 * std::cos(M_PI * (i + 0.5) / terms);
    const double turn = std::acos(cosine), sine = std::sin(turn);
    right[i] = (turn / 2 / std::tan(turn / 2) - (1 + cosine) / 2) / (2 * sine * sine);
    for (int k = 0; k < terms; ++k)
      matrix(i, k) = std::sin((k + 1) * turn) / sine;
  }
  const Eigen::VectorXd c = matrix.fullPivLu().solve(right);
  return {c.data(), c.data() + terms};
}

template void start_noise(CoupledBody<2> &, double);
template void start_noise(CoupledBody<3> &, double);
template EnergySeries run_noise(CoupledBody<2> &, double, long, int, int);
template EnergySeries run_noise(CoupledBody<3> &, double, long, int, int);
} // namespace ligament::program
