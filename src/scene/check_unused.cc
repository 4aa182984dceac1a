// Keys that mean nothing in the scene as it is, although each is right for itself.
#include "src/scene/check_scene.h"

#include <algorithm>

namespace ligament::program
{
namespace
{
/// Cells do not break.
void check_mesh_alone(const Scene &scene, Findings &f)
{
  if (scene.zone.extent != DiscreteZone::Extent::none || !f.sound({"/discrete_zone"}))
    return;
  const std::string reason = "without a discrete zone all is a mesh, which stays whole",
                    remedy = "remove it, or give a zone";
  if (scene.material.fracture.criterion != Criterion::none)
    f.unused("/material/fracture", reason, remedy);
  if (scene.material.friction != 0)
    f.unused("/material/friction", reason, remedy);
}

/// What keeps a body awake from the beginning; atoms and phases refuse the key.
std::string why_awake(const Scene &scene)
{
  if (scene.zone.extent == DiscreteZone::Extent::none)
    return "particles rest, and there are none";
  if (!scene.tools.empty())
    return "bodies that tools touch do not rest";
  if (scene.body_force.is_any())
    return "a \"body_force\" moves all from the beginning";
  if (!scene.initial_motion.empty())
    return "bodies with an \"initial_motion\" do not rest";
  return "";
}

void check_rest(const Scene &scene, Findings &f)
{
  if (scene.time.rest_threshold == 0 || scene.atoms || scene.time.has_phases() ||
      !f.sound({"/discrete_zone", "/tools", "/body_force", "/initial_motion"}))
    return;
  if (const std::string reason = why_awake(scene); !reason.empty())
    f.unused("/time/rest_threshold", reason);
}

void check_chance(const Scene &scene, Findings &f)
{
  if (!scene.atoms || !f.sound({"/atoms", "/discrete_zone"}))
    return;
  const AtomsParameters &a = *scene.atoms;
  const bool is_by_chance =
      scene.is_warm() || std::any_of(a.substitutions.begin(), a.substitutions.end(),
                                     [](const Substitution &s) { return s.share < 1; });
  if (a.seed != AtomsParameters().seed && !is_by_chance)
    f.unused("/atoms/seed", "there is no \"temperature\", and no substitution by chance");
  if (a.averaging > 0 && scene.is_warm() && scene.zone.extent == DiscreteZone::Extent::all)
    f.unused("/atoms/averaging", "it is for the overlap, and there is no mesh");
}
} // namespace

void check_unused_keys(const Scene &scene, Findings &f)
{
  check_mesh_alone(scene, f);
  check_rest(scene, f);
  check_chance(scene, f);
}
} // namespace ligament::program
