// Where atoms of other species lie in a crystal.
#include "src/scene/atoms.h"
#include "src/scene/check_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
class SubstitutionCheck
{
public:
  SubstitutionCheck(const Scene &scene, Findings &f)
      : scene_(scene), f_(f), shape_(zone_shape<3>(scene)),
        is_coupled_(scene.far_field && scene.zone.extent == DiscreteZone::Extent::box)
  {
    if (is_coupled_)
      keep_off_ =
          scene.coupling.overlap_cells * scene.far_field->cell_size + scene.atoms->disturbance;
  }

  void check(const Substitution &s, const std::string &key)
  {
    if (s.balls.empty() && s.boxes.empty() && is_coupled_)
      f_.error(
          key, fmt::format("{} has neither \"balls\" nor \"boxes\"", key),
          "the whole crystal reaches into the overlap, which is of \"species\" in /atoms alone",
          "add one of them");
    for (std::size_t b = 0; b < s.balls.size(); ++b) {
      const Hole &ball = s.balls[b];
      Notch box;
      for (int c = 0; c < 3; ++c) {
        box.lower[c] = ball.centre[c] - ball.radius;
        box.upper[c] = ball.centre[c] + ball.radius;
      }
      region(box, fmt::format("{}/balls/{}", key, b));
    }
    for (std::size_t b = 0; b < s.boxes.size(); ++b)
      region(s.boxes[b], fmt::format("{}/boxes/{}", key, b));
  }

private:
  void region(const Notch &box, const std::string &key)
  {
    if (!f_.sound({key}))
      return;
    Vector<3> lower = Vector<3>::Zero(), upper = Vector<3>::Zero();
    for (int c = 0; c < scene_.dimension; ++c) {
      if (box.lower[c] >= box.upper[c])
        return f_.error(key, fmt::format("the box {} is empty", key),
                        "\"lower\" must lie below \"upper\"", "exchange or move its corners");
      const Specimen &specimen = scene_.specimen;
      lower[c] = std::max(box.lower[c], specimen.lower(c));
      upper[c] = std::min(box.upper[c], specimen.upper(c));
      if (lower[c] >= upper[c])
        return f_.error(key, fmt::format("{} lies outside the specimen", key), "nothing is there",
                        "move it, or remove it");
    }
    const Vector<3> margin = Vector<3>::Constant(keep_off_);
    if (is_coupled_ && !shape_.covers(lower - margin, upper + margin, 1e-9 * keep_off_))
      f_.error(key, fmt::format("{} is too near the edge of the discrete zone, or outside", key),
               fmt::format("it must stay {:.4g} m inside: the overlap and the {:.4g} m over which "
                           "its atoms change the forces of others; mesh and overlap know the "
                           "crystal of \"species\" in /atoms alone",
                           keep_off_, scene_.atoms->disturbance),
               "widen /discrete_zone, move the region or make it smaller");
  }

  const Scene &scene_;
  Findings &f_;
  core::BoxUnion<3> shape_;
  bool is_coupled_;
  double keep_off_ = 0; // m
};
} // namespace

void check_substitutions(const Scene &scene, Findings &f)
{
  if (!scene.atoms || scene.atoms->substitutions.empty() ||
      !f.sound({"/atoms", "/discrete_zone", "/far_field", "/coupling", "/specimen"}))
    return;
  if (scene.zone.extent == DiscreteZone::Extent::none)
    return f.error("/atoms/substitutions", "\"substitutions\" in a scene without particles",
                   "the mesh is of one crystal", "remove them, or give a discrete zone");
  SubstitutionCheck check(scene, f);
  for (std::size_t k = 0; k < scene.atoms->substitutions.size(); ++k)
    check.check(scene.atoms->substitutions[k], fmt::format("/atoms/substitutions/{}", k));
}
} // namespace ligament::program
