// Potentials that need no file: Lennard-Jones, Morse, metals by Zhou, Johnson and Wadley, and a
// crystal in the plane with many-body forces.
#pragma once

#include "md/potential.h"

namespace ligament::md
{
/// Smoothly cut: from `taper_begin` to `cutoff` the functions of the distance are multiplied by
/// 1 - 10 s^3 + 15 s^4 - 6 s^5, s running from 0 to 1, (M3).
struct CutOff
{
  double taper_begin, cutoff; // m
};

/// 4 depth ((size/r)^12 - (size/r)^6); depth in J, size in m; below size/2 along its tangent.
/// Cut-off by default from 2.2 to 2.5 times the size.
Potential lennard_jones(const Species &species, double depth, double size);
Potential lennard_jones(const Species &species, double depth, double size, const CutOff &cut);

/// depth (exp(-2 decay (r - distance)) - 2 exp(-decay (r - distance))); depth in J, decay in 1/m.
Potential morse(const Species &species, double depth, double distance, double decay,
                const CutOff &cut);

/// Metals after X. W. Zhou, R. A. Johnson, H. N. G. Wadley, Phys. Rev. B 69 (2004) 144113, and
/// their alloys: names out of zhou_metals(). Throws core::InputError for others. The functions are
/// cut between 2.0 and 2.3 of the largest distance of nearest neighbours.
Potential zhou_johnson_wadley(const std::vector<std::string> &metals);
const std::vector<std::string> &zhou_metals();

/// A triangular crystal in the plane that is bound half by pairs and half by density: Morse pairs
/// of depth `energy`/6 with decay 5/distance, f = exp(-5 (r/distance - 1)), and
/// F = -energy/2 sqrt(rho/6); all cut from 1.6 to 2.0 distances. Cauchy's relation does not hold.
Potential plane_crystal(const Species &species, double energy, double distance);
} // namespace ligament::md
