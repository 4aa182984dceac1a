// What the sweeps of the kernels read and write of inelastic strains; passed through the run-time
// dispatch.
#pragma once

#include "core/types.h"
#include "dem/inelastic/plasticity.h"

#include <cstdint>

namespace ligament::dem
{
/// Components of a symmetric tensor: xx, yy, zz, yz, xz, xy without engineering factors; in 2D xx,
/// yy, zz, xy.
template <int dim>
inline constexpr int n_tensor = dim == 2 ? 4 : 6;
/// Of the axes of the body alone: in 2D xx, yy, xy.
template <int dim>
inline constexpr int n_in_plane = n_strains<dim>;

/// Place of component (a, b), a and b below dim.
template <int dim>
constexpr int tensor_place(int a, int b)
{
  return a == b ? a : dim == 2 ? 3 : 6 - a - b;
}
template <int dim>
constexpr int in_plane_place(int a, int b)
{
  return a == b ? a : dim == 2 ? 2 : 6 - a - b;
}

/// State of the particles, one stream per number.
template <int dim>
struct InelasticStreams
{
  static constexpr int strain = 0;             // e, in the particle's own axes
  static constexpr int stress = n_tensor<dim>; // after the last return, Pa
  static constexpr int history = 2 * stress;   // the law's number, accumulated
  static constexpr int taken = history + 1;    // J, energy that flow took
  static constexpr int n_streams = taken + 1;
  // Behind them where a material is viscous.
  static constexpr int viscous = n_streams;                // the viscous part of e
  static constexpr int driving = viscous + n_tensor<dim>;  // deviator that drives the branches
  static constexpr int rated = driving + n_tensor<dim>;    // strain that the dashpot resists
  static constexpr int dissipated = rated + n_tensor<dim>; // J, by viscosity
  static constexpr int branches = dissipated + 1;          // elastic strains of the branches

  /// Of bodies whose materials have up to so many branches; -1: none is viscous.
  static constexpr int count(int most_branches)
  {
    return most_branches < 0 ? n_streams : branches + most_branches * n_tensor<dim>;
  }

  double *first = nullptr;
  long stride = 0;

  double *stream(int k) const { return first + k * stride; }
};

/// Particles of one flag; those of one that is 0 have neither strains nor memory for them. Which
/// particles share a block depends on what a process holds, so no result may depend on it.
inline constexpr int inelastic_block = 256;

/// What a branch does in the step that ends with a sweep, theory.md eq. (D26).
struct BranchStep
{
  double share = 0;
  double kept = 1; // of its strain before
  double lead = 1; // of the increment of the driving strain
};

/// Viscosity of one material in the same step: e_v = answer d + what the step before left.
struct ViscousStep
{
  int n_branches = 0;
  const BranchStep *branches = nullptr;
  double of_branches = 0; // of the answer
  bool has_dashpot = false;
  bool follows = false; // another one, whose stresses are known
  double rate = 0;      // of the dashpot: eta / (G Dt)

  double answer() const { return of_branches - rate; }
};

/// Law of one material as kernels read it.
struct FlowLaw
{
  enum class Kind
  {
    elastic,
    von_mises,
    drucker_prager
  };
  Kind kind = Kind::elastic;
  bool is_plane_stress = false;
  double shear = 0, bulk = 0;         // G, K in Pa
  double yield = 0, hardening = 0;    // Pa
  double saturation = 0, rate = 0;    // Pa, -
  double friction = 0, dilatancy = 0; // -
  int n_points = 0;                   // of the yield curve's table; 0: the formula
  const double *strain = nullptr, *stress = nullptr;
  const ViscousStep *viscous = nullptr; // null: not viscous
};

/// A cell that lacks faces of the lattice, or all of whose faces are no lattice's: what beside
/// lattice bonds enters its strain, its volume, and the M of eq. (D20) for each row of e M.
template <int dim>
struct OpenCell
{
  static constexpr int strain = 0, volume = dim * dim, moment = volume + 1;
  static constexpr int size = moment + dim * n_in_plane<dim>;
  double number[size] = {};
};

template <int dim>
struct InelasticSweep
{
  InelasticStreams<dim> streams;
  std::uint8_t *begun; // of the blocks: 1 where the state of their particles is kept
  int n_blocks;
  const std::uint8_t *law_of; // of the particles; null: all 0
  const FlowLaw *laws;
  const int *open; // of the particles: their open cell or -1
  OpenCell<dim> *cells;
  const double *volume;                  // m^3, of the particles; null: whole_volume
  double whole_volume, per_whole_volume; // m^3 and 1/m^3
  bool is_plane_strain;
  bool may_flow;
  double *energy = nullptr; // J, of the particles: what strains of their own change

  /// e of a particle without its part out of the plane, in its own axes.
  Eigen::Matrix<double, dim, dim> strain(int i) const
  {
    Eigen::Matrix<double, dim, dim> e = Eigen::Matrix<double, dim, dim>::Zero();
    if (begun[i / inelastic_block])
      for (int a = 0; a < dim; ++a)
        for (int b = 0; b < dim; ++b)
          e(a, b) = streams.stream(streams.strain + tensor_place<dim>(a, b))[i];
    return e;
  }
};
} // namespace ligament::dem
