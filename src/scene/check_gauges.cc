#include "src/scene/body_shape.h"
#include "src/scene/check_scene.h"

#include "core/parameters/spelling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace ligament::program
{
namespace
{
const std::vector<std::string> all_keys = {"points",      "direction",   "normal", "lower", "upper",
                                           "inner_lower", "inner_upper", "angle",  "side",  "load",
                                           "tool",        "smoothing",   "mass"};

bool is_zero(const Point &p)
{
  return p[0] == 0 && p[1] == 0 && p[2] == 0;
}

class GaugeCheck
{
public:
  GaugeCheck(const Scene &scene, const Box &specimen, std::size_t k, Findings &findings)
      : scene_(scene), specimen_(specimen), g_(scene.gauges[k]), f_(findings), index_(k),
        key_(fmt::format("/gauges/{}", k))
  {
  }

  void check()
  {
    name();
    keys();
    if (!f_.sound({key_}))
      return;
    switch (g_.kind) {
    case GaugeKind::distance:
    case GaugeKind::opening:
      return two_points();
    case GaugeKind::strain:
    case GaugeKind::stress:
      return field();
    case GaugeKind::force:
      return force();
    case GaugeKind::j_integral:
      return check_j_integral(scene_, g_, specimen_, key_, f_);
    case GaugeKind::crack_tip:
      return crack_tip();
    case GaugeKind::fragments:
      return fragments();
    case GaugeKind::virial_stress:
      return virial_stress();
    case GaugeKind::open_crack:
      return open_crack();
    }
  }

private:
  void name()
  {
    const bool good = !g_.name.empty() && std::all_of(g_.name.begin(), g_.name.end(), [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
    });
    if (!good)
      f_.error(key_ + "/name", fmt::format("\"name\" in {} is \"{}\"", key_, g_.name),
               "columns of history.csv are called after it", "use letters, digits and _ only");
    for (std::size_t j = 0; j < index_; ++j)
      if (scene_.gauges[j].name == g_.name)
        return f_.error(key_ + "/name",
                        fmt::format("\"name\" in {} is \"{}\" again", key_, g_.name),
                        fmt::format("/gauges/{} has it already", j), "give it a name of its own");
  }

  void keys()
  {
    const std::vector<std::string> own = keys_of(g_.kind);
    for (const std::string &name : all_keys)
      if (f_.given(key_ + "/" + name) && std::find(own.begin(), own.end(), name) == own.end())
        f_.error(key_ + "/" + name,
                 fmt::format("\"{}\" in {} has no meaning for the kind \"{}\"", name, key_,
                             words(g_.kind)[std::size_t(g_.kind)]),
                 "this kind reads " + core::listed(own, "and"), "remove it");
  }

  bool n_points(std::size_t n, const char *what)
  {
    if (g_.points.size() == n)
      return true;
    f_.error(key_ + "/points",
             fmt::format("\"points\" in {} has {} points", key_, g_.points.size()), what,
             n == 1 ? "give one: [[x, y]]" : "give two: [[x, y], [x, y]]");
    return false;
  }

  /// A place at which there is a displacement to read.
  void material_at(const Point &p)
  {
    const std::string key = key_ + "/points";
    for (int c = 0; c < scene_.dimension; ++c)
      if (p[c] < specimen_.lower[c] - tolerance(c) || p[c] > specimen_.upper[c] + tolerance(c))
        return f_.error(key,
                        fmt::format("a point of {} is outside the specimen in {}", key_, "xyz"[c]),
                        fmt::format("it is at {} m, the specimen goes from {} m to {} m", p[c],
                                    specimen_.lower[c], specimen_.upper[c]),
                        "move it inside");
    if (!has_particles())
      return;
    if (!BodyTest(scene_.specimen, scene_.dimension).contains(p))
      return f_.error(key, fmt::format("a point of {} is in a hole or notch", key_),
                      "there is no material to move", "move it to the edge or into the body");
    for (std::size_t k = 0; k < scene_.specimen.cracks.size(); ++k)
      if (f_.sound({fmt::format("/specimen/cracks/{}", k)}) &&
          crosses(scene_.specimen.cracks[k], p, p, scene_.dimension))
        return f_.error(key,
                        fmt::format("a point of {} is on the crack /specimen/cracks/{}", key_, k),
                        "there the displacement jumps from one flank to the other",
                        "move it to one side; the distance may be small");
  }

  void two_points()
  {
    if (!n_points(2, "it is measured between two points"))
      return;
    if (g_.points[0] == g_.points[1] && (g_.kind == GaugeKind::distance || is_zero(g_.direction)))
      return f_.error(key_ + "/points", fmt::format("\"points\" in {} are the same", key_),
                      "there is nothing between them", "give different points");
    for (const Point &p : g_.points)
      material_at(p);
  }

  void field()
  {
    const bool box = f_.given(key_ + "/lower") || f_.given(key_ + "/upper"),
               point = f_.given(key_ + "/points");
    if (box == point)
      return f_.error(key_,
                      fmt::format("{} \"points\" and a box in {}", box ? "both" : "neither", key_),
                      "it is measured at a point, or averaged over a box",
                      box ? "remove one of them" : "give \"points\", or \"lower\" and \"upper\"");
    if (g_.kind == GaugeKind::stress && scene_.is_warm())
      f_.warning(
          key_ + "/kind",
          fmt::format("\"kind\" in {} is \"stress\" beside a \"temperature\" of atoms", key_),
          "the share of their momentum in the stress is left out",
          "choose \"virial_stress\", unless that is meant");
    if (point) {
      if (n_points(1, "it is measured at one point"))
        material_at(g_.points[0]);
      return;
    }
    box_in_body();
  }

  void box_in_body()
  {
    for (int c = 0; c < scene_.dimension; ++c) {
      const double lower = std::max(g_.lower[c], specimen_.lower[c]),
                   upper = std::min(g_.upper[c], specimen_.upper[c]);
      if (lower >= upper)
        return f_.error(
            key_,
            fmt::format("the box of {} is empty or outside the specimen in {}", key_, "xyz"[c]),
            fmt::format("it goes from {} m to {} m, the specimen from {} m to {} m", g_.lower[c],
                        g_.upper[c], specimen_.lower[c], specimen_.upper[c]),
            "move it into the specimen");
      if (has_particles() && upper - lower < 2 * scene_.zone.spacing * (1 - 1e-9))
        return f_.error(
            key_,
            fmt::format("the box of {} is {:.4g} m wide in {}, less than two spacings", key_,
                        upper - lower, "xyz"[c]),
            fmt::format("too few particles lie in it: \"spacing\" is {} m", scene_.zone.spacing),
            "make it wider, or measure at a point");
    }
    if (has_particles() && is_swallowed())
      f_.error(key_, fmt::format("the box of {} is inside a hole or notch", key_),
               "there is no material in it", "move it into the body");
  }

  /// No point of the body lies in the box.
  bool is_swallowed() const
  {
    const BodyTest body(scene_.specimen, scene_.dimension);
    constexpr int n = 21;
    for (int k = 0; k < (scene_.dimension == 2 ? n * n : n * n * n); ++k) {
      Point p = {0, 0, 0};
      for (int c = 0, rest = k; c < scene_.dimension; ++c, rest /= n) {
        const double lower = std::max(g_.lower[c], specimen_.lower[c]),
                     upper = std::min(g_.upper[c], specimen_.upper[c]);
        p[c] = lower + (rest % n + 0.5) / n * (upper - lower);
      }
      if (body.contains(p))
        return false;
    }
    return true;
  }

  void force()
  {
    const bool side = g_.side.has_value(), load = g_.load >= 0;
    if (!g_.tool.empty())
      return force_of_tool(side || load);
    if (side == load)
      return f_.error(
          key_, fmt::format("{} \"side\" and \"load\" in {}", side ? "both" : "neither", key_),
          "it is the force of a side or of one load", "give one of them");
    const std::size_t n = scene_.loads.size();
    if (load && std::size_t(g_.load) >= n)
      return f_.error(key_ + "/load", fmt::format("\"load\" in {} is {}", key_, g_.load),
                      fmt::format("/loads has {} entries, counted from 0", n),
                      "give a smaller number");
    const bool loaded = std::any_of(scene_.loads.begin(), scene_.loads.end(),
                                    [&](const auto &l) { return l.boundary == g_.side; });
    if (side && !loaded && f_.sound({"/loads"}))
      f_.error(key_ + "/side",
               fmt::format("\"side\" in {} is \"{}\", which is free", key_, g_.side_name),
               "no load acts on it, so its force is 0", "choose a loaded side, or load this one");
    for (std::size_t l = 0; l < n; ++l)
      if (scene_.loads[l].absorbing &&
          (load ? int(l) == g_.load : scene_.loads[l].boundary == g_.side))
        f_.warning(key_, fmt::format("{} reads /loads/{}, an absorbing side", key_, l),
                   "what its dashpots take is not a load: they are left out of the force",
                   "read another side, or a \"stress\" beside this one");
  }

  void force_of_tool(bool has_other)
  {
    if (has_other)
      return f_.error(key_ + "/tool",
                      fmt::format("\"tool\" beside \"side\" or \"load\" in {}", key_),
                      "it is the force of one of them", "give one of them");
    const bool there = std::any_of(scene_.tools.begin(), scene_.tools.end(),
                                   [&](const auto &t) { return t.name == g_.tool; });
    if (!there && f_.sound({"/tools"}))
      f_.error(key_ + "/tool", fmt::format("\"tool\" in {} is \"{}\"", key_, g_.tool),
               "there is no tool of this name in /tools", "name one that is there");
  }

  void crack_tip()
  {
    if (n_points(1, "it is where the crack starts"))
      for (int c = 0; c < scene_.dimension; ++c)
        if (g_.points[0][c] < specimen_.lower[c] - tolerance(c) ||
            g_.points[0][c] > specimen_.upper[c] + tolerance(c))
          return f_.error(key_ + "/points",
                          fmt::format("the point of {} is outside the specimen", key_),
                          "a crack starts in it or on its surface", "move it");
    if (is_zero(g_.direction))
      f_.error(key_ + "/direction", fmt::format("no \"direction\" in {}", key_),
               "the tip is the farthest face in a direction", "add it: [1, 0] for along x");
    particles_for("only particles part");
    fracture_for("its crack never moves");
  }

  void virial_stress()
  {
    atoms_for("it sums what bonds between atoms bear", "choose \"stress\"");
    particles_for("it sums what bonds between atoms bear");
    if (f_.given(key_ + "/lower") || f_.given(key_ + "/upper"))
      box_in_body();
  }

  void open_crack()
  {
    atoms_for("it counts the neighbours of atoms", "choose \"crack_tip\"");
    crack_tip();
  }

  void atoms_for(const std::string &reason, const std::string &remedy)
  {
    if (!scene_.atoms && f_.sound({"/atoms"}))
      f_.error(key_ + "/kind",
               fmt::format("\"kind\" in {} is \"{}\" without \"atoms\"", key_,
                           words(g_.kind)[std::size_t(g_.kind)]),
               reason, remedy);
  }

  void fragments()
  {
    for (std::size_t j = 0; j < index_; ++j)
      if (scene_.gauges[j].kind == GaugeKind::fragments)
        return f_.error(key_ + "/kind", fmt::format("{} counts fragments again", key_),
                        fmt::format("/gauges/{} does, and the run has one fragments.csv", j),
                        "keep one of them");
    particles_for("only particles part");
    fracture_for("the pieces stay those of the beginning");
  }

  void fracture_for(const std::string &reason)
  {
    if (!may_break(scene_) && f_.sound({"/material", "/inclusions", key_}))
      f_.warning(key_ + "/kind", fmt::format("{} looks for what breaks, and nothing can", key_),
                 reason + ": the fracture criterion is \"none\"",
                 "remove it, or choose a criterion");
  }

  void particles_for(const std::string &reason)
  {
    if (!has_particles() && f_.sound({"/discrete_zone"}))
      f_.error(key_ + "/kind",
               fmt::format("{} has nothing to look at: there are no particles", key_),
               reason + ", and /discrete_zone is \"none\"", "remove it, or add a discrete zone");
  }

  bool has_particles() const { return scene_.zone.extent != DiscreteZone::Extent::none; }
  double tolerance(int c) const { return 1e-9 * scene_.specimen.size[c]; }

  const Scene &scene_;
  const Box &specimen_;
  const GaugeParameters &g_;
  Findings &f_;
  std::size_t index_;
  std::string key_;
};
} // namespace

void check_gauges(const Scene &scene, const Box &specimen, Findings &f)
{
  for (std::size_t k = 0; k < scene.gauges.size(); ++k)
    if (f.sound({fmt::format("/gauges/{}", k)}))
      GaugeCheck(scene, specimen, k, f).check();
}
} // namespace ligament::program
