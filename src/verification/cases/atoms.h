// Bodies of atoms coupled to a mesh.
#pragma once

#include "src/verification/cases.h"

namespace ligament::program
{
std::vector<Case> atom_cases();
std::vector<Case> atom_strain_cases();
std::vector<Case> atom_cleavage_cases();
std::vector<Case> atom_crack_disc_cases();
std::vector<Case> atom_emission_cases();
std::vector<Case> atom_heat_cases();
std::vector<Case> atom_motion_cases();
std::vector<Case> atom_wave_cases();
} // namespace ligament::program
