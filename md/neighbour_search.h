// Which atoms of a run of cells are near a place, several at a time.
#pragma once

namespace ligament::md
{
/// Places as floats, in units in which their differences are precise enough.
struct PlaceArrays
{
  const float *x, *y, *z;
};

/// Appends to `found` (with room for end - begin more, and 16) the numbers from `begin` to before
/// `end` whose squared distance from (x, y, z) is below reach2; returns how many.
using FindNear = int (*)(const PlaceArrays &places, int begin, int end, float x, float y, float z,
                         float reach2, int *found);

/// That of the instruction set at hand.
FindNear find_near();
} // namespace ligament::md
