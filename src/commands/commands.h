// The commands that compute: what each prints, writes and returns as exit code.
#pragma once

#include "core/ranks.h"
#include "src/launcher/command_line.h"
#include "src/scene/read_scene.h"

namespace ligament::program
{
/// Runs the scene into the output folder (see output_folder()) and writes the report.
/// 0 done, 3 stopped by a guard. Several ranks compute it together; the first one writes.
int run_command(const CommandLine &line, const ReadResult &input, const core::Ranks &ranks);

/// Goes on with a run from its newest checkpoint, in its folder, on as many ranks as there are. As
/// run_command.
int resume_command(const CommandLine &line, const core::Ranks &ranks);

/// Builds everything, steps for a moment to predict the run, prints the pre-flight card.
int check_command(const CommandLine &line, const ReadResult &input);
} // namespace ligament::program
