// The page that shows a study: run time against error, the Pareto front, and all figures.
#pragma once

#include "src/drawing/plot.h"
#include "src/sweep/case_result.h"

namespace ligament::program
{
/// Run time against one error: points of each grid and of the rows, rivals by name, the run time of
/// the reference as a line, the Pareto front drawn. `error` chooses coupling or total.
Plot error_plot(const Study &study, const std::vector<CaseResult> &results,
                std::optional<CompareResult> CaseResult::*error);

/// Writes sweep.html and the plots as SVG beside it; `notes` are printed below the tables.
void write_summary(const StudyFolder &folder, const Study &study, const CaseList &list,
                   const std::vector<CaseResult> &results, const std::vector<std::string> &notes);
} // namespace ligament::program
