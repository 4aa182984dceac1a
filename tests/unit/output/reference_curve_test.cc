// Curves that compare must refuse: their figures would be wrong without a word.
#include "src/analysis/compare.h"

#include "core/check.h"
#include "tests/unit/output/synthetic_run.h"

#include <gtest/gtest.h>

using namespace ligament;
using namespace ligament::program;
using ligament::tests::SyntheticRun;

namespace
{
/// What compare says against this curve; empty where it takes it.
std::string refusal(const std::string &curve)
{
  SyntheticRun().write("run");
  core::write_file("curve.csv", curve);
  try {
    compare("run", "curve.csv");
  } catch (const core::InputError &error) {
    return error.what();
  }
  return "";
}

TEST(ReferenceCurve, TimeMustNotFall)
{
  const std::string head = "time,load\n# measured\nms,N\n\n0,0\n";
  const std::string text = refusal(head + "0.02,10\n0.01,20\n0.03,30\n");
  EXPECT_NE(text.find("curve.csv:7: \"time\" falls from 2e-05 s to 1e-05 s"), std::string::npos)
      << text;
  EXPECT_NE(text.find("sort the rows"), std::string::npos) << text;
  EXPECT_NE(refusal(head + "0.02,10\n,20\n0.01,30\n").find("curve.csv:8"), std::string::npos)
      << "a gap hides nothing";
  EXPECT_EQ(refusal(head + "0.01,10\n0.01,12\n,20\n0.03,30\n"), "") << "a load may jump";
}

TEST(ReferenceCurve, ColumnsHaveNamesOfTheirOwn)
{
  const std::string text = refusal("displacement,load,load\nmm,kN,N\n0,0,0\n0.001,1,5\n");
  EXPECT_NE(text.find("curve.csv: 2 columns are named \"load\""), std::string::npos) << text;
  EXPECT_NE(text.find("rename or remove"), std::string::npos) << text;
  EXPECT_EQ(refusal("displacement,load,,\nmm,kN,,\n0,0,,\n0.001,1,,\n"), "")
      << "columns that nobody reads";
}

// What a test machine without a gauge of displacement writes.
TEST(ReferenceCurve, OfLoadOverTimeIsDrawn)
{
  SyntheticRun().write("run");
  core::write_file("timed.csv", "time,load\nus,kN\n0,0\n50,40\n100,90\n");
  const CompareResult r = compare("run", "timed.csv");
  EXPECT_EQ(table(r).find("plot: the curves"), std::string::npos) << table(r);
  for (const char *part : {">run<", ">timed<", "time"})
    EXPECT_NE(r.plot.find(part), std::string::npos) << part;
  core::write_file("timed.csv", "time,stress\nus,MPa\n0,0\n50,0.4\n100,0.9\n");
  EXPECT_EQ(table(compare("run", "timed.csv")).find("plot: the curves"), std::string::npos);
}
} // namespace
