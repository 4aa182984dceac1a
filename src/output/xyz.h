// Atoms in the form that OVITO, ASE and others read: extended XYZ.
#pragma once

#include "src/output/fields.h"

#include <string>

namespace ligament::program
{
/// Each atom by the symbol of its material. Positions at present and velocities in angstrom and
/// angstrom/ps, energies in eV, stresses in GPa; all other scalar fields as they are. One frame.
/// Throws EnvironmentError when the disk refuses and never leaves half a file.
void write_atoms_xyz(const std::string &path, const ParticleFields &atoms, double time);
} // namespace ligament::program
