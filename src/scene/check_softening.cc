// Whether faces can soften as a scene asks for it: what they need beside the energy, and whether
// the spacing resolves the zone in which they do.
#include "src/scene/check_scene.h"
#include "src/scene/fracture_energy.h"

#include <fmt/format.h>

namespace ligament::program
{
namespace
{
void check_energy(const Scene &scene, const MaterialParameters &m, const std::string &section,
                  Findings &f)
{
  const std::string key = section + "/energy";
  const FractureParameters &fracture = m.fracture;
  if (!fracture.strength)
    f.error(key, fmt::format("\"energy\" in {} without a \"strength\"", section),
            "a face softens from the strength on, which does not depend on the spacing",
            "add \"strength\", the tensile strength of the material");
  if (!fracture.toughness || !f.sound_and_given({section + "/toughness"}) ||
      !f.sound({"/material", "/plane"}))
    return;
  const double modulus = crack_modulus(scene, m),
               energy = *fracture.toughness * *fracture.toughness / modulus;
  if (std::abs(*fracture.energy - energy) > 0.01 * energy)
    f.error(key,
            fmt::format("\"energy\" in {} is {:.4g} J/m^2, but \"toughness\" asks for {:.4g} J/m^2",
                        section, *fracture.energy, energy),
            fmt::format("G_c = K_Ic^2/E' with E' = {:.4g} Pa", modulus), "remove one of them");
}

/// The zone in which faces soften is about E G_c/f_t^2 long.
void check_resolution(const Scene &scene, const MaterialParameters &m, double energy,
                      const std::string &section, Findings &f)
{
  constexpr double least = 2, few = 5; // spacings
  const double strength = *m.fracture.strength,
               length = m.youngs_modulus * energy / (strength * strength),
               spacings = length / scene.zone.spacing;
  if (!(spacings < few))
    return;
  const std::string message =
      fmt::format("faces soften over E G_c/f_t^2 = {:.3g} m, {:.1f} spacings", length, spacings);
  const std::string remedy = fmt::format(
      "take a \"spacing\" of {:.2g} m or less, or leave out the strength of the material and give "
      "\"toughness\" alone",
      length / few);
  const std::string key = section + "/strength";
  if (spacings < least)
    f.error(key, message, "below 2 a face loses more than its neighbourhood gives back", remedy);
  else
    f.warning(key, message, "below 5 strength and path depend on the packing", remedy);
}

/// What else the scene asks for that faces don't go together with which soften.
void check_company(const Scene &scene, const MaterialParameters &m, const std::string &section,
                   Findings &f)
{
  const std::string energy = section + (m.fracture.energy ? "/energy" : "/toughness");
  std::vector<std::pair<std::string, const MaterialParameters *>> materials = {
      {"/material", &scene.material}};
  for (std::size_t k = 0; k < scene.inclusions.size(); ++k)
    materials.emplace_back(fmt::format("/inclusions/{}", k), &scene.inclusions[k].material);
  for (const auto &[key, other] : materials) {
    const std::string fracture = key + "/fracture", criterion = fracture + "/criterion";
    if (f.sound({fracture, criterion}) && other->fracture.criterion != Criterion::maximum_tension)
      f.error(f.given(criterion) ? criterion : energy,
              fmt::format("\"criterion\" in {} is \"{}\", but faces soften", fracture,
                          word_of(other->fracture.criterion)),
              "they begin to soften under the largest principal stress, in all materials",
              "choose \"maximum_tension\", with a \"strength\" that is never reached where nothing "
              "breaks");
    if (other->fracture.weibull && f.sound({fracture + "/weibull"}))
      f.error(fracture + "/weibull", fmt::format("\"weibull\" in {}, but faces soften", fracture),
              "the strongest faces would lose more than their neighbourhood gives back",
              "remove it, or leave out \"energy\"");
    if (other->plasticity)
      f.error(energy, fmt::format("faces soften, but {} has \"plasticity\"", key),
              "what flows is not told from what opens yet", "leave out one of them");
    if (other->viscosity)
      f.error(energy, fmt::format("faces soften, but {} has \"viscosity\"", key),
              "what flows is not told from what opens yet", "leave out one of them");
  }
  if (!scene.specimen.periodic.empty())
    f.error(energy, "faces soften, but sides are joined by \"periodic\"",
            "openings don't know images of particles yet", "leave out one of them");
  for (std::size_t k = 0; k < scene.loads.size(); ++k)
    if (scene.loads[k].pressure)
      f.error(fmt::format("/loads/{}/pressure", k),
              "a pressure that follows the surface, but faces soften",
              "its work beside faces that open is not balanced yet",
              "load by \"traction\", or leave out \"energy\"");
}
} // namespace

void check_softening(const Scene &scene, const MaterialParameters &m, const std::string &section,
                     Findings &f)
{
  if (!f.sound({section, "/dimension"}) || m.fracture.criterion == Criterion::none)
    return;
  if (m.fracture.energy)
    check_energy(scene, m, section, f);
  const bool softens = m.fracture.energy || (m.fracture.strength && m.fracture.toughness);
  for (const char *name : {"softening", "mode_ratio"})
    if (const std::string key = section + "/" + name; !softens && f.sound_and_given({key}))
      f.warning(key, fmt::format("\"{}\" in {} is not used", name, section),
                "faces break at once: there is no \"energy\"",
                "add \"energy\", or a \"toughness\" beside the strength, or remove it");
  if (!softens)
    return;
  check_company(scene, m, section, f);
  const bool has_spacing = f.sound({"/discrete_zone"}) && f.given("/discrete_zone/spacing");
  if (has_spacing && f.sound({"/material", section}) && m.fracture.strength)
    if (const auto energy = fracture_energy(scene, m))
      check_resolution(scene, m, *energy, section, f);
}
} // namespace ligament::program
