// Forces of all lattice bonds, vectorised along rows: no lists, no gather, nothing stored per bond.
#pragma once

#include "dem/bond_network.h"

namespace ligament::dem
{
/// The streams that the kernel reads and writes, one array per component.
template <int dim>
struct LatticeArrays
{
  std::array<const double *, dim> displacement;
  /// 2D: angle, cos - 1, sin; 3D: unit quaternion.
  std::array<const double *, dim == 2 ? 3 : 4> turn;
  const std::uint32_t *mask;
  const double *lambda_per_volume;
  double *pressure;
  std::array<double *, dim> force;
  std::array<double *, n_spins<dim>> torque;
};

/// What the loops need of one lattice direction.
template <int dim>
struct DirectionConstants
{
  std::array<double, dim> normal;
  double half;    // q = r/2, m
  double shear;   // 2G S/r, N/m
  double area_r;  // S/r, m
  double bending; // k_b, N m
  double twist;   // k_t - k_b, N m
  double limit2;  // (strength S)^2, N^2; infinite when nothing breaks: the test costs less than
                  // a second set of loops, whose code the compiler makes slower
};

/// Particles [begin, end).
struct RowRange
{
  int begin, end;
};

/// cos - 1 and sin of n angles, to round-off for any angle below 1e5.
void cosine_minus_1_and_sine(const double *angle, double *cosine_minus_1, double *sine, int n);

/// Everything one sweep over the segments needs; passed through the run-time dispatch.
template <int dim>
struct RowSweep
{
  LatticeArrays<dim> arrays;
  const std::array<DirectionConstants<dim>, max_directions> *directions;
  const std::vector<RowSegment> *segments;
  std::vector<RowRange> *exceeded;
};

template <int dim>
class LatticeKernel
{
public:
  LatticeKernel(const std::vector<DirectionData<dim>> &directions, double shear_modulus);

  /// pressure = lambda_i theta_i, the part of the lattice bonds; overwrites.
  void dilatation(const LatticeArrays<dim> &arrays, const std::vector<RowSegment> &segments) const;

  /// Force and torque of the lattice bonds; overwrites. With a strength above 0 (Pa), appends to
  /// `exceeded` every range of particles that has a forward bond under at least that tension.
  void forces(const LatticeArrays<dim> &arrays, const std::vector<RowSegment> &segments,
              double strength, std::vector<RowRange> &exceeded) const;

private:
  // One for each dimension, in a file of its own.
  void sweep_dilatation_of(const RowSweep<dim> &sweep) const;
  void sweep_forces_of(const RowSweep<dim> &sweep) const;

  int n_directions_;
  std::array<double, max_directions> area_{};
  std::array<DirectionConstants<dim>, max_directions> constants_{};
};

template <>
void LatticeKernel<2>::sweep_dilatation_of(const RowSweep<2> &sweep) const;
template <>
void LatticeKernel<2>::sweep_forces_of(const RowSweep<2> &sweep) const;
template <>
void LatticeKernel<3>::sweep_dilatation_of(const RowSweep<3> &sweep) const;
template <>
void LatticeKernel<3>::sweep_forces_of(const RowSweep<3> &sweep) const;
} // namespace ligament::dem
