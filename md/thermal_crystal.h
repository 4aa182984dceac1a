// What heat does to a crystal: its lattice parameter and elastic constants at a temperature, from
// runs of a few hundred atoms that repeat themselves.
#pragma once

#include "md/crystal.h"

namespace ligament::md
{
struct ThermalRun
{
  double thermal_energy = 0; // kT in J
  std::int64_t seed = 1;
  int n_atoms = 1000;          // about so many; 2D: half
  double step_fraction = 0.12; // of the critical step
  /// Of the longest of the runs for the lattice parameter, and of each of those for stiffnesses.
  long lattice_steps = 8000, stiffness_steps = 4000;
};

/// Mean stress and motion at a fixed box (theory.md eqs. (M11), (M12)).
template <int dim>
struct ThermalState
{
  Strain<dim> stress = Strain<dim>::Zero(), error = Strain<dim>::Zero(); // Kirchhoff's, Pa
  double squared_displacement = 0; // m^2, mean of a component about the place in the lattice
};

/// `stretch`: of the box along x, about the lattice of the crystal. The box lies along the axes of
/// space: with cubes along them, or where `is_turned` with [110] along x and [-110] along y.
template <int dim>
ThermalState<dim> run_thermal_crystal(const Potential &potential, CrystalParameters<dim> parameters,
                                      bool is_turned, double stretch, const ThermalRun &run,
                                      long n_steps);

struct ThermalLattice
{
  double parameter = 0, error = 0;       // m; standard error
  double squared_displacement = 0;       // m^2, of a component
  double stress_error = 0, pressure = 0; // Pa, of the last run
};

/// The lattice parameter at which the mean stress is 0, by Newton's method with the static bulk
/// modulus. Orientation and lattice parameter of `parameters` are not asked.
template <int dim>
ThermalLattice thermal_lattice(const Potential &potential, CrystalParameters<dim> parameters,
                               const ThermalRun &run);

/// Independent constants: C11, C12, C44 of a cubic crystal, C11, C12 and C33 = (C11 - C12)/2 of a
/// triangular one.
struct CubicConstants
{
  double c11 = 0, c12 = 0, c44 = 0, error = 0; // Pa; the largest standard error
};

/// At the lattice parameter of `parameters`, by stresses under stretches of +-1 %.
template <int dim>
CubicConstants thermal_constants(const Potential &potential, CrystalParameters<dim> parameters,
                                 const ThermalRun &run);

/// Their C in the axes of space.
template <int dim>
Stiffness<dim> stiffness_of(const CubicConstants &constants, const Matrix<dim> &orientation);
} // namespace ligament::md
