// Zones that follow the specimen: around its cracks, notches and corners.
#pragma once

#include "src/scene/findings.h"
#include "src/scene/scene.h"

#include <string>

namespace ligament::program
{
/// Turns /discrete_zone/around into a region or boxes (m): around each thing that it names the
/// margin and the overlap; sides that would leave less than two of the largest cells of far field
/// reach through, boxes nearer to each other than their transitions become one. Throws
/// core::KeyedError where nothing of what it names is there.
void place_zone(Scene &scene);

/// The key that says where the zone is: /discrete_zone/region, boxes or around.
std::string zone_place(const Scene &scene);

/// What to write for a scene without a zone: one around all that may break first, as a remedy of an
/// error. With a sound spacing it comes with numbers.
std::string proposed_zone(const Scene &scene, const Findings &findings);
} // namespace ligament::program
