// The keys of the coupling against each other and against the two models.
#include "src/scene/check_scene.h"

#include <fmt/format.h>

#include <algorithm>

namespace ligament::program
{
namespace
{
const std::string spacing_key = "/discrete_zone/spacing", cell_key = "/far_field/cell_size";

void check_ratio(const Scene &scene, Findings &f)
{
  const double ratio = scene.far_field->cell_size / scene.zone.spacing;
  const std::string message = fmt::format(
      "\"cell_size\" in /far_field is {:.4g} times the \"spacing\" in /discrete_zone", ratio);
  const auto remedy = [&](double low, double high) {
    return fmt::format("give a cell_size from {:.4g} m to {:.4g} m", low * scene.zone.spacing,
                       high * scene.zone.spacing);
  };
  // A ratio that was meant as 2 or 16 may miss it by rounding.
  if (ratio < 2 - 1e-9 || ratio > 16 + 1e-9)
    f.error(cell_key, message, "the overlap works for ratios from 2 to 16", remedy(2.5, 8));
  else if (ratio < 2.5 - 1e-9 || ratio > 8 + 1e-9)
    f.warning(cell_key, message, "ratios from 2.5 to 8 were measured to be accurate",
              remedy(2.5, 8));
}

/// Light coarse masses: a numerical device for static answers.
void check_coarse_mass(const Scene &scene, Findings &f)
{
  const std::string key = "/coupling/coarse_mass";
  if (!f.sound_and_given({key}) || scene.coupling.coarse_mass == 1)
    return;
  const auto &damping = scene.damping;
  if (f.sound({"/damping"}) && damping.local == 0 && damping.mass == 0 && !damping.kinetic)
    f.error(key,
            fmt::format("\"coarse_mass\" in /coupling is {:.4g} without damping",
                        scene.coupling.coarse_mass),
            "waves would travel faster in the far field than in the discrete zone: only static "
            "answers do not depend on masses",
            "leave it out, or add \"kinetic\": true, \"local\" or \"mass\" to /damping");
  if (f.sound({"/loads"}) && std::any_of(scene.loads.begin(), scene.loads.end(),
                                         [](const auto &l) { return l.absorbing; }))
    f.error(key, "\"coarse_mass\" in /coupling together with an absorbing side",
            "absorbing sides are matched to the waves of the true masses",
            "leave out one of the two");
  const double lowest = scene.zone.spacing / scene.far_field->cell_size;
  if (f.sound({cell_key, spacing_key}) && scene.coupling.coarse_mass < lowest * (1 - 1e-9))
    f.error(key,
            fmt::format("\"coarse_mass\" in /coupling is {:.4g}, below spacing/cell_size",
                        scene.coupling.coarse_mass),
            "the coarse motion would need a smaller step than the particles",
            fmt::format("give at least {:.4g}", lowest));
}

/// Keys that only some schemes read, and what the scheme cannot do.
void check_scheme(const Scene &scene, Findings &f)
{
  if (!f.sound({"/coupling/scheme"}))
    return;
  const bool weighted = coupling::is_energy_weighted(scene.coupling.scheme);
  const std::string name = coupling::scheme_names[int(scene.coupling.scheme)];
  if (weighted && f.sound({"/coupling/step_ratio"}) && scene.coupling.step_ratio > 1)
    f.error("/coupling/step_ratio",
            fmt::format("\"step_ratio\" in /coupling is {}, but \"{}\" takes no steps of its own "
                        "in the far field",
                        scene.coupling.step_ratio, name),
            "its constraint joins all velocities in every step", "give 1");
  if (const RegimeChoice regime = scene.coupling.regime;
      weighted && (regime == RegimeChoice::corotated || regime == RegimeChoice::nonlinear))
    f.error("/coupling/regime",
            fmt::format("\"regime\" in /coupling is \"{}\", but \"{}\" is linear", word_of(regime),
                        name),
            "energy-weighted schemes have no other regime",
            "leave it out, or choose \"fine_scale_split\"");
  const std::vector<std::string> split = {"gap_filter", "patch_fit", "coarse_mass"},
                                 literature = {"weight", "damper_form", "multiplier_cells",
                                               "ghost_force_correction"};
  for (const std::string &key : weighted ? split : literature)
    if (f.given("/coupling/" + key))
      f.warning("/coupling/" + key, fmt::format("\"{}\" in /coupling is not used", key),
                fmt::format("the scheme is \"{}\"", name), "remove it");
  if (weighted && f.given("/time/rest_threshold"))
    f.warning("/time/rest_threshold", "\"rest_threshold\" in /time is not used",
              fmt::format("\"{}\" joins all velocities of the overlap in every step", name),
              "remove it");
}

/// The fit balances forces at the inner end of the overlap, too: the cells behind it must be its
/// own.
void check_transition(const Scene &scene, Findings &f)
{
  const std::string key = "/coupling/transition_cells";
  if (f.sound({key, "/coupling/scheme", "/coupling/patch_fit"}) &&
      scene.coupling.scheme == coupling::Scheme::fine_scale_split && scene.coupling.patch_fit &&
      scene.coupling.transition_cells == 0)
    f.error(key, "\"transition_cells\" in /coupling is 0, with a patch fit",
            "the fit needs a cell behind the overlap to balance the forces at its inner end",
            "give at least 1, or \"patch_fit\": false");
}

/// Two models that lie over each other and are not joined.
void check_no_scheme(const Scene &scene, Findings &f)
{
  if (scene.coupling.scheme == coupling::Scheme::none)
    f.warning("/coupling/scheme",
              "\"scheme\" in /coupling is \"none\": the two models do not feel "
              "each other",
              "they overlap but are not joined",
              "choose \"fine_scale_split\", unless that is what you want to see");
  if (f.sound({"/coupling/regime", "/coupling/scheme"}) &&
      scene.coupling.scheme == coupling::Scheme::none &&
      scene.coupling.regime == RegimeChoice::nonlinear)
    f.error("/coupling/regime", "\"regime\" in /coupling is \"nonlinear\" without a coupler",
            "it is about the energy of the overlap, and \"scheme\" is \"none\"",
            "choose \"corotated\" for a far field that turns, or another scheme");
}
} // namespace

void check_coupling(const Scene &scene, Findings &f)
{
  check_ratio(scene, f);
  check_coarse_mass(scene, f);
  check_scheme(scene, f);
  check_transition(scene, f);
  check_no_scheme(scene, f);
}
} // namespace ligament::program
