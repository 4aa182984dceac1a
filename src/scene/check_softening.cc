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

/// What the strongest of so many faces may be expected to bear, over the mean: the value that one
/// of them exceeds on average.
double strongest(const WeibullParameters &weibull, double n_faces)
{
  const double power = 1 / weibull.modulus;
  return std::pow(std::log(std::max(n_faces, 2.)), power) / std::tgamma(1 + power);
}

/// About how many faces a zone has, whole specimens in discrete elements being meant.
double count_faces(const Scene &scene)
{
  constexpr double per_particle = 4; // 3 to 6
  double cells = 1;
  for (int c = 0; c < scene.dimension; ++c)
    cells *= std::max(scene.specimen.size[c] / scene.zone.spacing, 1.);
  return per_particle * cells;
}

/// The zone in which faces soften is about E G_c/f_t^2 long.
void check_resolution(const Scene &scene, const MaterialParameters &m, double energy,
                      const std::string &section, Findings &f)
{
  constexpr double least = 2, few = 5; // spacings
  const double strength = *m.fracture.strength,
               length = m.youngs_modulus * energy / (strength * strength),
               spacings = length / scene.zone.spacing;
  const auto remedy = [&](double spacing) {
    return fmt::format("take a \"spacing\" of {:.2g} m or less, or leave out the strength of the "
                       "material and give "
                       "\"toughness\" alone",
                       spacing);
  };
  if (m.fracture.weibull && f.sound({section + "/weibull", "/specimen"})) {
    const double factor = strongest(*m.fracture.weibull, count_faces(scene)),
                 shortest = spacings / (factor * factor);
    if (spacings >= least && shortest < least) {
      f.error(section + "/weibull",
              fmt::format("the strongest faces bear about {:.3g} times the \"strength\" in {} and "
                          "soften over E G_c/f_t^2 = {:.3g} m, {:.1f} spacings",
                          factor, section, length / (factor * factor), shortest),
              "all take the same energy: below 2 spacings a face loses more than its neighbourhood "
              "gives back",
              fmt::format("take a \"spacing\" of {:.2g} m or less, or a larger \"modulus\"",
                          length / (factor * factor) / least));
      return;
    }
  }
  if (!(spacings < few))
    return;
  const std::string message =
      fmt::format("faces soften over E G_c/f_t^2 = {:.3g} m, {:.1f} spacings", length, spacings);
  const std::string key = section + "/strength";
  if (spacings < least)
    f.error(key, message, "below 2 a face loses more than its neighbourhood gives back",
            remedy(length / few));
  else
    f.warning(key, message, "below 5 strength and path depend on the packing",
              remedy(length / few));
}

/// What else the scene asks for that faces don't go together with which soften.
void check_company(const Scene &scene, const MaterialParameters &m, const std::string &section,
                   Findings &f)
{
  const std::string energy = section + (m.fracture.energy ? "/energy" : "/toughness"),
                    criterion = section + "/criterion";
  if (f.sound({section, criterion}) && m.fracture.criterion != Criterion::maximum_tension)
    f.error(f.given(criterion) ? criterion : energy,
            fmt::format("\"criterion\" in {} is \"{}\", but faces soften", section,
                        word_of(m.fracture.criterion)),
            "they begin to soften under the largest principal stress",
            "choose \"maximum_tension\", or leave out \"energy\" so that they break at once");
  if (scene.time.loading != Loading::dynamic)
    for (std::size_t k = 0; k < scene.inclusions.size(); ++k) {
      const MaterialParameters &other = scene.inclusions[k].material;
      const std::string inclusion = fmt::format("/inclusions/{}", k);
      if (f.sound({inclusion, "/material"}) && have_other_constants(other, scene.material))
        f.error(energy,
                fmt::format("faces soften beside {} of other elastic constants, and \"loading\" is "
                            "\"{}\"",
                            inclusion, word_of(scene.time.loading)),
                "equilibria with faces between the two that open are not tried yet",
                "choose \"dynamic\", or give all materials the same elastic constants");
    }
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
  const FractureParameters plain;
  for (const auto &[name, differs] :
       {std::pair("softening", m.fracture.softening != plain.softening),
        std::pair("mode_ratio", m.fracture.mode_ratio != plain.mode_ratio)})
    if (differs && !softens)
      f.unused(section + "/" + name, "faces break at once: there is no \"energy\"",
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
