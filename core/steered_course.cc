#include "core/steered_course.h"

#include "core/check.h"

#include <limits>

namespace ligament::core
{
void SteeredCourse::turn(double t, double rate)
{
  require(t >= now_.time, "a steered course turns behind its last corner");
  const Line next{t, now_.value_at(t), now_.integral_at(t), rate};
  before_ = now_;
  now_ = next;
}

void SteeredCourse::save(State &state, const std::string &name) const
{
  for (const auto &[when, line] : {std::pair("before", &before_), std::pair("now", &now_)}) {
    const std::string of = std::string("_") + when;
    save_value(state, name, "time" + of, line->time);
    save_value(state, name, "value" + of, line->value);
    save_value(state, name, "integral" + of, line->integral);
    save_value(state, name, "rate" + of, line->rate);
  }
}

void SteeredCourse::load(const State &state, const std::string &name)
{
  for (const auto &[when, line] : {std::pair("before", &before_), std::pair("now", &now_)}) {
    const std::string of = std::string("_") + when;
    line->time = load_real(state, name, "time" + of);
    line->value = load_real(state, name, "value" + of);
    line->integral = load_real(state, name, "integral" + of);
    line->rate = load_real(state, name, "rate" + of);
  }
}

double Steered::next_corner(double) const
{
  return std::numeric_limits<double>::infinity();
}
} // namespace ligament::core
