// The names of the couplers and of their choices, as scenes write them.
#pragma once

#include <string>
#include <vector>

namespace ligament::coupling
{
/// What joins the two halves (theory.md sections 3.1 and 3.9); values in the order of scheme_names.
enum class Scheme
{
  fine_scale_split,
  acceleration,
  xiao_belytschko,
  xiao_belytschko_lumped,
  pointwise,
  none
};

inline const std::vector<std::string> scheme_names = {"fine_scale_split", "acceleration",
                                                      "xiao_belytschko",  "xiao_belytschko_lumped",
                                                      "pointwise",        "none"};

/// Both models are weighted by their share of the energy and tied by multipliers.
inline bool is_energy_weighted(Scheme scheme)
{
  return scheme != Scheme::fine_scale_split && scheme != Scheme::none;
}

/// The share a of the discrete model over its relative position s in the overlap.
enum class WeightShape
{
  linear,  // s
  cubic,   // 3 s^2 - 2 s^3
  cosine,  // (1 - cos(pi s))/2
  constant // 1/2
};

inline const std::vector<std::string> weight_names = {"linear", "cubic", "cosine", "constant"};

/// Which library solves the systems of the overlap.
enum class Solver
{
  eigen, // sparse Cholesky
  amesos // Trilinos, KLU
};

inline const std::vector<std::string> solver_names = {"eigen", "amesos"};

/// How the energy-weighted schemes damp the particles' motion against the mesh.
enum class DamperForm
{
  symmetrised, // v -= M^-1 Q^T M g Q v: only takes energy
  printed      // v -= g Q v: as the literature prints it; may add energy
};

inline const std::vector<std::string> damper_form_names = {"symmetrised", "printed"};
} // namespace ligament::coupling
