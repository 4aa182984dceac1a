#include "src/scene/check_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
/// The cohesion falls on a straight line over a slip of 2 G_f/Y in a band one spacing wide.
void check_softening_energy(const Scene &scene, const MaterialParameters &m,
                            const std::string &section, Findings &f)
{
  const PlasticityParameters &p = *m.plasticity;
  const std::string key = section + "/softening_energy";
  if (!p.softening_energy)
    return;
  if (p.hardening != 0)
    f.error(section + "/hardening",
            fmt::format("both \"hardening\" and \"softening_energy\" in {}", section),
            "the cohesion grows or falls", "remove one of them");
  if (!p.cohesion || !p.friction_angle || !f.given("/discrete_zone/spacing") ||
      !f.sound({"/discrete_zone", section, "/material"}))
    return;
  constexpr double least = 2, few = 5; // spacings, as of faces that soften
  const double yield = p.shear_strength(),
               length = m.youngs_modulus * *p.softening_energy / (yield * yield),
               spacings = length / scene.zone.spacing;
  if (spacings >= few)
    return;
  const std::string message =
      fmt::format("the cohesion falls over E G/Y^2 = {:.3g} m, {:.1f} spacings", length, spacings);
  const std::string remedy = fmt::format("take a \"spacing\" of {:.2g} m or less", length / few);
  if (spacings < least)
    f.error(key, message, "below 2 a particle loses more than its neighbourhood gives back",
            remedy);
  else
    f.warning(key, message, "below 5 peak and path depend on the packing", remedy);
}

void check_law(const PlasticityParameters &p, const std::string &section, Findings &f)
{
  const bool mises = p.law == PlasticityLaw::von_mises;
  // Defaults, which a resolved scene has, do no harm.
  const auto of_other = [&](const std::vector<std::pair<std::string, bool>> &keys) {
    for (const auto &[key, is_given] : keys)
      if (is_given)
        f.error(section + "/" + key, fmt::format("\"{}\" in {} is none of the law's", key, section),
                fmt::format("the law is \"{}\"", word_of(p.law)), "remove it, or change the law");
  };
  if (!mises) {
    of_other({{"yield_stress", p.yield_stress.has_value()},
              {"saturation", p.saturation.has_value()},
              {"saturation_rate", p.saturation_rate.has_value()},
              {"curve", !p.curve.empty()}});
    for (const char *key : {"cohesion", "friction_angle"})
      if (!f.given(section + "/" + key))
        f.error(section + "/law", fmt::format("there is no \"{}\" in {}", key, section),
                "\"drucker_prager\" needs it", "add it");
    if (f.sound({section + "/dilatancy_angle", section + "/friction_angle"}) && p.friction_angle &&
        p.dilatancy_angle > *p.friction_angle)
      f.error(section + "/dilatancy_angle",
              fmt::format("\"dilatancy_angle\" in {} is above the friction angle", section),
              "flow would give energy instead of taking it", "make it smaller");
    return;
  }
  of_other({{"cohesion", p.cohesion.has_value()},
            {"friction_angle", p.friction_angle.has_value()},
            {"dilatancy_angle", p.dilatancy_angle != 0},
            {"softening_energy", p.softening_energy.has_value()}});
  const bool has_curve = !p.curve.empty();
  if (has_curve == p.yield_stress.has_value())
    f.error(section + (has_curve ? "/yield_stress" : "/law"),
            fmt::format(has_curve ? "both a \"yield_stress\" and a \"curve\" in {}"
                                  : "neither a \"yield_stress\" nor a \"curve\" in {}",
                        section),
            "one of them says when flow begins", has_curve ? "remove one" : "add one");
  if (has_curve)
    for (const auto &[key, is_given] :
         {std::pair("hardening", p.hardening != 0),
          std::pair("saturation", p.saturation.has_value()),
          std::pair("saturation_rate", p.saturation_rate.has_value())})
      if (is_given)
        f.error(section + "/" + key, fmt::format("\"{}\" beside a \"curve\" in {}", key, section),
                "the curve says how the yield stress grows", "remove it");
  if (p.saturation.has_value() != p.saturation_rate.has_value())
    f.error(section + (p.saturation ? "/saturation" : "/saturation_rate"),
            fmt::format("only one of \"saturation\" and \"saturation_rate\" in {}", section),
            "Voce's curve needs both", "add the other one");
  for (std::size_t k = 0; k < p.curve.size(); ++k) {
    const std::string key = fmt::format("{}/curve/{}", section, k);
    if (k == 0 ? p.curve[0].strain != 0 : p.curve[k].strain <= p.curve[k - 1].strain)
      f.error(key + "/strain",
              fmt::format(k == 0 ? "the \"curve\" in {} does not begin at the strain 0"
                                 : "the strains of the \"curve\" in {} don't rise",
                          section),
              "it gives the yield stress over the plastic strain",
              k == 0 ? "add a point with the first yield stress" : "put its points in order");
    if (k > 0 && p.curve[k].stress < p.curve[k - 1].stress)
      f.error(key + "/stress", fmt::format("the stress of the \"curve\" in {} falls", section),
              "softening without a length depends on the spacing", "let it be level or rise");
  }
}
/// What flows has straight levers (theory.md eq. (D22c)), by which nothing may be judged that
/// breaks.
void check_cut_cells(const Scene &scene, const std::string &section, Findings &f)
{
  if (may_break(scene) && is_cut_aslant(scene))
    f.warning(section, "a lattice that flows and breaks, and that sides cut aslant",
              "cut cells stay elastic or gain energy by flowing: loads of bodies of 16 spacings "
              "without hardening were wrong by up to four times",
              "take the packing \"random\", rows along the sides of a box, or no criterion");
}
} // namespace

