// Potentials from the files in which they are published.
#pragma once

#include "md/potential.h"

namespace ligament::md
{
/// One species per file (DYNAMO's funcfl): F(rho), the effective charge Z(r), f(r). Species are
/// named by their atomic numbers ("29"); pairs of different ones have phi = Z_a Z_b/r.
Potential read_funcfl(const std::vector<std::string> &paths);

/// These species of a file of several (setfl): F, f of each, r phi of each pair.
Potential read_setfl(const std::string &path, const std::vector<std::string> &species);

/// The same with a density for each pair of species (setfl/fs, Finnis and Sinclair's form).
Potential read_setfl_fs(const std::string &path, const std::vector<std::string> &species);

// Units in the files: eV, angstrom, atomic mass units. phi and f become splines through the values
// of the file, on a grid that ends at the cut-off; what a function has left there goes over the
// last tenth of it, by a cubic. Wrong files throw core::InputError with file, line, column and
// reason: cut short, no number, steps or mass not above 0, cut-off beyond the table, a function
// that has more than a hundredth of its size left at the cut-off, a species that is not there.
} // namespace ligament::md
