// What a face that softens remembers, number by number: of its state, and where ranks tell each
// other of it.
#pragma once

#include "dem/parts/cohesive_faces.h"

#include <string>

namespace ligament::dem
{
/// visit(column, number) for all that a face remembers.
template <int dim, typename F, typename Visit>
void for_each_face_number(F &face, Visit &&visit)
{
  const auto vector = [&](const std::string &name, auto &v) {
    for (int k = 0; k < int(v.size()); ++k)
      visit(name + "_" + std::to_string(k), v[k]);
  };
  visit("strength", face.law.strength);
  visit("reach", face.law.reach);
  visit("excess", face.law.excess);
  visit("excess_reach", face.law.excess_reach);
  vector("opening", face.stayed.jump);
  visit("largest", face.stayed.largest);
  visit("damage", face.stayed.damage);
  vector("last_force", face.last_force);
  vector("last_turn", face.last_turn);
  visit("spent", face.spent);
  visit("whole_energy", face.whole_energy);
  visit("work", face.work);
  visit("fall_begin", face.fall.begin);
  visit("fall_duration", face.fall.duration);
}
} // namespace ligament::dem