bool is_cut_aslant(const Scene &scene)
{
  const DiscreteZone &zone = scene.zone;
  if (!zone.packing || zone.is_irregular())
    return false;
  if (!scene.specimen.is_plain() || !scene.specimen.holes.empty() ||
      zone.packing == PackingKind::fcc)
    return true;
  const double symmetry = zone.packing == PackingKind::hexagonal ? M_PI / 6 : M_PI / 2;
  constexpr double some = 0.01; // rad
  return std::any_of(zone.orientation.begin(), zone.orientation.end(), [&](double angle) {
    return std::abs(std::remainder(angle, symmetry)) > some;
  });
}

void check_plasticity(const Scene &scene, Findings &f)
{
  std::vector<std::pair<std::string, const MaterialParameters *>> materials = {
      {"/material", &scene.material}};
  for (std::size_t k = 0; k < scene.inclusions.size(); ++k)
    materials.emplace_back(fmt::format("/inclusions/{}", k), &scene.inclusions[k].material);
  std::string first;
  for (const auto &[key, material] : materials)
    if (material->plasticity && f.sound({key + "/plasticity"})) {
      check_law(*material->plasticity, key + "/plasticity", f);
      check_softening_energy(scene, *material, key + "/plasticity", f);
      if (first.empty())
        first = key + "/plasticity";
    }
  if (first.empty())
    return;
  if (f.sound({"/discrete_zone", "/specimen", "/material", "/inclusions"}))
    check_cut_cells(scene, first, f);
  if (scene.zone.extent == DiscreteZone::Extent::none && f.sound({"/discrete_zone"}))
    f.warning(first, "\"plasticity\" is not used",
              "without a discrete zone all is a mesh, which stays elastic",
              "give a zone, or judge the stresses yourself");
  const auto refuse = [&](bool is_wrong, const std::string &with, const std::string &reason,
                          const std::string &remedy) {
    if (is_wrong)
      f.error(first, "\"plasticity\" cannot be used with " + with, reason, remedy);
  };
  refuse(scene.time.rest_threshold > 0, "a \"rest_threshold\"",
         "what a threshold holds at rest could flow", "remove the threshold; exact rest is free");
  refuse(scene.time.loading != Loading::dynamic,
         fmt::format("\"loading\" \"{}\"", word_of(scene.time.loading)),
         "equilibria are sought without flow", "choose \"dynamic\"");
  refuse(scene.far_field && coupling::is_energy_weighted(scene.coupling.scheme),
         "an energy-weighted scheme", "it blends energies that flow would change",
         "choose \"fine_scale_split\"");
  refuse(std::any_of(scene.loads.begin(), scene.loads.end(),
                     [](const LoadParameters &l) { return l.pressure.has_value(); }),
         "a pressure that follows the surface", "it does not enter the strains of what flows yet",
         "give a \"traction\"");
}
} // namespace ligament::program
