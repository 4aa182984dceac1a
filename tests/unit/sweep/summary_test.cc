// The page of a study: which cases its table of the best ones takes, and which the plot can draw.
#include "src/sweep/summary.h"

#include "core/files.h"

#include <gtest/gtest.h>

#include <filesystem>

using namespace ligament;
using namespace ligament::program;

namespace
{
struct Figures
{
  const char *name;
  double run_time, error;
};

/// Cases that ran, with these costs and errors of their peak loads.
std::vector<CaseResult> results_of(const std::vector<Figures> &figures, std::vector<Case> &cases)
{
  cases.resize(figures.size());
  std::vector<CaseResult> results;
  for (std::size_t k = 0; k < figures.size(); ++k) {
    cases[k].name = figures[k].name;
    CaseResult r;
    r.scene = &cases[k];
    r.end.status = CaseEnd::Status::done;
    r.record.emplace().wall_seconds = figures[k].run_time;
    r.coupling.emplace().peak_load_error = figures[k].error;
    results.push_back(r);
  }
  return results;
}

// Nothing beats an error of 0, which the logarithmic axis of the plot cannot show.
TEST(Summary, AnErrorOfZeroIsOfTheFront)
{
  CaseList list;
  const auto results =
      results_of({{"exact", 20, 0}, {"quick", 10, 0.25}, {"beaten", 30, 0.125}}, list.cases);
  std::filesystem::remove_all("exact_study");
  const StudyFolder folder("exact_study");
  write_summary(folder, {}, list, results, {});
  const std::string page = core::read_file(folder.summary());
  EXPECT_NE(page.find("<td>exact</td><td>20 s</td><td>0 %</td>"), std::string::npos) << page;
  EXPECT_NE(page.find("<td>quick</td><td>10 s</td><td>25 %</td>"), std::string::npos) << page;
  EXPECT_EQ(page.find("<td>beaten</td><td>30 s</td>"), std::string::npos) << page;

  const Plot plot = error_plot({}, results, &CaseResult::coupling);
  ASSERT_EQ(plot.series.size(), 2u);
  EXPECT_EQ(plot.series[0].y, (std::vector<double>{0.25, 0.125})); // all cases
  EXPECT_EQ(plot.series[1].y, (std::vector<double>{0.25}));        // the front
}

TEST(Summary, ErrorsThatAreAllZeroLeaveATable)
{
  CaseList list;
  const auto results = results_of({{"twin", 20, 0}}, list.cases);
  std::filesystem::remove_all("twin_study");
  const StudyFolder folder("twin_study");
  write_summary(folder, {}, list, results, {});
  EXPECT_NE(core::read_file(folder.summary()).find("<td>twin</td><td>20 s</td><td>0 %</td>"),
            std::string::npos);
}
} // namespace
