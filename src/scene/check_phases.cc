// What scenes must have whose loading goes by equilibria: something that grows, and something that
// holds.
#include "src/scene/check_scene.h"

#include <fmt/format.h>

#include <algorithm>

namespace ligament::program
{
namespace
{
const std::string loading_key = "/time/loading";

bool is_nonzero(const PartialPoint &value)
{
  return std::any_of(value.begin(), value.end(), [](const auto &x) { return x.value_or(0) != 0; });
}

bool has_components(const PartialPoint &value)
{
  return std::any_of(value.begin(), value.end(), [](const auto &x) { return x.has_value(); });
}

bool moves(const LoadParameters &load)
{
  return is_nonzero(load.velocity) || is_nonzero(load.displacement) || is_nonzero(load.traction) ||
         is_nonzero(load.force) || is_nonzero(load.strain) || load.pressure.value_or(0) != 0;
}

template <typename Is>
bool any_load(const Scene &scene, Is &&is)
{
  return std::any_of(scene.loads.begin(), scene.loads.end(), is);
}

void check_what_loads(const Scene &scene, const std::string &how, Findings &f)
{
  const BodyForceParameters &body = scene.body_force;
  if (body.is_any() && (body.ramp > 0 || body.history.is_given()))
    return;
  if (!any_load(scene, moves) && !body.is_any())
    return f.error("/loads", fmt::format("nothing loads the specimen, but {}", how),
                   scene.loads.empty() ? "\"loads\" is empty: the body is in equilibrium for good"
                                       : "all loads are 0: the body is in equilibrium for good",
                   "add a load that grows, or choose \"dynamic\"");
  const auto grows = [](const LoadParameters &load) {
    return is_nonzero(load.velocity) || (moves(load) && (load.ramp > 0 || load.history.is_given()));
  };
  if (!any_load(scene, grows))
    f.warning("/loads", fmt::format("no load grows, but {}", how),
              "tractions and displacements without \"ramp\" are there at once: there is no load at "
              "which the next bond breaks",
              "give the loads a \"ramp\"");
}

// Its lumped multipliers are no projection: what it takes for equilibrium depends on the way there.
void check_scheme(const Scene &scene, const std::string &how, Findings &f)
{
  if (scene.coupling.scheme == coupling::Scheme::xiao_belytschko_lumped)
    f.error("/coupling/scheme",
            fmt::format("\"xiao_belytschko_lumped\" has no equilibrium, but {}", how),
            "its lumped multipliers leave a gap that grows under a standing load",
            "choose another scheme, or \"dynamic\"");
}

// Dashpots resist velocities alone.
void check_supports(const Scene &scene, const std::string &how, Findings &f)
{
  const auto absorbs = [](const LoadParameters &load) { return load.absorbing; };
  const auto holds = [](const LoadParameters &load) {
    return has_components(load.velocity) || has_components(load.displacement);
  };
  const auto first = std::find_if(scene.loads.begin(), scene.loads.end(), absorbs);
  if (first == scene.loads.end() || any_load(scene, holds))
    return;
  f.error(fmt::format("/loads/{}/absorbing", first - scene.loads.begin()),
          fmt::format("absorbing sides are the only support, but {}", how),
          "an absorbing side resists velocities: at rest it holds nothing, and there is no "
          "equilibrium",
          "hold a side by a \"displacement\" or a \"velocity\", remove \"absorbing\", or choose "
          "\"dynamic\"");
}

void check_rest(const Scene &scene, const std::string &how, Findings &f)
{
  const std::string key = "/time/rest_threshold";
  if (f.sound({key}) && scene.time.rest_threshold > 0)
    f.error(key, fmt::format("\"rest_threshold\" in /time is above 0, but {}", how),
            "regions that small motions do not wake keep forces that are not in balance, and so "
            "does the whole body",
            "remove \"rest_threshold\", or choose \"dynamic\"");
}

/// Keys of the solver without it; their defaults, which a resolved scene has, do no harm.
void check_unused(const Scene &scene, Findings &f)
{
  const TimeParameters plain = {}, &t = scene.time;
  const auto unused = [&](const std::string &name, bool differs, const std::string &needed) {
    const std::string key = "/time/" + name;
    if (differs && f.sound_and_given({key}))
      f.warning(key, fmt::format("\"{}\" in /time is not used", name),
                fmt::format("\"loading\" is \"{}\"", word_of(t.loading)),
                fmt::format("remove it, or choose {}", needed));
  };
  unused("calm", t.calm != plain.calm && t.loading != Loading::quasi_static, "\"static\"");
  unused("static_solver", t.static_solver != plain.static_solver && !t.has_phases(),
         "\"static\" or \"sequential\"");
}
} // namespace

void check_phases(const Scene &scene, Findings &f)
{
  if (!f.sound({loading_key}))
    return;
  check_unused(scene, f);
  if (!scene.time.has_phases())
    return;
  const std::string how =
      fmt::format("\"loading\" in /time is \"{}\"", word_of(scene.time.loading));
  check_rest(scene, how, f);
  if (f.sound({"/coupling/scheme"}))
    check_scheme(scene, how, f);
  if (f.sound({"/loads"})) {
    check_what_loads(scene, how, f);
    check_supports(scene, how, f);
  }
}
} // namespace ligament::program
