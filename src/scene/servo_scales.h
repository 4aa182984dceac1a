// What of a servo follows from the scene: time to answer, speed that its course asks for.
#pragma once

#include "src/scene/scene.h"

namespace ligament::program
{
/// s, within which the machine answers: as given, or from the travel times of waves.
double servo_response(const Scene &scene, const ServoParameters &servo);
/// What the mean stress of a load's side answers to its motion along `component` while the specimen
/// is a bar between this side and the other end, pulled or sheared: a modulus over its length,
/// Pa/m.
double servo_stiffness(const Scene &scene, const LoadParameters &load, int component);
/// Whose column the servo follows: of the gauges with whose name that begins the one with the
/// longest; null: there is none.
const GaugeParameters *followed_gauge(const Scene &scene, const ServoParameters &servo);
} // namespace ligament::program
