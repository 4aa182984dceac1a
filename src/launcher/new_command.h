// The command that writes a scene to begin with.
#pragma once

#include "src/launcher/command_line.h"

namespace ligament::program
{
/// Writes the scene of a kind into a new file, or lists the kinds. Throws core::InputError when
/// there is no such kind or the file exists, core::EnvironmentError when it cannot be written.
int new_command(const CommandLine &line);
} // namespace ligament::program
