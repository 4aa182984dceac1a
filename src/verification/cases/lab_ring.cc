// A ring in free spin whose far field follows both circles, with a zone inside its wall.
#include "src/simulation/initial_motion.h"
#include "src/simulation/regime_control.h"
#include "src/verification/bodies/outlines.h"
#include "src/verification/cases/lab.h"
#include "src/verification/instruments/free_flight.h"

#include <cmath>

namespace ligament::program
{
namespace
{
std::vector<Result> spin(const std::string &name, double turns)
{
  constexpr double outer = 100, inner = 25, speed = 0.05; // of the bar's wave, at the outer rim
  Scene scene =
      outlined_scene(circle({0, 0, 0}, outer, "outer"), {circle({0, 0, 0}, inner, "inner")}, 0.3);
  couple(scene, {47, -15, 0}, {77, 15, 0});
  scene.coupling.regime = RegimeChoice::corotated;
  scene.initial_motion.emplace_back().spin[0] = speed / outer;
  UnitBody<2> unit(scene);
  auto &body = unit.body;
  const RegimeControl<2> control(scene.coupling.regime, body);
  start_motion(scene, body);
  const double before = angular_momentum(body)[0];
  const double energy =
      energy_change(body, std::lround(turns * 2 * M_PI * outer / speed / body.dt));
  return {
      {name + "/energy", energy, 1e-6, 1e-8},
      {name + "/angular_momentum", std::abs(angular_momentum(body)[0] / before - 1), 1e-10, {}}};
}
} // namespace

std::vector<Case> lab_ring_cases()
{
  const std::string text = "ring with a zone inside its wall in free spin, ";
  return {{"lab_ring", text + "ten turns", true, [] { return spin("lab_ring", 10); }},
          {"lab_ring_short", text + "a tenth of a turn", false,
           [] { return spin("lab_ring_short", 0.1); }}};
}
} // namespace ligament::program
