// How far overlap and far field may move, and how far they do.
#pragma once

#include <string>
#include <vector>

namespace ligament::coupling
{
/// How far the overlap may move (theory.md, "Large rotation and finite strain").
enum class Regime
{
  linear,    // small rotations
  corotated, // any rotation of each connected part of the overlap, little bending of it
  nonlinear  // any rotation of every cell, finite strain, nonlinear laws
};

inline const std::vector<std::string> regime_names = {"linear", "corotated", "nonlinear"};

inline const std::string &name_of(Regime regime)
{
  return regime_names[int(regime)];
}

/// How far the near cells move, at their centres.
struct NearMotion
{
  double rotation = 0; // rad, the largest
  double bending = 0;  // rad, the largest against the rotation of the part
  double strain = 0;   // the largest |S - 1|
};
} // namespace ligament::coupling
