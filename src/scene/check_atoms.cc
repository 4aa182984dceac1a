// What a body of atoms cannot have beside them.
#include "src/scene/atoms.h"

#include <fmt/format.h>

#include <algorithm>

namespace ligament::program
{
namespace
{
void refuse_other_laws(const Scene &scene, Findings &f)
{
  const auto refuse = [&](const std::string &key, const std::string &reason) {
    if (f.given(key) && f.sound({key}))
      f.error(key, fmt::format("\"{}\" beside \"atoms\"", key.substr(key.rfind('/') + 1)), reason,
              "remove it, or remove \"atoms\"");
  };
  for (const char *key :
       {"/material/fracture", "/material/plasticity", "/material/viscosity", "/material/friction"})
    refuse(key, "atoms bear and break as their potential says");
  if (!scene.inclusions.empty())
    refuse("/inclusions", "a crystal is of one kind of atoms");
  if (!scene.tools.empty())
    refuse("/tools", "atoms have no surface that a tool could touch");
  if (scene.time.rest_threshold > 0)
    refuse("/time/rest_threshold", "atoms never rest");
}

void refuse_loads(const Scene &scene, Findings &f)
{
  for (std::size_t l = 0; l < scene.loads.size(); ++l) {
    const LoadParameters &load = scene.loads[l];
    const std::string key = fmt::format("/loads/{}", l);
    if (load.pressure && f.sound({key}))
      f.error(key + "/pressure", fmt::format("\"pressure\" in {} beside \"atoms\"", key),
              "a pressure follows faces, which atoms have not", "give a \"traction\"");
    if (load.periodic && f.sound({key}))
      f.error(key + "/periodic", fmt::format("{} is a jump across joined sides of a crystal", key),
              "atoms do not know of jumps yet", "load another side");
  }
}

void refuse_couplings(const Scene &scene, Findings &f)
{
  const auto &c = scene.coupling;
  if (coupling::is_energy_weighted(c.scheme) && f.sound({"/coupling/scheme"}))
    f.error("/coupling/scheme",
            fmt::format("\"scheme\" in /coupling is \"{}\" beside \"atoms\"",
                        coupling::scheme_names[std::size_t(c.scheme)]),
            "weights on the energies of bonds under stress leave forces behind",
            "choose \"fine_scale_split\"");
  if (scene.time.has_phases() && f.sound({"/time/loading"}))
    f.error(
        "/time/loading",
        fmt::format("\"loading\" in /time is \"{}\" beside \"atoms\"", word_of(scene.time.loading)),
        "equilibria of atoms are not sought yet",
        "choose \"dynamic\", with /damping for slow tests");
}
/// The stable step is that of small motions; where bonds part atoms are thrown against each other.
void doubt_step(const Scene &scene, Findings &f)
{
  constexpr double largest = 0.25;
  if (scene.time.step || !f.sound({"/time"}) || scene.time.step_fraction <= largest)
    return;
  f.warning("/time/step_fraction",
            fmt::format("\"step_fraction\" in /time is {} for atoms", scene.time.step_fraction),
            "the largest stable step is known for small motions; energy was seen to grow without "
            "bound at 0.9 as soon as bonds parted, and to be kept to 1e-4 at 0.2",
            fmt::format("give at most {}, unless nothing is to break", largest));
}
} // namespace

void check_atoms(const Scene &scene, Findings &f)
{
  if (!scene.atoms)
    return;
  refuse_other_laws(scene, f);
  refuse_loads(scene, f);
  refuse_couplings(scene, f);
  doubt_step(scene, f);
  for (std::size_t k = 0; k < scene.gauges.size(); ++k)
    if (const std::string key = fmt::format("/gauges/{}", k);
        scene.gauges[k].kind == GaugeKind::j_integral && f.sound({key}))
      f.error(key + "/kind", fmt::format("\"kind\" in {} is \"j_integral\" beside \"atoms\"", key),
              "it is known for isotropic bodies", "remove it");
}
} // namespace ligament::program
