// The command that computes a study.
#pragma once

#include "src/launcher/command_line.h"

namespace ligament::program
{
/// Checks the study and all its scenes, computes what is missing, writes table and summary.
/// 0 also when cases were refused (their rows say so), 2 wrong study, 3 when a run was stopped by
/// its guard, 4 when one failed.
int sweep_command(const CommandLine &line);
} // namespace ligament::program
