// Rigid tools: each for itself, and what runs they can take part in.
#include "src/scene/check_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace ligament::program
{
namespace
{
bool is_zero(const Point &p)
{
  return std::all_of(p.begin(), p.end(), [](double x) { return x == 0; });
}

bool has_components(const PartialPoint &value)
{
  return std::any_of(value.begin(), value.end(), [](const auto &x) { return x.has_value(); });
}

class ToolCheck
{
public:
  ToolCheck(const Scene &scene, std::size_t k, Findings &findings)
      : scene_(scene), t_(scene.tools[k]), f_(findings), index_(k),
        key_(fmt::format("/tools/{}", k))
  {
  }

  void check()
  {
    if (!f_.sound({key_}))
      return;
    name();
    shape();
    motion();
    release();
  }

private:
  void name()
  {
    const bool good = !t_.name.empty() && std::all_of(t_.name.begin(), t_.name.end(), [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
    });
    if (!good)
      f_.error(key_ + "/name", fmt::format("\"name\" in {} is \"{}\"", key_, t_.name),
               "columns of history.csv are called after it", "use letters, digits and _ only");
    for (std::size_t j = 0; j < index_; ++j)
      if (scene_.tools[j].name == t_.name)
        return f_.error(key_ + "/name",
                        fmt::format("\"name\" in {} is \"{}\" again", key_, t_.name),
                        fmt::format("/tools/{} has it already", j), "give it a name of its own");
  }

  /// Those of the shape's keys that it needs, and none of others.
  void shape()
  {
    const std::string &word = word_of(t_.shape);
    const bool plate = t_.shape == ToolKind::plate, wedge = t_.shape == ToolKind::wedge;
    const auto needs = [&](const std::string &key, bool needed, bool is_there) {
      if (needed && !is_there)
        f_.error(key_ + "/" + key, fmt::format("the {} in {} has no \"{}\"", word, key_, key),
                 "its extent follows from it", fmt::format("add \"{}\", above 0", key));
      else if (!needed && is_there)
        f_.error(key_ + "/" + key, fmt::format("\"{}\" in {}, which is a {}", key, key_, word),
                 "this shape has another extent", "remove it, or choose another shape");
    };
    bool has_size = true;
    for (int c = 0; c < scene_.dimension; ++c)
      has_size &= plate ? t_.size[c] > 0 : t_.size[c] != 0;
    needs("size", plate, has_size);
    needs("radius", !plate && !wedge, t_.radius > 0);
    needs("points", wedge, !t_.points.empty());
    if ((plate || t_.shape == ToolKind::ball) && std::isfinite(t_.length))
      needs("length", false, true);
    const bool is_round = t_.shape == ToolKind::ball || (!plate && !wedge && scene_.dimension == 2);
    if (is_round && !is_zero(t_.orientation))
      f_.error(key_ + "/orientation",
               fmt::format("\"orientation\" in {}, which is a {}", key_, word),
               "it is the same in all orientations", "remove it");
    if (wedge && !t_.points.empty())
      corners();
  }

  void corners()
  {
    const std::string key = key_ + "/points";
    const std::size_t n = t_.points.size();
    if (n < 3)
      return f_.error(key, fmt::format("the wedge in {} has {} corners", key_, n),
                      "a polygon has three or more", "add corners");
    for (const Point &point : t_.points)
      if (point[2] != 0)
        return f_.error(key,
                        fmt::format("a corner of the wedge in {} has a third coordinate", key_),
                        "the polygon lies in the wedge's x and y, and is extruded along its z",
                        "give 0, and turn the wedge by \"orientation\"");
    double sense = 0, turned = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const Point &a = t_.points[k], &b = t_.points[(k + 1) % n], &c = t_.points[(k + 2) % n];
      const double dx = b[0] - a[0], dy = b[1] - a[1], ex = c[0] - b[0], ey = c[1] - b[1];
      const double cross = dx * ey - dy * ex;
      turned += std::atan2(cross, dx * ex + dy * ey);
      if (cross == 0 || cross * sense < 0)
        return f_.error(
            key, fmt::format("the wedge in {} is not convex at its corner {}", key_, (k + 1) % n),
            cross == 0 ? "its edges there lie on one line" : "it turns the other way there",
            "give the corners of a convex polygon in turn, or make it of several tools");
      sense = cross;
    }
    if (std::abs(turned) > 3 * M_PI)
      f_.error(key, fmt::format("the outline of the wedge in {} goes round more than once", key_),
               "its edges cross", "give the corners of a convex polygon in turn");
  }

  void motion()
  {
    LoadParameters course;
    course.ramp = t_.ramp;
    course.history = t_.history;
    check_history(scene_, course, key_, f_);
    const bool velocity = has_components(t_.velocity), way = has_components(t_.displacement);
    const bool driven = velocity || way, spring = t_.machine_stiffness > 0;
    if (velocity && way)
      return f_.error(key_ + "/displacement",
                      fmt::format("both \"velocity\" and \"displacement\" in {}", key_),
                      "they are two ways to prescribe a motion", "remove one of them");
    if (!driven && (t_.ramp > 0 || t_.history.is_given()))
      f_.error(key_, fmt::format("{} has a course in time and no motion", key_), "it does nothing",
               "give a \"velocity\" or a \"displacement\"");
    if (driven && t_.mass && !spring)
      f_.error(key_ + "/mass", fmt::format("\"mass\" in {}, whose motion is prescribed", key_),
               "a mass moves as it is pushed",
               "remove one of them, or join them by a spring, \"machine_stiffness\"");
    if (spring && !t_.mass)
      f_.error(key_ + "/machine_stiffness",
               fmt::format("\"machine_stiffness\" in {}, which has no \"mass\"", key_),
               "a tool at a spring moves by its mass", "give the \"mass\" of the tool");
    if (t_.mass && !is_zero(scene_.body_force.acceleration))
      f_.warning(key_ + "/mass",
                 fmt::format("\"body_force\" does not act on the \"mass\" in {}", key_),
                 "it acts on the body; the tool floats until it is pushed",
                 "give it an \"initial_velocity\", that of its fall");
    if (!t_.mass && !is_zero(t_.initial_velocity))
      f_.error(key_ + "/initial_velocity",
               fmt::format("\"initial_velocity\" in {}, which has no \"mass\"", key_),
               "only a mass flies on by itself", "give the \"mass\", or a \"velocity\"");
    if (t_.inertia > 0 && !t_.mass)
      f_.error(key_ + "/inertia", fmt::format("\"inertia\" in {}, which has no \"mass\"", key_),
               "tools without mass don't turn", "give the \"mass\", or remove it");
    if (t_.inertia > 0 && scene_.dimension == 3 && t_.shape != ToolKind::ball)
      f_.error(key_ + "/inertia",
               fmt::format("\"inertia\" in {}, which is a {} in 3D", key_, word_of(t_.shape)),
               "in 3D only balls turn", "remove it: the tool keeps its orientation");
  }

  void release()
  {
    if (std::isfinite(t_.release) && f_.sound_and_given({"/time/duration"}) &&
        t_.release >= scene_.time.duration)
      f_.error(
          key_ + "/release",
          fmt::format("\"release\" in {} is at {} s, after the end of the run", key_, t_.release),
          fmt::format("/time/duration is {} s", scene_.time.duration),
          "release it earlier, run longer, or remove it");
  }

  const Scene &scene_;
  const ToolParameters &t_;
  Findings &f_;
  std::size_t index_;
  std::string key_;
};
} // namespace

void check_tools(const Scene &scene, Findings &f)
{
  for (std::size_t k = 0; k < scene.tools.size(); ++k)
    ToolCheck(scene, k, f).check();
  if (scene.tools.empty() || !f.sound({"/tools"}))
    return;
  if (scene.time.has_phases() && f.sound({"/time/loading"}))
    f.error(
        "/tools",
        fmt::format("\"tools\", but \"loading\" in /time is \"{}\"", word_of(scene.time.loading)),
        "equilibria know no contact with tools yet",
        "choose \"dynamic\", with /damping for slow tests; or prescribe the motion of a part "
        "of a side in /loads");
  if (scene.far_field && scene.zone.extent == DiscreteZone::Extent::box &&
      f.sound({"/coupling/scheme"}) && coupling::is_energy_weighted(scene.coupling.scheme))
    f.error("/coupling/scheme",
            fmt::format("\"scheme\" in /coupling is \"{}\", but there are \"tools\"",
                        coupling::scheme_names[std::size_t(scene.coupling.scheme)]),
            "its overlap has no place for what tools do to it", "choose \"fine_scale_split\"");
}
} // namespace ligament::program
