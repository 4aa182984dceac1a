// Limits of the velocity of cracks, and faces that are bonded again: what either needs, and what it
// does not go together with.
#include "src/scene/check_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
using Named = std::vector<std::pair<std::string, const MaterialParameters *>>;

Named all_materials(const Scene &scene)
{
  Named all = {{"/material", &scene.material}};
  for (std::size_t k = 0; k < scene.inclusions.size(); ++k)
    all.emplace_back(fmt::format("/inclusions/{}", k), &scene.inclusions[k].material);
  return all;
}

/// What neither goes together with; `name` is the key's last word.
void check_company(const Scene &scene, const std::string &key, const std::string &name, Findings &f)
{
  const auto refuse = [&](bool is_wrong, const std::string &with, const std::string &reason,
                          const std::string &remedy) {
    if (is_wrong)
      f.error(key, fmt::format("\"{}\" cannot be used with {}", name, with), reason, remedy);
  };
  const bool differ = joins_other_constants(scene);
  refuse(differ, "inclusions of other elastic constants",
         "faces between two of them see the pressures of all others",
         "give all materials the same Young's modulus and Poisson's ratio");
  refuse(scene.time.loading != Loading::dynamic,
         fmt::format("\"loading\" \"{}\"", word_of(scene.time.loading)),
         "equilibria are sought at one time, and what faces bear would change meanwhile",
         "choose \"dynamic\"");
  refuse(!scene.specimen.periodic.empty(), "sides that are joined by \"periodic\"",
         "such faces don't know images of particles yet", "leave out one of them");
  refuse(scene.is_viscous(), "\"viscosity\"",
         "what its branches keep as a face comes or goes is not balanced yet",
         "leave out one of them");
  refuse(scene.far_field && coupling::is_energy_weighted(scene.coupling.scheme),
         "an energy-weighted scheme", "it blends energies that are those of an intact body",
         "choose \"fine_scale_split\"");
}

void check_velocity(const Scene &scene, const MaterialParameters &m, const std::string &material,
                    Findings &f)
{
  const std::string section = material + "/fracture", key = section + "/crack_velocity";
  if (m.fracture.criterion == Criterion::none) {
    f.warning(key, fmt::format("\"crack_velocity\" in {} is not used", section),
              "the \"criterion\" is \"none\"", "remove it, or choose a criterion");
    return;
  }
  if (m.fracture.energy || (m.fracture.strength && m.fracture.toughness))
    f.error(key, fmt::format("\"crack_velocity\" in {}, but faces soften", section),
            "they let go as they open; a limit in time is one of faces that break at once",
            "leave out \"crack_velocity\", or \"energy\" and the \"toughness\" beside a strength");
  if (scene.flows())
    f.error(key, "\"crack_velocity\" cannot be used with \"plasticity\"",
            "what flows is not told from what opens yet", "leave out one of them");
  if (!f.sound({material}))
    return;
  const double shear = m.youngs_modulus / (2 * (1 + m.poissons_ratio)),
               speed = std::sqrt(shear / m.density);
  if (*m.fracture.crack_velocity > speed)
    f.warning(key,
              fmt::format("\"crack_velocity\" in {} is {:.4g} m/s, above that of shear waves",
                          section, *m.fracture.crack_velocity),
              fmt::format("these run at {:.4g} m/s, and cracks that open more slowly", speed),
              "leave it out, or check the unit");
}

void check_rebonding(const MaterialParameters &m, const std::string &material, Findings &f)
{
  const std::string section = material + "/fracture/rebonding";
  const RebondingParameters &r = *m.fracture.rebonding;
  if (r.plastic_strain > 0 && !m.plasticity && f.sound({material}))
    f.error(section + "/plastic_strain",
            fmt::format("a \"plastic_strain\" in {}, but nothing flows", section),
            fmt::format("{} has no \"plasticity\": faces would never be bonded again", material),
            "remove it, or add \"plasticity\"");
  if (m.friction == 0 && f.sound({material + "/friction"}))
    f.warning(section,
              fmt::format("faces are bonded again by {}, but slide freely before", section),
              fmt::format("\"friction\" in {} is 0", material),
              "give a friction if they are not lubricated");
  if (f.sound_and_given({"/material"}) && f.sound({material}) &&
      std::max(r.pressure, r.strength) > m.youngs_modulus / 10)
    f.warning(section + (r.pressure > r.strength ? "/pressure" : "/strength"),
              fmt::format("{} has {:.4g} Pa, more than a tenth of Young's modulus", section,
                          std::max(r.pressure, r.strength)),
              "strains would leave the range of the law", "check the units");
}
} // namespace

void check_face_life(const Scene &scene, Findings &f)
{
  for (const auto &[material, m] : all_materials(scene)) {
    const std::string section = material + "/fracture", velocity = section + "/crack_velocity",
                      rebonding = section + "/rebonding";
    if (m->fracture.crack_velocity && f.sound({velocity})) {
      check_velocity(scene, *m, material, f);
      check_company(scene, velocity, "crack_velocity", f);
    }
    if (m->fracture.rebonding && f.sound({rebonding})) {
      check_rebonding(*m, material, f);
      check_company(scene, rebonding, "rebonding", f);
    }
  }
}
} // namespace ligament::program
