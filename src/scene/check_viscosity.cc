#include "src/scene/check_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
/// Time in s that a shear wave takes from one particle to the next; above the stable step.
double transit(const Scene &scene, const MaterialParameters &m)
{
  const double shear = m.youngs_modulus / (2 * (1 + m.poissons_ratio));
  return scene.zone.spacing / std::sqrt(shear / m.density);
}

void check_times(const Scene &scene, const MaterialParameters &m, const std::string &material,
                 Findings &f)
{
  const std::string section = material + "/viscosity";
  if (!f.sound_and_given({"/discrete_zone/spacing"}) || !f.sound({material, "/time"}))
    return;
  const double step = scene.time.step.value_or(transit(scene, m));
  for (std::size_t k = 0; k < m.viscosity->branches.size(); ++k)
    if (const double time = m.viscosity->branches[k].relaxation_time; time < step)
      f.error(fmt::format("{}/branches/{}/relaxation_time", section, k),
              fmt::format("\"relaxation_time\" in {}/branches/{} is {:.3g} s, under a step",
                          section, k, time),
              fmt::format("a step takes about {:.2g} s: the branch would have relaxed before it "
                          "is felt",
                          step),
              "leave the branch out and give the long-time moduli, or check the unit");
  if (!m.viscosity->shear_viscosity)
    return;
  const double shear = m.youngs_modulus / (2 * (1 + m.poissons_ratio)),
               damping = *m.viscosity->shear_viscosity / shear / transit(scene, m),
               shorter = std::sqrt(1 + damping * damping) + damping;
  if (shorter > 10)
    f.warning(section + "/shear_viscosity",
              fmt::format("\"shear_viscosity\" in {} makes the stable step about {:.2g} times "
                          "shorter",
                          section, shorter),
              fmt::format("over the shear modulus it is {:.2g} s, and a shear wave passes a "
                          "particle in {:.2g} s",
                          *m.viscosity->shear_viscosity / shear, transit(scene, m)),
              "give branches in its place, or check the unit");
}

void check_numbers(const ViscosityParameters &v, const std::string &section, Findings &f)
{
  if (v.branches.empty() && !v.shear_viscosity)
    f.error(section, fmt::format("neither \"branches\" nor a \"shear_viscosity\" in {}", section),
            "one of them says what is viscous", "add one, or remove the section");
  double sum = 0;
  for (const BranchParameters &b : v.branches)
    sum += b.share;
  constexpr double round_off = 1e-9;
  if (sum > 1 + round_off)
    f.error(section + "/branches",
            fmt::format("the shares of the \"branches\" in {} add up to {:.4g}", section, sum),
            "they are shares of the shear modulus, and what is left is that of slow loads",
            "give shares that add up to 1 (a fluid) or less");
}

/// The zone relaxes, far field and overlap don't.
void compare_with_far_field(const Scene &scene, Findings &f)
{
  if (!scene.far_field || !scene.material.viscosity || !f.sound({"/time/duration", "/material"}))
    return;
  double softer = 0;
  for (const BranchParameters &b : scene.material.viscosity->branches)
    softer -= b.share * std::expm1(-scene.time.duration / b.relaxation_time);
  if (softer > 0.05)
    f.warning("/material/viscosity",
              fmt::format("/material/viscosity: the discrete zone will be {:.0f} % softer in shear "
                          "than the far field",
                          100 * softer),
              "its stress relaxes within \"duration\" in /time, cells and overlap stay elastic",
              "let the zone fill the specimen, or take what comes of it for a body of two "
              "materials");
}
/// Cut cells of a lattice may gain energy by flowing (theory.md eq. (D22c)), unless enough of their
/// stiffness stays.
void check_cut_cells(const Scene &scene, const MaterialParameters &m, const std::string &section,
                     Findings &f)
{
  double relaxing = 0;
  for (const BranchParameters &b : m.viscosity->branches)
    relaxing += b.share;
  constexpr double most = 0.85;
  const bool has_straight_levers = scene.flows() && !may_break(scene);
  if (relaxing > most && !has_straight_levers && is_cut_aslant(scene))
    f.warning(
        section + "/branches",
        fmt::format("{:.3g} of the stiffness in {} relaxes on a lattice that sides cut aslant",
                    relaxing, section),
        "cut cells may gain energy by it: loads fall below zero",
        "take the packing \"random\", rows along the sides of a box, or shares that add up to "
        "less");
}
} // namespace

void check_viscosity(const Scene &scene, Findings &f)
{
  std::vector<std::pair<std::string, const MaterialParameters *>> materials = {
      {"/material", &scene.material}};
  for (std::size_t k = 0; k < scene.inclusions.size(); ++k)
    materials.emplace_back(fmt::format("/inclusions/{}", k), &scene.inclusions[k].material);
  std::string first;
  for (const auto &[key, material] : materials)
    if (material->viscosity && f.sound({key + "/viscosity"})) {
      check_numbers(*material->viscosity, key + "/viscosity", f);
      check_times(scene, *material, key, f);
      if (f.sound({"/discrete_zone", "/specimen", "/material", "/inclusions"}))
        check_cut_cells(scene, *material, key + "/viscosity", f);
      if (first.empty())
        first = key + "/viscosity";
    }
  if (first.empty())
    return;
  if (scene.zone.extent == DiscreteZone::Extent::none && f.sound({"/discrete_zone"}))
    f.warning(first, "\"viscosity\" is not used",
              "without a discrete zone all is a mesh, which stays elastic",
              "give a zone, or judge the stresses yourself");
  compare_with_far_field(scene, f);
  const auto refuse = [&](bool is_wrong, const std::string &with, const std::string &reason,
                          const std::string &remedy) {
    if (is_wrong)
      f.error(first, "\"viscosity\" cannot be used with " + with, reason, remedy);
  };
  refuse(scene.time.rest_threshold > 0, "a \"rest_threshold\"",
         "what a threshold holds at rest would go on to relax",
         "remove the threshold; exact rest is free");
  refuse(scene.time.loading != Loading::dynamic,
         fmt::format("\"loading\" \"{}\"", word_of(scene.time.loading)),
         "equilibria are sought at one time, and a viscous body has none", "choose \"dynamic\"");
  refuse(scene.far_field && coupling::is_energy_weighted(scene.coupling.scheme),
         "an energy-weighted scheme", "it blends energies of which a viscous body has none",
         "choose \"fine_scale_split\"");
  refuse(std::any_of(scene.loads.begin(), scene.loads.end(),
                     [](const LoadParameters &l) { return l.pressure.has_value(); }),
         "a pressure that follows the surface",
         "it does not enter the strains of what is viscous yet", "give a \"traction\"");
  const bool differ = joins_other_constants(scene);
  for (const auto &[key, material] : materials)
    if (differ && material->viscosity && material->viscosity->shear_viscosity.value_or(0) > 0)
      f.error(key + "/viscosity/shear_viscosity",
              "\"shear_viscosity\" cannot be used with inclusions of other elastic constants",
              "it would answer a rate that it divides between the sides of a face, and be unstable",
              "give \"branches\", or all materials the same Young's modulus and Poisson's ratio");
}
} // namespace ligament::program
