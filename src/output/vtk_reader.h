// Reads back the fields that a run wrote, so that pictures can be drawn of them later.
#pragma once

#include "src/output/fields.h"

#include <string>

namespace ligament::program
{
/// Only files as write_particles_vtp and write_cells_vtu write them. InputError when a file is
/// missing, cut short or of another kind.
ParticleFields read_particles_vtp(const std::string &path);
/// Of all pieces of a .pvtp, in their order.
ParticleFields read_particles_pvtp(const std::string &path);
CellFields read_cells_vtu(const std::string &path);
} // namespace ligament::program
