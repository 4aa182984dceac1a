// The figures of one case: cost, results, and errors to both references.
#pragma once

#include "src/analysis/compare.h"
#include "src/output/run_record.h"
#include "src/sweep/sweep.h"

namespace ligament::program
{
struct CaseResult
{
  const Case *scene;
  CaseEnd end;
  std::optional<RunRecord> record; // of cases that were computed
  std::optional<RunCost> cost;
  /// Against the reference of the study; the reference itself has none.
  std::optional<CompareResult> coupling;
  /// Against the right answer; from an analytic figure only that one is there.
  std::optional<CompareResult> total;
  bool is_reference = false, is_total_reference = false;

  /// Set-up and time loop, s: what a user waits.
  std::optional<double> run_time() const;
  std::optional<double> time(Cost kind) const;
};

/// In the order of the study. `notes` says why an error is missing.
std::vector<CaseResult> evaluate(const Study &study, const CaseList &list,
                                 const std::map<std::string, CaseEnd> &ends,
                                 std::vector<std::string> &notes);

/// Magnitude of the error that the study measures; crack distances are in particle diameters.
std::optional<double> measured(const CompareResult &result, Measure measure);
std::string measure_name(Measure measure);

/// Writes one line per case, below a row of names and a row of units.
void write_table(const std::string &path, const CaseList &list,
                 const std::vector<CaseResult> &results);
} // namespace ligament::program
