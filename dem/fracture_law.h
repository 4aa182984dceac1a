// When a bond breaks: the criterion and its strengths.
#pragma once

#include <vector>

namespace ligament::dem
{
/// theory.md section 1.6.
struct FractureLaw
{
  enum class Criterion
  {
    none,
    face_tension,   // the normal stress on the face
    maximum_tension // the largest principal stress as the face carries it, eq. (D12)
  };
  Criterion criterion = Criterion::none;
  double strength = 0; // Pa
  /// Pa, of each material where a body has several; empty: `strength` for all. A bond between two
  /// breaks at the smaller one.
  std::vector<double> strengths = {};
  /// m^2, thickness included: faces of another size than this bear another tension, eq. (D12b),
  /// maximum_tension alone; 0: size doesn't matter.
  double whole_face = 0;
};
} // namespace ligament::dem
