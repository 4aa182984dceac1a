// What a scene chooses by a word: enums, and their words in the order of the values.
#pragma once

#include "core/check.h"

#include <algorithm>
#include <string>
#include <vector>

namespace ligament::program
{
/// Arrangement of the particles.
enum class PackingKind
{
  square,       // 2D
  hexagonal,    // 2D
  simple_cubic, // 3D
  fcc,          // 3D
  bcc,          // 3D, atoms
  random,
  file
};

/// What atoms feel of each other.
enum class AtomPotential
{
  zhou,          // metals, built in
  plane_crystal, // 2D, built in
  lennard_jones,
  morse,
  setfl, // tables of files
  setfl_fs,
  funcfl
};

enum class Axis
{
  x,
  y,
  z
};

/// How a slot ends.
enum class SlotTip
{
  flat,
  round,
  v
};

/// What breaks a bond.
enum class Criterion
{
  none,
  maximum_tension,
  face_tension,
  principal_stress,
  von_mises,
  drucker_prager,
  mohr_coulomb,
  energy
};

/// What a material flows by.
enum class PlasticityLaw
{
  von_mises,
  drucker_prager
};

/// The curve along which a face softens.
enum class SofteningCurve
{
  linear,
  bilinear
};

/// The kinematics of overlap and far field: that of the motion, or a fixed one.
enum class RegimeChoice
{
  automatic,
  linear,
  corotated,
  nonlinear
};

/// What happens when a run leaves the range of its models.
enum class Guard
{
  stop,
  warn
};

enum class StopWhen
{
  end,
  specimen_broken
};

/// How a run comes from one breaking bond to the next.
enum class Loading
{
  dynamic,      // by steps all the way
  quasi_static, // by equilibria, and steps from a break until the body is calm again
  sequential    // by equilibria alone, bond by bond
};

/// What makes the linear systems of equilibria easy to solve.
enum class StaticSolver
{
  automatic,
  cholesky,
  multigrid,
  parallel_multigrid // by all ranks
};

/// What a load prescribes.
enum class LoadKind
{
  velocity,     // m/s
  displacement, // m
  traction,     // Pa
  force,        // N, spread over the part
  pressure      // Pa, along the present normal
};

/// The shape of a rigid tool.
enum class ToolKind
{
  plate,  // a rectangle, a box
  roller, // a disc, a cylinder
  ball,   // a disc, a ball
  wedge   // a convex polygon, a prism
};

/// The form of a single pulse.
enum class PulseShape
{
  half_sine,
  ricker
};

inline const std::vector<std::string> &words(PulseShape)
{
  static const std::vector<std::string> list = {"half_sine", "ricker"};
  return list;
}

inline const std::vector<std::string> &words(ToolKind)
{
  static const std::vector<std::string> list = {"plate", "roller", "ball", "wedge"};
  return list;
}

inline const std::vector<std::string> &words(PackingKind)
{
  static const std::vector<std::string> list = {"square", "hexagonal", "simple_cubic", "fcc",
                                                "bcc",    "random",    "file"};
  return list;
}

inline const std::vector<std::string> &words(AtomPotential)
{
  static const std::vector<std::string> list = {"zhou",  "plane_crystal", "lennard_jones", "morse",
                                                "setfl", "setfl_fs",      "funcfl"};
  return list;
}

inline const std::vector<std::string> &words(Axis)
{
  static const std::vector<std::string> list = {"x", "y", "z"};
  return list;
}

inline const std::vector<std::string> &words(SlotTip)
{
  static const std::vector<std::string> all = {"flat", "round", "v"};
  return all;
}
inline const std::vector<std::string> &words(Criterion)
{
  static const std::vector<std::string> list = {
      "none",      "maximum_tension", "face_tension", "principal_stress",
      "von_mises", "drucker_prager",  "mohr_coulomb", "energy"};
  return list;
}

inline const std::vector<std::string> &words(PlasticityLaw)
{
  static const std::vector<std::string> list = {"von_mises", "drucker_prager"};
  return list;
}

inline const std::vector<std::string> &words(SofteningCurve)
{
  static const std::vector<std::string> list = {"linear", "bilinear"};
  return list;
}

inline const std::vector<std::string> &words(RegimeChoice)
{
  static const std::vector<std::string> list = {"automatic", "linear", "corotated", "nonlinear"};
  return list;
}

inline const std::vector<std::string> &words(Guard)
{
  static const std::vector<std::string> list = {"stop", "warn"};
  return list;
}

inline const std::vector<std::string> &words(StopWhen)
{
  static const std::vector<std::string> list = {"end", "specimen_broken"};
  return list;
}

inline const std::vector<std::string> &words(Loading)
{
  static const std::vector<std::string> list = {"dynamic", "static", "sequential"};
  return list;
}

inline const std::vector<std::string> &words(StaticSolver)
{
  static const std::vector<std::string> list = {"automatic", "cholesky", "multigrid",
                                                "parallel_multigrid"};
  return list;
}

inline const std::vector<std::string> &words(LoadKind)
{
  static const std::vector<std::string> list = {"velocity", "displacement", "traction", "force",
                                                "pressure"};
  return list;
}

template <typename Enum>
const std::string &word_of(Enum value)
{
  return words(value)[std::size_t(value)];
}

/// The value of a word; core::InputError when there is none.
template <typename Enum>
Enum named(const std::string &word)
{
  const auto &list = words(Enum());
  const auto found = std::find(list.begin(), list.end(), word);
  core::require(found != list.end(), "unknown word \"" + word + "\"");
  return Enum(found - list.begin());
}
} // namespace ligament::program
