// Loads that a servo steers: what it follows, and whether the machine can.
#include "src/scene/check_scene.h"
#include "src/scene/servo_scales.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
class ServoCheck
{
public:
  ServoCheck(const Scene &scene, std::size_t k, Findings &f)
      : scene_(scene), load_(scene.loads[k]), servo_(*load_.servo), f_(f),
        load_key_(fmt::format("/loads/{}", k)), key_(load_key_ + "/servo")
  {
  }

  void check()
  {
    motion();
    course();
    quantity();
    if (scene_.time.has_phases() && f_.sound({"/time/loading"}))
      f_.error(key_, fmt::format("a servo in {}, but /time/loading is not \"dynamic\"", load_key_),
               "equilibria choose the size of the loads themselves, so that a crack grows bond by "
               "bond: there is nothing to steer",
               "remove the servo, or choose \"dynamic\"");
    if (f_.sound({load_key_, "/time", "/material", "/specimen"}))
      scales();
  }

private:
  void motion()
  {
    int n = 0;
    for (const auto &v : load_.velocity)
      n += v.value_or(0) != 0;
    if (n != 1)
      f_.error(load_key_ + "/velocity",
               fmt::format("{} has a servo and {} components of \"velocity\" that are not 0",
                           load_key_, n),
               "the servo steers one: the direction in which the machine moves and its largest "
               "speed, either way. A steered force would run away where the body softens",
               "give one component of a velocity");
    if (load_.ramp > 0 || load_.history.is_given())
      f_.error(load_key_ + (load_.ramp > 0 ? "/ramp" : "/history"),
               fmt::format("{} has a servo and a course of its own", load_key_),
               "the servo says how the load moves", "give the course to the servo");
  }

  void course()
  {
    LoadParameters course = load_;
    course.ramp = servo_.ramp;
    course.history = servo_.history;
    check_history(scene_, course, key_, f_);
  }

  void quantity()
  {
    if (servo_.gauge.empty()) {
      if (!servo_.stress || servo_.value)
        f_.error(key_,
                 fmt::format("{} has no \"gauge\" and {}", key_,
                             servo_.value ? "a \"value\"" : "no \"stress\""),
                 "without a gauge it follows the load's own mean stress",
                 "give \"stress\", or name a gauge");
      if (servo_.gain != 0)
        f_.error(key_ + "/gain", fmt::format("a \"gain\" in {}, which has no gauge", key_),
                 "that of the load's own stress follows from the specimen", "remove it");
      return;
    }
    if (!servo_.value || servo_.stress)
      f_.error(key_,
               fmt::format("{} has a \"gauge\" and {}", key_,
                           servo_.stress ? "a \"stress\"" : "no \"value\""),
               "what is wanted of the gauge is \"value\", in the SI unit of its column",
               "give \"value\" alone");
    const GaugeParameters *const gauge = followed_gauge(scene_, servo_);
    if (!gauge)
      return f_.error(
          key_ + "/gauge",
          fmt::format("\"gauge\" in {} is \"{}\", which no gauge has", key_, servo_.gauge),
          "/gauges lists the gauges of the scene; columns begin with their names",
          "add the gauge, or name another");
    if (gauge->kind == GaugeKind::crack_tip || gauge->kind == GaugeKind::fragments ||
        gauge->kind == GaugeKind::open_crack)
      f_.error(key_ + "/gauge",
               fmt::format("\"gauge\" in {} counts what has broken: {}", key_, servo_.gauge),
               "it jumps, whatever the machine does",
               "follow an opening, a distance, a strain, a stress or a force");
    const bool is_length = gauge->kind == GaugeKind::distance || gauge->kind == GaugeKind::opening;
    if (!is_length && servo_.gain == 0)
      f_.error(key_ + "/gain", fmt::format("no \"gain\" in {}", key_),
               "by how much the gauge rises with the load's motion is known for lengths alone",
               "give the elastic one: for a strain 1 over the specimen's length");
  }

  /// Of the course, over its value.
  double largest_rate() const
  {
    const History &h = servo_.history;
    double rate = 0;
    for (std::size_t k = 1; k < h.table.size(); ++k)
      rate = std::max(rate, std::abs(h.table[k][1] - h.table[k - 1][1]) /
                                (h.table[k][0] - h.table[k - 1][0]));
    if (h.pulse)
      rate = M_PI / h.pulse->duration;
    if (h.cycles)
      rate = std::abs(h.cycles->amplitude) * 2 * M_PI / h.cycles->period;
    return servo_.ramp > 0 ? std::max(rate, 2 / servo_.ramp) : rate;
  }

  void scales()
  {
    const double response = servo_response(scene_, servo_);
    if (response > scene_.time.duration / 10)
      f_.warning(key_ + (servo_.response_time > 0 ? "/response_time" : ""),
                 fmt::format("the servo in {} answers within {:.3g} s", load_key_, response),
                 fmt::format("/time/duration is {:.3g} s: it will be late all the way",
                             scene_.time.duration),
                 fmt::format("run for {:.2g} s or longer; a shorter \"response_time\" than four "
                             "transits of a shear wave may swing up",
                             20 * response));
    int c = 0;
    while (c < 2 && load_.velocity[c].value_or(0) == 0)
      ++c;
    const double gain = !servo_.gauge.empty() ? std::abs(servo_.gain != 0 ? servo_.gain : 1)
                                              : servo_stiffness(scene_, load_, c),
                 asked = largest_rate() * std::abs(servo_.wanted()) / gain,
                 fastest = std::abs(*load_.velocity[c]);
    if (asked > fastest)
      f_.warning(load_key_ + "/velocity",
                 fmt::format("the servo in {} may move at {:.3g} m/s at most", load_key_, fastest),
                 fmt::format("while the body is elastic its course asks for {:.3g} m/s", asked),
                 fmt::format("allow {:.2g} m/s, or give a slower course", 3 * asked));
  }

  const Scene &scene_;
  const LoadParameters &load_;
  const ServoParameters &servo_;
  Findings &f_;
  std::string load_key_, key_;
};
} // namespace

void check_servo(const Scene &scene, std::size_t load, Findings &findings)
{
  ServoCheck(scene, load, findings).check();
}
} // namespace ligament::program
