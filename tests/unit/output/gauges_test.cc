// Gauges of a run: in its record, in the report, beside those of another run.
#include "src/analysis/compare.h"
#include "src/analysis/report.h"
#include "tests/unit/output/synthetic_run.h"
#include "tests/unit/output/xml.h"

#include <gtest/gtest.h>

#include <sstream>

using namespace ligament;
using namespace ligament::program;
using ligament::tests::SyntheticRun;

namespace
{
/// Of a gauge "gap" whose reading grows by `rate` from row to row.
RunFolder run_with_gauge(const std::string &path, double rate)
{
  SyntheticRun run;
  run.n_broken_before = run.n_broken_after = 0;
  const RunFolder folder = run.write(path);
  RunRecord record = read_run_record(folder.record());
  record.gauges = {{"gap", "opening", {"gap"}, "from <two> points"}};
  write_run_record(folder.record(), record);
  std::istringstream rows(core::read_file(folder.history()));
  std::string text, row;
  for (int k = 0; std::getline(rows, row); ++k)
    text += row + (k == 0 ? ",gap" : k == 1 ? ",m" : "," + std::to_string(rate * (k - 2))) + "\n";
  core::write_file(folder.history(), text);
  return folder;
}

TEST(GaugesOfARun, ComeBackFromTheRecordAndAreNotThereWithoutGauges)
{
  const RunFolder folder = run_with_gauge("gauge_record", 1);
  const RunRecord back = read_run_record(folder.record());
  ASSERT_EQ(back.gauges.size(), 1u);
  EXPECT_EQ(back.gauges[0].name, "gap");
  EXPECT_EQ(back.gauges[0].kind, "opening");
  EXPECT_EQ(back.gauges[0].columns, std::vector<std::string>{"gap"});
  EXPECT_EQ(back.gauges[0].text, "from <two> points");
  const RunFolder without = SyntheticRun().write("no_gauge_record");
  EXPECT_EQ(core::read_file(without.record()).find("gauges"), std::string::npos);
  EXPECT_TRUE(read_run_record(without.record()).gauges.empty());
}

TEST(GaugesOfARun, AreCurvesOfTheReport)
{
  run_with_gauge("gauge_report", 1);
  const std::string text = core::read_file(write_report("gauge_report"));
  EXPECT_NO_THROW(tests::parse_xml(text));
  const std::size_t start = text.find("<h2>Gauges</h2>");
  ASSERT_NE(start, std::string::npos);
  const std::string section = text.substr(start, text.find("<h2>", start + 1) - start);
  for (const char *part : {"<h3>gap</h3>", "from &lt;two&gt; points", "<svg"})
    EXPECT_NE(section.find(part), std::string::npos) << part;
  SyntheticRun().write("no_gauge_report");
  EXPECT_EQ(core::read_file(write_report("no_gauge_report")).find("Gauges"), std::string::npos);
}

TEST(GaugesOfARun, AreComparedWhereBothRunsHaveThem)
{
  run_with_gauge("gauge_run", 3);
  run_with_gauge("gauge_reference", 2);
  const CompareResult both = compare("gauge_run", "gauge_reference");
  ASSERT_EQ(both.gauges.count("gap"), 1u);
  EXPECT_NEAR(*both.gauges.at("gap").mean, 0.5, 1e-12);
  EXPECT_NEAR(*both.gauges.at("gap").largest, 0.5, 1e-12);
  EXPECT_NEAR(to_json(both)["gauges"]["gap"]["error"], 0.5, 1e-12);
  EXPECT_NE(table(both).find("gauge gap"), std::string::npos);

  SyntheticRun other;
  other.n_broken_before = other.n_broken_after = 0;
  other.write("gauge_less");
  EXPECT_TRUE(compare("gauge_run", "gauge_less").gauges.empty());
  EXPECT_TRUE(compare("gauge_less", "gauge_run").gauges.empty());
}
} // namespace
