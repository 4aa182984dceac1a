// What a run did by equilibria and what by steps, where its loading is not dynamic.
#pragma once

#include "src/output/run_record.h"

#include <string>

namespace ligament::program
{
/// Sums over the phases of a run.
struct PhaseTotals
{
  int n_static = 0, n_dynamic = 0;
  std::int64_t broken = 0;            // faces
  long steps = 0, skipped = 0;        // done one by one; that equilibria stand for
  long solves = 0, iterations = 0;    // of the equilibria
  double static_s = 0, dynamic_s = 0; // wall time
};

/// All 0 for runs without phases.
PhaseTotals totals(const RunRecord &record);

/// Steps that were done one by one, in any run.
long steps_done(const RunRecord &record);

/// For the verdict: "7 static phases and 24 000 steps stood for 121 000 000 steps"; empty without
/// phases.
std::string phases_sentence(const RunRecord &record);

/// The section of the report: one row per phase, with the faces that it broke; empty without.
std::string phases_section(const RunRecord &record);
} // namespace ligament::program
