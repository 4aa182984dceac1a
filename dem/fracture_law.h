// When a bond breaks: the criterion on the traction of its face.
#pragma once

#include <vector>

namespace ligament::dem
{
struct FractureLaw
{
  enum class Criterion
  {
    none,
    maximum_tension // s_nn >= strength, theory.md section 1.6
  };
  Criterion criterion = Criterion::none;
  double strength = 0; // Pa
  /// Pa, of each material where a body has several; empty: `strength` for all. A bond between two
  /// breaks at the smaller one.
  std::vector<double> strengths = {};
};
} // namespace ligament::dem
