// When a bond breaks: the criterion on the traction of its face.
#pragma once

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
};
} // namespace ligament::dem
