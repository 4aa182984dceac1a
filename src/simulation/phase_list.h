// The phases of a run that alternates between steps and equilibria, as state and record have them.
#pragma once

#include "core/state.h"
#include "src/output/run_record.h"

#include <vector>

namespace ligament::program
{
/// The numbers are those of states.
enum class PhaseEnd
{
  bond_breaks,
  above_strength,
  end_of_run,
  out_of_balance,
  no_resistance,
  stopped,
  calm,
  restless,
  face_torn
};

/// For log and report.
std::string text_of(PhaseEnd end);

struct Phase
{
  bool is_static;
  long begin, end; // steps
  int solves = 0, iterations = 0;
  double load = 0; // N
  long broken = 0;
  PhaseEnd reason = PhaseEnd::end_of_run;
  double seconds = 0; // of the wall clock
};

/// With steps of dt (s).
PhaseEntry entry_of(const Phase &phase, double dt);

core::Table table_of(const std::vector<Phase> &phases);
std::vector<Phase> phases_of(const core::Table &table);
} // namespace ligament::program
