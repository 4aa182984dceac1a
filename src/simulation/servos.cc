#include "src/simulation/servos.h"

#include "src/scene/servo_scales.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
// R.m.s. error over the largest wanted value that is worth a warning.
constexpr double much = 0.05;

/// Only what a servo follows: others may be dear to read.
Scene with_followed_gauges(const Scene &scene)
{
  Scene followed = scene;
  followed.gauges.clear();
  for (const GaugeParameters &gauge : scene.gauges)
    if (std::any_of(scene.loads.begin(), scene.loads.end(), [&](const LoadParameters &load) {
          return load.servo && followed_gauge(scene, *load.servo) == &gauge;
        }))
      followed.gauges.push_back(gauge);
  return followed;
}
} // namespace

template <int dim>
Servos<dim>::Servos(const Scene &scene, const CoupledBody<dim> &body, core::Log &log)
{
  const bool has_some = std::any_of(scene.loads.begin(), scene.loads.end(),
                                    [](const auto &load) { return load.servo.has_value(); });
  if (!has_some)
    return;
  gauges_.emplace(with_followed_gauges(scene), body);
  for (const ServoTarget<dim> &target : servo_targets(scene, body, *gauges_)) {
    const LoadParameters &load = scene.loads[target.load()];
    const double response = servo_response(scene, *load.servo);
    const double fastest = std::abs(*load.velocity[steered_component(load)]);
    machines_.push_back(
        {target, ServoLaw(target.gain(), response, load.servo->wanted()), fastest, nullptr});
    log.info("servo of load {}: answers within {:.3g} s, gain {:.3g} {}/m, at most {:.3g} m/s",
             target.load(), response, target.gain(), target.column().unit, fastest);
  }
  take_courses(body);
}

template <int dim>
void Servos<dim>::steer(const CoupledBody<dim> &body, double time, double far_step)
{
  const std::vector<double> readings = gauges_->read(body, time);
  for (Machine &m : machines_) {
    const double measured = m.target.measured(body, readings), wanted = m.target.wanted(time);
    m.largest_error = std::max(m.largest_error, std::abs(measured - wanted));
    m.largest_wanted = std::max(m.largest_wanted, std::abs(wanted));
    m.squares += far_step * (measured - wanted) * (measured - wanted);
    m.seconds += far_step;
    const double moved = m.fastest * m.course.integral(time);
    const double speed =
        m.law.speed({measured, wanted, m.target.wanted_rate(time), moved}, far_step, m.fastest);
    const double next = time + far_step;
    m.course.turn(next, (speed / m.fastest - m.course.value(next)) / far_step);
    *m.followed = m.course;
  }
}

// Gauges know particles by their numbers, which other parts change.
template <int dim>
void Servos<dim>::watch(const Scene &scene, const CoupledBody<dim> &body)
{
  if (empty())
    return;
  gauges_.emplace(with_followed_gauges(scene), body);
  take_courses(body);
}

template <int dim>
void Servos<dim>::take_courses(const CoupledBody<dim> &body)
{
  for (Machine &m : machines_) {
    m.followed = body.loads[m.target.load()].history.steered();
    core::require(m.followed, "the load of a servo is steered");
    *m.followed = m.course;
  }
}

namespace
{
std::string table_name(int load)
{
  return fmt::format("servo_{}", load);
}
} // namespace

template <int dim>
void Servos<dim>::save(core::State &state) const
{
  for (const Machine &m : machines_) {
    const std::string name = table_name(m.target.load());
    m.law.save(state, name);
    m.course.save(state, name);
    core::save_value(state, name, "largest_error", m.largest_error);
    core::save_value(state, name, "largest_wanted", m.largest_wanted);
    core::save_value(state, name, "squares", m.squares);
    core::save_value(state, name, "seconds", m.seconds);
  }
}

template <int dim>
void Servos<dim>::load(const core::State &state)
{
  for (Machine &m : machines_) {
    const std::string name = table_name(m.target.load());
    m.law.load(state, name);
    m.course.load(state, name);
    *m.followed = m.course;
    m.largest_error = core::load_real(state, name, "largest_error");
    m.largest_wanted = core::load_real(state, name, "largest_wanted");
    m.squares = core::load_real(state, name, "squares");
    m.seconds = core::load_real(state, name, "seconds");
  }
}

template <int dim>
void Servos<dim>::put_into(RunRecord &record, core::Log &log) const
{
  for (const Machine &m : machines_) {
    const double rms = m.seconds > 0 ? std::sqrt(m.squares / m.seconds) : 0;
    const std::string name = table_name(m.target.load());
    if (m.largest_wanted == 0) {
      record.figures[name + "_largest_error"] = {m.largest_error, m.target.column().unit};
      continue;
    }
    record.figures[name + "_largest_error"] = {m.largest_error / m.largest_wanted, ""};
    record.figures[name + "_rms_error"] = {rms / m.largest_wanted, ""};
    if (!(rms <= much * m.largest_wanted))
      log.warning("the servo of load {} did not hold its course: the r.m.s. error is {:.2g} of the "
                  "largest wanted value, the largest error {:.2g}",
                  m.target.load(), rms / m.largest_wanted, m.largest_error / m.largest_wanted);
  }
}

template class Servos<2>;
template class Servos<3>;
} // namespace ligament::program
