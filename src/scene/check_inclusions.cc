#include "src/scene/check_scene.h"

#include <fmt/format.h>

#include <algorithm>

namespace ligament::program
{
namespace
{
/// Where the regions of an inclusion lie, and whether its material can stand beside that of the
/// body.
class InclusionCheck
{
public:
  InclusionCheck(const Scene &scene, const Box &specimen, const Layout *layout, Findings &f)
      : scene_(scene), specimen_(specimen), layout_(layout), f_(f)
  {
  }

  void material(const Inclusion &inclusion, const std::string &key)
  {
    check_fracture(inclusion.material, key + "/fracture", scene_, f_);
    check_softening(scene_, inclusion.material, key + "/fracture", f_);
    const std::string criterion = key + "/fracture/criterion";
    if (!f_.given(criterion) && f_.sound({criterion, "/material/fracture/criterion"}) &&
        scene_.material.fracture.criterion != Criterion::none)
      f_.warning(f_.given(key + "/fracture") ? key + "/fracture" : key,
                 fmt::format("{} has no \"criterion\" of fracture", key),
                 "only the bonds that join it to other materials can break",
                 "give one, or \"none\" to say so");
    poissons_ratio(inclusion.material, key + "/poissons_ratio");
    if (inclusion.balls.empty() && inclusion.boxes.empty() && f_.sound({key}) &&
        scene_.zone.packing != PackingKind::file)
      f_.error(key, fmt::format("{} has neither \"balls\" nor \"boxes\"", key),
               "no particle would be of this material", "add one of them, or remove the inclusion");
  }

  void poissons_ratio(const MaterialParameters &material, const std::string &key)
  {
    if (f_.sound_and_given({key}) && material.poissons_ratio < 0 && joins_other_constants(scene_))
      f_.error(key,
               fmt::format("\"poissons_ratio\" is {} in a scene with inclusions of other elastic "
                           "constants",
                           material.poissons_ratio),
               "pairs of two materials are stable from 0 on",
               "give 0 or more, or all the same \"youngs_modulus\" and \"poissons_ratio\"");
  }

  void region(Box box, const std::string &key)
  {
    for (int c = 0; c < scene_.dimension; ++c) {
      if (box.lower[c] >= box.upper[c]) {
        f_.error(key, fmt::format("the box {} is empty", key), "\"lower\" must lie below \"upper\"",
                 "exchange or move its corners");
        return;
      }
      box.lower[c] = std::max(box.lower[c], specimen_.lower[c]);
      box.upper[c] = std::min(box.upper[c], specimen_.upper[c]);
      if (box.lower[c] >= box.upper[c]) {
        f_.error(key, fmt::format("{} lies outside the specimen", key), "nothing is there",
                 "move it, or remove it");
        return;
      }
    }
    if (layout_)
      check_inside_zone(box, key, key, *layout_, f_);
  }

private:
  const Scene &scene_;
  const Box &specimen_;
  const Layout *layout_;
  Findings &f_;
};
} // namespace

bool have_other_constants(const MaterialParameters &a, const MaterialParameters &b)
{
  return a.youngs_modulus != b.youngs_modulus || a.poissons_ratio != b.poissons_ratio;
}

bool joins_other_constants(const Scene &scene)
{
  return std::any_of(scene.inclusions.begin(), scene.inclusions.end(), [&](const Inclusion &i) {
    return have_other_constants(i.material, scene.material);
  });
}

void check_inclusions(const Scene &scene, const Box &specimen, const Layout *layout, Findings &f)
{
  if (scene.inclusions.empty())
    return;
  if (scene.zone.extent == DiscreteZone::Extent::none && f.sound({"/discrete_zone"})) {
    f.error("/inclusions", "\"inclusions\" in a scene without discrete elements",
            "only particles may be of another material", "remove them, or give a discrete zone");
    return;
  }
  InclusionCheck check(scene, specimen, layout, f);
  check.poissons_ratio(scene.material, "/material/poissons_ratio");
  for (std::size_t k = 0; k < scene.inclusions.size(); ++k) {
    const Inclusion &inclusion = scene.inclusions[k];
    const std::string key = fmt::format("/inclusions/{}", k);
    check.material(inclusion, key);
    for (std::size_t b = 0; b < inclusion.balls.size(); ++b) {
      const std::string name = fmt::format("{}/balls/{}", key, b);
      Box box;
      for (int c = 0; c < 3; ++c) {
        box.lower[c] = inclusion.balls[b].centre[c] - inclusion.balls[b].radius;
        box.upper[c] = inclusion.balls[b].centre[c] + inclusion.balls[b].radius;
      }
      if (f.sound({name}))
        check.region(box, name);
    }
    for (std::size_t b = 0; b < inclusion.boxes.size(); ++b) {
      const std::string name = fmt::format("{}/boxes/{}", key, b);
      if (f.sound({name}))
        check.region({inclusion.boxes[b].lower, inclusion.boxes[b].upper}, name);
    }
  }
}
} // namespace ligament::program
