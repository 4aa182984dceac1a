// The units that tables of potentials are written in.
#pragma once

namespace ligament::md
{
inline constexpr double electron_volt = 1.602176634e-19;      // J
inline constexpr double angstrom = 1e-10;                     // m
inline constexpr double atomic_mass_unit = 1.66053906660e-27; // kg
inline constexpr double boltzmann = 1.380649e-23;             // J/K
} // namespace ligament::md
