// Packings in files: a table of centres and radii that other programs read and write easily.
#pragma once

#include "packings/seeds.h"

#include <string>

namespace ligament::packings
{
/// Writes columns x, y, z, r, material and a row with their units (m; material: 1), then one row
/// per seed with all digits. z is 0 in 2D. Throws core::EnvironmentError when the file
/// cannot be written.
template <int dim>
void write_packing_file(const std::string &path, const Seeds<dim> &seeds);

/// Reads such a file; the columns may come in any order and in other units of length, columns with
/// other names are passed over, z may be missing in 2D and material altogether. Lines that begin
/// with # are comments. Ids are the numbers of the rows. Throws core::EnvironmentError when there
/// is no such file, core::InputError with file:line for everything else.
template <int dim>
Seeds<dim> read_packing_file(const std::string &path);
} // namespace ligament::packings
