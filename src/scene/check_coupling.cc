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
  const auto is_striker = [](const ToolParameters &tool) { return tool.mass.has_value(); };
  if ((!scene.initial_motion.empty() ||
       std::any_of(scene.tools.begin(), scene.tools.end(), is_striker)) &&
      f.sound({"/initial_motion", "/tools"}))
    f.error(key,
            fmt::format("\"coarse_mass\" in /coupling together with {}",
                        scene.initial_motion.empty() ? "a tool that has a mass"
                                                     : "an \"initial_motion\""),
            "the far field would move with another momentum than it has: only static answers do "
            "not depend on masses",
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
  if (weighted && scene.time.rest_threshold > 0)
    f.unused("/time/rest_threshold",
             fmt::format("\"{}\" joins all velocities of the overlap in every step", name));
}

/// Why the scheme does not ask for the key, although it says something else than by default; empty:
/// it does.
std::string why_unused(const CouplingParameters &c, const std::string &key)
{
  using coupling::Scheme;
  const bool is_weighted = coupling::is_energy_weighted(c.scheme);
  const auto is_one_of = [&](std::initializer_list<const char *> keys) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  };
  const std::string scheme =
      fmt::format("the scheme is \"{}\"", coupling::scheme_names[int(c.scheme)]);
  if (!is_weighted &&
      is_one_of({"weight", "damper_form", "multiplier_cells", "ghost_force_correction"}))
    return scheme;
  if (c.scheme != Scheme::fine_scale_split && is_one_of({"gap_filter", "patch_fit", "coarse_mass"}))
    return scheme;
  if (c.scheme == Scheme::none && is_one_of({"step_ratio", "fine_damper", "solver"}))
    return scheme;
  if (c.scheme == Scheme::pointwise && key == "multiplier_cells")
    return scheme + ", whose multipliers belong to particles";
  if (c.fine_damper == 0 && key == "damper_form")
    return "\"fine_damper\" is 0";
  return "";
}

void check_unused(const Scene &scene, Findings &f)
{
  if (!f.sound({"/coupling"}))
    return;
  const CouplingParameters plain = {}, &c = scene.coupling;
  for (const auto &[key, differs] :
       {std::pair("gap_filter", c.gap_filter != plain.gap_filter),
        std::pair("patch_fit", c.patch_fit != plain.patch_fit),
        std::pair("coarse_mass", c.coarse_mass != plain.coarse_mass),
        std::pair("step_ratio", c.step_ratio != plain.step_ratio),
        std::pair("fine_damper", c.fine_damper != plain.fine_damper),
        std::pair("weight", c.weight != plain.weight),
        std::pair("damper_form", c.damper_form != plain.damper_form),
        std::pair("multiplier_cells", c.multiplier_cells != plain.multiplier_cells),
        std::pair("ghost_force_correction",
                  c.ghost_force_correction != plain.ghost_force_correction),
        std::pair("solver", c.solver != plain.solver)})
    if (differs)
      if (const std::string reason = why_unused(c, key); !reason.empty())
        f.unused(std::string("/coupling/") + key, reason);
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
  check_unused(scene, f);
}
} // namespace ligament::program
