// How far overlap and far field may move, and how far they do.
#pragma once

#include "core/largest.h"

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
template <int dim>
struct NearMotion
{
  Largest<dim> rotation; // rad
  Largest<dim> bending;  // rad, against the rotation of the part
  Largest<dim> strain;   // |S - 1|
};
} // namespace ligament::coupling
