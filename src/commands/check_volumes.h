// `check` of bodies that take long to build: what follows from volumes, and what is left open.
#pragma once

#include "src/launcher/command_line.h"
#include "src/scene/read_scene.h"
#include "src/scene/size_estimate.h"

namespace ligament::program
{
/// More particles or cells than this are built with --full only.
inline constexpr double largest_built = 2e6;

/// Memory of this machine that programs can still get, in bytes; 0 when it does not say.
double available_memory();

/// Prints the card with the sizes; --json leaves what was not computed null and names it.
void print_volumes(const CommandLine &line, const ReadResult &input, const SizeEstimate &size);
} // namespace ligament::program
