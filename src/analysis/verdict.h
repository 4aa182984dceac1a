// One sentence that says what the coupling was worth and whether the run can be trusted.
#pragma once

#include "src/output/run_record.h"

#include <optional>
#include <string>

namespace ligament::program
{
/// Whether the record has the figures that a run knows only at its end: steps, loads, what broke.
/// One that is under way, or was killed, has none, nor has one that failed outside of its loop.
bool has_figures(const RunRecord &record);

/// read_run_record(); of a run that goes on from a checkpoint the figures of its earlier end are
/// left out.
RunRecord read_figures(const std::string &path);

/// "is not finished", or with its reason "was interrupted: by a signal".
std::string incompleteness_with_reason(const RunRecord &record);

/// Wall time of the pure discrete model of the same specimen over the wall time of this run, with
/// the time per particle and step that this run measured, and its output. Empty when a figure is
/// missing, and for runs with phases.
std::optional<double> predicted_saving(const RunRecord &record);

/// A warning with the energy that it cost.
std::string warning_text(const RunRecord &record, const RunWarning &warning);

/// Complete, energies that add up, and nothing left the range of its model.
bool is_stable(const RunRecord &record);

/// For example "8 700 particles and 2 350 cells stood for 121 000 particles: 11.4 x faster than
/// pure discrete elements would be at this rate; energy residual 3e-05; nothing unstable". Repeats
/// every warning; "nothing unstable" stands there only when is_stable().
std::string verdict(const RunRecord &record);

/// One sentence for the top of the report: what broke, at which load; where nobody knows yet, why.
std::string headline(const RunRecord &record);
} // namespace ligament::program
