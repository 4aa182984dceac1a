// What a body of atoms cannot have beside them.
#include "src/scene/atoms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
void refuse_other_laws(const Scene &scene, Findings &f)
{
  const auto refuse = [&](const std::string &key, const std::string &reason) {
    if (f.written(key) && f.sound({key}))
      f.error(key, fmt::format("\"{}\" beside \"atoms\"", key.substr(key.rfind('/') + 1)), reason,
              "remove it, or remove \"atoms\"");
  };
  for (const char *key :
       {"/material/fracture", "/material/plasticity", "/material/viscosity", "/material/friction"})
    refuse(key, "atoms bear and break as their potential says");
  for (const char *key :
       {"/material/youngs_modulus", "/material/poissons_ratio", "/material/density"})
    refuse(key, "it follows from the potential");
  if (!scene.inclusions.empty())
    refuse("/inclusions", "atoms of other species are /atoms/substitutions");
  if (!scene.tools.empty())
    refuse("/tools", "atoms have no surface that a tool could touch");
  if (scene.time.rest_threshold > 0)
    refuse("/time/rest_threshold", "atoms never rest");
  if (scene.dimension == 2 && scene.plane == PlaneMode::stress)
    refuse("/plane", "a plane of atoms has no thickness to strain: its constants are its own");
  if (scene.zone.extent == DiscreteZone::Extent::all &&
      scene.time.stop_when == StopWhen::specimen_broken)
    refuse("/time/stop_when", "crystals have no faces at their ends, by which one would see it");
}

