// Potentials that the tests of atoms run over.
#pragma once

#include "md/analytic.h"
#include "md/atomic_units.h"
#include "md/crystal.h"
#include "md/table_file.h"

#include <gtest/gtest.h>

#include <random>

namespace ligament::md::testing
{
/// Where Debian's package lammps-data has its tables.
inline std::string table(const std::string &name)
{
  return "/usr/share/lammps/potentials/" + name;
}

inline Potential foiles_copper()
{
  return read_funcfl({table("Cu_u3.eam")});
}
inline Potential mishin_copper()
{
  return read_setfl(table("Cu_mishin1.eam.alloy"), {"Cu"});
}
inline Potential mendelev_iron()
{
  return read_setfl_fs(table("Fe_mm.eam.fs"), {"Fe"});
}
inline Potential nickel_aluminium() // densities by the atom that makes them
{
  return read_setfl(table("NiAlH_jea.eam.alloy"), {"Ni", "Al"});
}
inline Potential copper_zirconium() // densities by pairs
{
  return read_setfl_fs(table("CuZr_mm.eam.fs"), {"Cu", "Zr"});
}
inline Species argon()
{
  return {"Ar", 39.948 * atomic_mass_unit};
}
inline Potential argon_pairs()
{
  return lennard_jones(argon(), 0.0104 * electron_volt, 3.4 * angstrom);
}
inline Potential plane_atoms()
{
  return plane_crystal({"X", 60 * atomic_mass_unit}, 3 * electron_volt, 2.5 * angstrom);
}

struct NamedCrystal
{
  std::string name;
  Potential potential;
  CrystalKind kind;
};

inline std::vector<NamedCrystal> solids()
{
  return {{"Foiles copper", foiles_copper(), CrystalKind::fcc},
          {"Mishin copper", mishin_copper(), CrystalKind::fcc},
          {"Mendelev iron", mendelev_iron(), CrystalKind::bcc},
          {"Zhou nickel", zhou_johnson_wadley({"Ni"}), CrystalKind::fcc},
          {"Zhou tungsten", zhou_johnson_wadley({"W"}), CrystalKind::bcc},
          {"Lennard-Jones", argon_pairs(), CrystalKind::fcc}};
}

/// Numbers between -1 and 1.
class Noise
{
public:
  explicit Noise(unsigned seed) : random_(seed) {}
  double operator()() { return distribution_(random_); }
  template <int rows, int columns>
  Eigen::Matrix<double, rows, columns> matrix()
  {
    Eigen::Matrix<double, rows, columns> m;
    for (int k = 0; k < rows * columns; ++k)
      m(k % rows, k / rows) = (*this)();
    return m;
  }

private:
  std::mt19937 random_;
  std::uniform_real_distribution<double> distribution_{-1, 1};
};

/// A rotation about no axis of symmetry.
template <int dim>
Matrix<dim> some_rotation()
{
  if constexpr (dim == 2) {
    Matrix<2> q;
    q << std::cos(0.3), -std::sin(0.3), std::sin(0.3), std::cos(0.3);
    return q;
  } else
    return orientation_of({2, 1, 3}, {3, 0, -2});
}
} // namespace ligament::md::testing
