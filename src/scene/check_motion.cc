// What moves at the beginning, and what acts on every mass.
#include "src/scene/check_scene.h"

#include <fmt/format.h>

#include <algorithm>

namespace ligament::program
{
namespace
{
bool is_zero(const Point &p)
{
  return std::all_of(p.begin(), p.end(), [](double x) { return x == 0; });
}

void check_region(const Scene &scene, const Region &within, const std::string &key, Findings &f)
{
  const std::string region = key + "/within";
  check_within(scene, within, key, f);
  if (!f.sound({region}))
    return;
  for (int c = 0; c < scene.dimension && f.sound({"/specimen/size"}); ++c) {
    const double least = scene.specimen.lower(c), most = scene.specimen.upper(c);
    const double lower = within.is_ball() ? within.centre[c].value_or(0) - within.radius
                                          : within.lower[c],
                 upper = within.is_ball() ? within.centre[c].value_or(0) + within.radius
                                          : within.upper[c];
    if (lower >= most || upper <= least || lower >= upper)
      return f.error(region, fmt::format("nothing of the body lies within the region of {}", key),
                     fmt::format("in {} it goes from {:.6g} m to {:.6g} m, the specimen from "
                                 "{:.6g} m to {:.6g} m",
                                 "xyz"[c], lower, upper, least, most),
                     "move the region into the specimen");
  }
}
} // namespace

void check_motion(const Scene &scene, Findings &f)
{
  for (std::size_t k = 0; k < scene.initial_motion.size(); ++k) {
    const InitialMotion &m = scene.initial_motion[k];
    const std::string key = fmt::format("/initial_motion/{}", k);
    if (!f.sound({key}))
      continue;
    if (is_zero(m.velocity) && is_zero(m.spin))
      f.error(key, fmt::format("{} has no \"velocity\" and no \"spin\"", key),
              "a motion without either does nothing", "give one of them, or remove the motion");
    if (is_zero(m.spin) && !is_zero(m.centre))
      f.unused(key + "/centre", "without \"spin\" nothing turns about it");
    check_region(scene, m.within, key, f);
  }
  if (!scene.initial_motion.empty() && scene.time.has_phases() &&
      f.sound({"/initial_motion", "/time/loading"}))
    f.error("/initial_motion",
            fmt::format("\"initial_motion\", but \"loading\" in /time is \"{}\"",
                        word_of(scene.time.loading)),
            "such a run begins with an equilibrium, in which nothing moves",
            "remove it, or choose \"dynamic\"");
  const std::string body = "/body_force";
  if (!f.sound({body}))
    return;
  LoadParameters load;
  load.ramp = scene.body_force.ramp;
  load.history = scene.body_force.history;
  check_history(scene, load, body, f);
  if ((load.ramp > 0 || load.history.is_given()) && !scene.body_force.is_any())
    f.error(body + "/acceleration", "\"body_force\" has a course in time and no \"acceleration\"",
            "it does nothing", "give the acceleration, or remove it");
  if (scene.body_force.is_any() && scene.coupling.coarse_mass != 1 && scene.far_field &&
      f.sound({"/coupling/coarse_mass"}))
    f.error("/coupling/coarse_mass",
            "\"coarse_mass\" in /coupling is not 1, but a \"body_force\" acts",
            "the far field would have another weight", "remove one of the two");
}
} // namespace ligament::program