void refuse_loads(const Scene &scene, Findings &f)
{
  for (std::size_t l = 0; l < scene.loads.size(); ++l) {
    const LoadParameters &load = scene.loads[l];
    const std::string key = fmt::format("/loads/{}", l);
    if (load.pressure && f.sound({key}))
      f.error(key + "/pressure", fmt::format("\"pressure\" in {} beside \"atoms\"", key),
              "a pressure follows faces, which atoms have not", "give a \"traction\"");
    if (load.boundary > 2 * scene.dimension && f.sound({key}) &&
        scene.zone.extent == DiscreteZone::Extent::all)
      f.error(key + "/boundary",
              fmt::format("\"boundary\" in {} is \"{}\" beside \"atoms\"", key, load.side),
              "crystals are loaded on the sides of the box around them alone",
              "load one of these; a mesh around the crystal takes loads on sides with names");
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

/// Heat comes from the overlap's bath, and what it needs is looked for before the run.
void check_temperature(const Scene &scene, Findings &f)
{
  const AtomsParameters &a = *scene.atoms;
  const std::string key = "/atoms/temperature";
  if (!f.sound({"/atoms", "/coupling", "/discrete_zone", "/time"}))
    return;
  if (!scene.is_warm()) {
    const std::pair<const char *, double> without_meaning[] = {
        {"lattice_parameter", a.lattice_parameter},
        {"zone_friction", a.zone_friction},
        {"averaging", a.averaging}};
    for (const auto &[name, value] : without_meaning)
      if (value > 0)
        f.error(fmt::format("/atoms/{}", name),
                fmt::format("\"{}\" in /atoms without a temperature", name),
                "it belongs to atoms that move by heat", "remove it, or give a \"temperature\"");
    return;
  }
  const auto refuse = [&](const std::string &at, const std::string &what, const std::string &reason,
                          const std::string &remedy) {
    f.error(at, what + " beside a \"temperature\" of atoms", reason, remedy);
  };
  if (scene.zone.extent == DiscreteZone::Extent::none)
    refuse(key, "no atoms", "the mesh knows no heat", "give a discrete zone, or remove it");
  const bool is_coupled = scene.zone.extent == DiscreteZone::Extent::box;
  if (is_coupled && scene.coupling.gap_filter > 0)
    refuse("/coupling/gap_filter",
           fmt::format("\"gap_filter\" in /coupling is {}", scene.coupling.gap_filter),
           "it would cool the nodes, which have their temperature from the atoms", "give 0");
  if (is_coupled && scene.coupling.regime == RegimeChoice::linear)
    refuse("/coupling/regime", "\"regime\" in /coupling is \"linear\"",
           "the load of thermal motion must turn with the body",
           "choose \"automatic\", which is \"corotated\" then");
  if (is_coupled && scene.coupling.regime == RegimeChoice::nonlinear)
    refuse("/coupling/regime", "\"regime\" in /coupling is \"nonlinear\"",
           "cells under finite strain do not know the stress that heat makes",
           "choose \"automatic\", which is \"corotated\" then");
  if (scene.damping.local > 0 || scene.damping.mass > 0 || scene.damping.kinetic)
    refuse("/damping", "\"damping\"", "it takes the heat of all atoms, and nothing gives it back",
           "remove it; /atoms/zone_friction is a friction with its noise");
  if (!scene.initial_motion.empty())
    refuse("/initial_motion", "\"initial_motion\"", "atoms start with the velocities of their heat",
           "remove one of the two");
  for (std::size_t l = 0; l < scene.loads.size(); ++l)
    if (const std::string load = fmt::format("/loads/{}", l);
        scene.loads[l].absorbing && f.sound({load}))
      refuse(load + "/absorbing", fmt::format("\"absorbing\" in {}", load),
             "the dashpots of such a side take the heat of what they hold, and give none back",
             is_coupled ? "remove it; a larger mesh puts off what comes back"
                        : "remove it; /atoms/zone_friction is a friction with its noise");
  const auto moves = [](const LoadParameters &load) {
    const auto is_any = [](const auto &vector) {
      return std::any_of(vector.begin(), vector.end(),
                         [](const auto &v) { return v.value_or(0) != 0; });
    };
    return is_any(load.velocity) || is_any(load.displacement) || is_any(load.traction) ||
           is_any(load.force);
  };
  const bool is_moved =
      scene.body_force.is_any() || std::any_of(scene.loads.begin(), scene.loads.end(), moves);
  if (a.zone_friction > 0 && is_moved)
    f.warning("/atoms/zone_friction",
              fmt::format("\"zone_friction\" in /atoms is {} 1/s beside loads that move the body",
                          a.zone_friction),
              "it is a friction against the frame at rest: what moves as a whole is held back",
              "give a small one, or 0: the overlap is a bath already where there is one");
  if (is_coupled && scene.coupling.fine_damper == 0)
    f.warning(
        "/coupling/fine_damper",
        "\"fine_damper\" in /coupling is 0 beside a \"temperature\" of atoms",
        "then nothing keeps the temperature once the run has begun, and short waves come back",
        "give 8, unless that is meant");
  if (a.lattice_parameter > 0 && a.lattice_parameter != 0 && !f.given("/atoms/lattice_parameter") &&
      f.sound({key}))
  {
    const double mean = scene.dimension == 2 ? thermal_lattice_of<2>(scene).squared_displacement
                                             : thermal_lattice_of<3>(scene).squared_displacement;
    if (mean > 0.01 * scene.zone.spacing * scene.zone.spacing)
      f.warning(key,
                fmt::format("\"temperature\" in /atoms is {} K: atoms move by {:.3f} spacings",
                            a.temperature, std::sqrt(mean) / scene.zone.spacing),
                "crystals melt at some 0.1, and the overlap knows small motions alone",
                "choose a lower temperature");
  }
}

/// The stable step is that of small motions; where bonds part atoms are thrown against each other.
void doubt_step(const Scene &scene, Findings &f)
{
  const double largest = scene.is_warm() ? 0.1 : 0.25;
  if (scene.time.step || !f.sound({"/time"}) || scene.time.step_fraction <= largest)
    return;
  f.warning("/time/step_fraction",
            fmt::format("\"step_fraction\" in /time is {} for atoms", scene.time.step_fraction),
            scene.is_warm()
                ? "the fastest atoms are too warm by the square of it, and thermal motion is large"
                : "the largest stable step is known for small motions; energy was seen to grow "
                  "without bound at 0.9 as soon as bonds parted, and to be kept to 1e-4 at 0.2",
            scene.is_warm() ? fmt::format("give at most {}", largest)
                            : fmt::format("give at most {}, unless nothing is to break", largest));
}
} // namespace

void check_atoms(const Scene &scene, Findings &f)
{
  if (!scene.atoms)
    return;
  refuse_other_laws(scene, f);
  refuse_loads(scene, f);
  refuse_couplings(scene, f);
  check_temperature(scene, f);
  doubt_step(scene, f);
  for (std::size_t k = 0; k < scene.gauges.size(); ++k)
    if (const std::string key = fmt::format("/gauges/{}", k);
        scene.gauges[k].kind == GaugeKind::j_integral && f.sound({key}))
      f.error(key + "/kind", fmt::format("\"kind\" in {} is \"j_integral\" beside \"atoms\"", key),
              "it is known for isotropic bodies", "remove it");
}
} // namespace ligament::program
