// How a run ends for the one who started it: report, lines on standard output, exit code.
#pragma once

#include "src/launcher/command_line.h"
#include "src/output/run_folder.h"
#include "src/output/run_record.h"
#include "src/simulation/end_request.h"

namespace ligament::program
{
/// Exit code of a run that --wall-time ended, as of timeout(1).
constexpr int out_of_time = 124;

/// What asks a run that begins now to end. The outputs of a run take time, too: its loop ends
/// before the limit of --wall-time by a tenth of it, or a minute, and pictures that are still to be
/// drawn then are left out.
EndRequest end_request(const CommandLine &line, core::Interruption &interruption);

/// Writes the report, says how the run ended, returns the exit code. `name`: of the run in
/// messages.
int end_of_run(const CommandLine &line, const std::string &name, const RunFolder &folder,
               const RunRecord &record, const core::Interruption &interruption);
} // namespace ligament::program
