// The list of broken faces as a table: broken_bonds.csv, the crack path that compare reads.
#pragma once

#include "src/output/fields.h"

#include <string>
#include <vector>

namespace ligament::program
{
/// Columns i, j, time, x, y, z, nx, ny, nz, size, energy with a row of units.
void write_broken_bonds(const std::string &path, const std::vector<BrokenBond> &bonds,
                        int dimension);
std::vector<BrokenBond> read_broken_bonds(const std::string &path);
} // namespace ligament::program
