// Which strengths a criterion of fracture reads, and how they go together.
#include "src/scene/check_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace ligament::program
{
namespace
{
class FractureCheck
{
public:
  FractureCheck(const MaterialParameters &material, const std::string &section, const Scene &scene,
                Findings &f)
      : material_(material), p_(material.fracture), section_(section), scene_(scene), f_(f)
  {
  }

  void run()
  {
    tension();
    if (!f_.sound({key("criterion")}))
      return;
    if (p_.criterion == Criterion::none) {
      unused();
      return;
    }
    if (!f_.given(key("strength")) && !f_.given(key("toughness")) && f_.sound({section_}))
      f_.error(
          key("criterion"),
          fmt::format("\"criterion\" in {} has neither \"strength\" nor \"toughness\"", section_),
          "it needs to know when a bond breaks", "add one of them, or choose \"none\"");
    toughness();
    foreign_strengths();
    if (p_.criterion == Criterion::drucker_prager)
      drucker_prager();
    if (p_.criterion == Criterion::mohr_coulomb)
      mohr_coulomb();
    stress_out_of_plane();
  }

private:
  std::string key(const std::string &name) const { return section_ + "/" + name; }

  void tension()
  {
    const bool strength = f_.given(key("strength")), toughness = f_.given(key("toughness"));
    if (toughness && !strength && scene_.zone.packing == PackingKind::file)
      f_.error(
          key("toughness"),
          fmt::format("\"toughness\" in {} cannot be used with the packing \"file\"", section_),
          "the factor between toughness and strength is calibrated on samples of a packing, "
          "which a file cannot give",
          "give the \"strength\" of a face");
  }

  void unused()
  {
    const bool strength = f_.given(key("strength"));
    if (strength || f_.given(key("toughness")))
      f_.warning(key(strength ? "strength" : "toughness"),
                 "\"strength\" and \"toughness\" are not used", "the \"criterion\" is \"none\"",
                 "remove them, or choose a criterion");
    const FractureParameters plain; // a resolved scene says all of it
    for (const auto &[name, says_something] :
         {std::pair("energy", true), std::pair("compressive_strength", true),
          std::pair("cohesion", true), std::pair("friction_angle", true),
          std::pair("softening", p_.softening != plain.softening),
          std::pair("mode_ratio", p_.mode_ratio != plain.mode_ratio),
          std::pair("weibull", p_.weibull.has_value())})
      if (says_something)
        f_.unused(key(name), "the \"criterion\" is \"none\"", "remove it, or choose a criterion");
  }

  // A crack that opens breaks its faces at one stress, which its K gives; the others have a shape.
  void toughness()
  {
    const bool opens =
        p_.criterion == Criterion::maximum_tension || p_.criterion == Criterion::face_tension ||
        p_.criterion == Criterion::principal_stress || p_.criterion == Criterion::energy;
    if (f_.given(key("toughness")) && !f_.given(key("strength")) && !opens)
      f_.error(key("toughness"),
               fmt::format("\"toughness\" in {} cannot be used with the criterion \"{}\"", section_,
                           word_of(p_.criterion)),
               "it calibrates the one strength of faces that open, and this criterion breaks faces "
               "in shear and under pressure, too",
               "give \"strength\", or choose maximum_tension, principal_stress or energy");
    else if (f_.given(key("toughness")) && !f_.given(key("strength")) &&
             f_.sound({"/specimen", key("toughness")}) && scene_.specimen.cracks.empty() &&
             scene_.specimen.notches.empty() && scene_.specimen.slots.empty() &&
             !scene_.specimen.body && scene_.tools.empty())
      f_.warning(
          key("toughness"),
          fmt::format("\"toughness\" in {}, but nothing is cracked yet", section_),
          "it becomes a strength of faces that grows as the spacing falls, which is right at "
          "the tip of a crack alone: the load at which one begins depends on the spacing",
          "give \"strength\" beside it: faces then soften from it on and take G_c");
  }

  // Flow takes sigma_zz towards the mean of the others, which lowers sigma_e.
  void stress_out_of_plane()
  {
    const bool reads_it = p_.criterion == Criterion::von_mises ||
                          p_.criterion == Criterion::drucker_prager ||
                          p_.criterion == Criterion::energy;
    if (reads_it && scene_.dimension == 2 && scene_.plane == PlaneMode::strain &&
        (material_.plasticity || material_.viscosity))
      f_.warning(key("criterion"),
                 fmt::format("the criterion \"{}\" in {} reads the stress out of the plane as that "
                             "of an elastic body",
                             word_of(p_.criterion), section_),
                 "nu times the sum of the others in plane strain; what has flowed or relaxed bears "
                 "another one: for small nu a von Mises stress is read by up to 15 % too large",
                 "choose \"maximum_tension\" or \"principal_stress\", plane stress or 3D");
  }

  void foreign_strengths()
  {
    const bool prager = p_.criterion == Criterion::drucker_prager,
               coulomb = p_.criterion == Criterion::mohr_coulomb;
    const auto refuse = [&](const char *name, const char *readers) {
      if (f_.given(key(name)))
        f_.error(key(name),
                 fmt::format("\"{}\" in {} belongs to another criterion", name, section_),
                 fmt::format("the criterion \"{}\" does not read it", word_of(p_.criterion)),
                 fmt::format("remove it, or choose {}", readers));
    };
    if (!prager && !coulomb)
      refuse("compressive_strength", "drucker_prager or mohr_coulomb");
    if (!coulomb) {
      refuse("cohesion", "mohr_coulomb");
      refuse("friction_angle", "mohr_coulomb");
    }
  }

  void drucker_prager()
  {
    const std::string compressive = key("compressive_strength");
    if (!f_.given(compressive)) {
      if (f_.sound({section_}))
        f_.error(key("criterion"),
                 fmt::format("the criterion \"drucker_prager\" in {} lacks a "
                             "\"compressive_strength\"",
                             section_),
                 "its cone goes through two strengths", "add it, or choose von_mises");
    } else if (f_.sound({compressive, key("strength")}) && p_.strength) {
      compare(*p_.compressive_strength, compressive);
      steep_cone(*p_.compressive_strength / *p_.strength);
    }
  }

  // The stress across the plane, nu times those in it, presses on what is pressed in it.
  void steep_cone(double ratio)
  {
    if (scene_.dimension != 2 || scene_.plane != PlaneMode::strain ||
        !f_.sound({"/dimension", "/plane", section_.substr(0, section_.rfind('/'))}))
      return;
    const double nu = material_.poissons_ratio;
    if ((ratio + 1) * std::sqrt(1 - nu + nu * nu) > (ratio - 1) * (1 + nu))
      return;
    f_.warning(key("compressive_strength"),
               fmt::format("\"compressive_strength\" in {} is {:.3g} times the \"strength\": in "
                           "plane strain no uniaxial compression breaks anything",
                           section_, ratio),
               fmt::format("the stress across the plane is nu = {} times that in it, which lies "
                           "inside a cone as steep as that",
                           nu),
               "choose mohr_coulomb, plane stress or 3D where faces are to break under pressure");
  }

  void mohr_coulomb()
  {
    const bool cohesion = f_.given(key("cohesion")),
               compressive = f_.given(key("compressive_strength"));
    if (cohesion && compressive)
      f_.error(key("compressive_strength"),
               fmt::format("both \"cohesion\" and \"compressive_strength\" in {}", section_),
               "with the friction angle each follows from the other", "remove one of them");
    if (!cohesion && !compressive && f_.sound({section_}))
      f_.error(key("criterion"),
               fmt::format("the criterion \"mohr_coulomb\" in {} has neither \"cohesion\" nor "
                           "\"compressive_strength\"",
                           section_),
               "\"strength\" is its cut-off in tension only", "add one of them");
    if (!f_.given(key("friction_angle")) && f_.sound({section_}))
      f_.error(
          key("criterion"),
          fmt::format("the criterion \"mohr_coulomb\" in {} lacks a \"friction_angle\"", section_),
          "it says how much pressure adds to the shear strength",
          "add it; 0 for a material without friction");
    if (cohesion == compressive || !p_.strength || !p_.friction_angle ||
        !f_.sound(
            {key("strength"), key("cohesion"), key("compressive_strength"), key("friction_angle")}))
      return;
    const double sine = std::sin(*p_.friction_angle),
                 twice = 2 * p_.plane_cohesion() * std::cos(*p_.friction_angle);
    compare(twice / (1 - sine), key(cohesion ? "cohesion" : "compressive_strength"));
    const double of_planes = twice / (1 + sine);
    if (*p_.strength > of_planes && *p_.strength <= twice / (1 - sine))
      f_.warning(key("strength"),
                 fmt::format("\"strength\" in {} is {:.4g} Pa, but planes of slip fail under a "
                             "uniaxial tension of {:.4g} Pa",
                             section_, *p_.strength, of_planes),
                 "cohesion and friction angle give it: 2 c cos(phi) / (1 + sin(phi))",
                 "give a smaller cut-off, or accept that it rarely acts");
  }

  void compare(double compressive, const std::string &key_of_it)
  {
    if (*p_.strength > compressive)
      f_.error(key("strength"),
               fmt::format("\"strength\" in {} is {:.4g} Pa, above the compressive strength of "
                           "{:.4g} Pa",
                           section_, *p_.strength, compressive),
               "pressure would weaken the material",
               fmt::format("exchange them, or check the units of both and of {}", key_of_it));
  }

  const MaterialParameters &material_;
  const FractureParameters &p_;
  const std::string &section_;
  const Scene &scene_;
  Findings &f_;
};
} // namespace

namespace
{
template <typename Is>
bool is_any(const Scene &scene, Is &&is)
{
  return is(scene.material.fracture) ||
         std::any_of(scene.inclusions.begin(), scene.inclusions.end(),
                     [&](const Inclusion &i) { return is(i.material.fracture); });
}
} // namespace

bool may_break(const Scene &scene)
{
  return scene.atoms || is_any(scene, [](const auto &f) { return f.criterion != Criterion::none; });
}

bool may_soften(const Scene &scene)
{
  return is_any(scene, [](const auto &f) {
    return f.criterion != Criterion::none && (f.energy || (f.strength && f.toughness));
  });
}

void check_fracture(const MaterialParameters &material, const std::string &section,
                    const Scene &scene, Findings &f)
{
  FractureCheck(material, section, scene, f).run();
}
} // namespace ligament::program
