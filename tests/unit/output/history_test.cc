// Tables with units: round trip, conversion, refusal.
#include "src/output/history.h"

#include "core/check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

using namespace ligament;
using namespace ligament::program;

namespace
{
std::string refusal(const std::function<void()> &action)
{
  try {
    action();
  } catch (const core::InputError &error) {
    return error.what();
  }
  return "";
}

TEST(History, GivesTheSameNumbersBack)
{
  HistoryWriter writer("history.csv", history_columns(2), 1);
  const double values[] = {0.1, 1. / 3, -2.5e-300, 1e22};
  writer.set("stress", 5); // in the first row only
  for (const double value : values) {
    writer.set("time", value);
    writer.set("load", -value);
    writer.end_row();
  }
  const Table table = read_csv("history.csv");
  ASSERT_EQ(table.n_rows(), std::size(values));
  EXPECT_EQ(table.columns().size(), history_columns(2).size());
  for (std::size_t i = 0; i < std::size(values); ++i) {
    EXPECT_EQ(table.column("time", "s")[i], values[i]);
    EXPECT_EQ(table.column("load", "N")[i], -values[i]);
    EXPECT_EQ(std::isnan(table.column("stress", "Pa")[i]), i > 0) << "a value of the row before";
    EXPECT_TRUE(std::isnan(table.column("strain", "1")[i]));
  }
  EXPECT_THROW(writer.set("laod", 1), core::InputError);
}

// A run may end where a look has written its state.
TEST(History, HasTheLastRowOnce)
{
  for (const double last : {2., 3.}) {
    HistoryWriter writer("last.csv", history_columns(2), 1);
    for (const double time : {1., 2.}) {
      writer.set("time", time);
      writer.end_row();
    }
    writer.set("time", last);
    writer.end_last_row();
    writer.flush();
    EXPECT_EQ(read_csv("last.csv").n_rows(), last == 2 ? 2u : 3u);
    EXPECT_EQ(read_csv("last.csv").column("time", "s").back(), last);
  }
}

// Phases add columns and change none.
TEST(History, HasColumnsForPhases)
{
  for (const int dimension : {2, 3}) {
    std::vector<Column> without = history_columns(dimension), with;
    std::vector<std::string> added;
    for (const Column &column : history_columns(dimension, true))
      if (column.name == "settled" || column.name == "static")
        added.push_back(column.name + " in " + column.unit);
      else
        with.push_back(column);
    EXPECT_EQ(added, (std::vector<std::string>{"settled in J", "static in 1"}));
    ASSERT_EQ(with.size(), without.size());
    for (std::size_t c = 0; c < with.size(); ++c) {
      EXPECT_EQ(with[c].name, without[c].name);
      EXPECT_EQ(with[c].unit, without[c].unit);
    }
  }
}

TEST(History, RowsReachTheDiskAtTheirInterval)
{
  HistoryWriter writer("buffered.csv", {{"time", "s"}}, 3);
  for (int i = 0; i < 5; ++i)
    writer.end_row();
  EXPECT_EQ(read_csv("buffered.csv").n_rows(), 3u);
  writer.flush();
  EXPECT_EQ(read_csv("buffered.csv").n_rows(), 5u);
}

TEST(History, FullDiskIsNoticed)
{
  EXPECT_THROW(HistoryWriter("/dev/full", history_columns(3)), core::EnvironmentError);
}

TEST(Units, PrefixesOfTheUnitAskedFor)
{
  EXPECT_EQ(unit_factor("kN", "N"), 1e3);
  EXPECT_EQ(unit_factor("MPa", "Pa"), 1e6);
  EXPECT_EQ(unit_factor("mm", "m"), 1e-3);
  EXPECT_EQ(unit_factor("m", "m"), 1);
  EXPECT_EQ(unit_factor("µs", "s"), 1e-6);
  EXPECT_EQ(unit_factor("%", "1"), 1e-2);
  EXPECT_EQ(unit_factor("-", "1"), 1);
  for (const auto &[unit, wanted] :
       {std::pair("mm", "N"), std::pair("Pa", "m"), std::pair("xN", "N"), std::pair("1", "m"),
        std::pair("m", "1")})
    EXPECT_THROW(unit_factor(unit, wanted), core::InputError) << unit;
}

TEST(Table, UsersCurve)
{
  core::write_file("curve.csv", "# from a paper\r\nload; displacement\r\n\"kN\"; mm\r\n\r\n"
                                "1.5; +2e-1\r\n; 3\r\n");
  const Table table = read_csv("curve.csv");
  EXPECT_DOUBLE_EQ(table.column("load", "N")[0], 1.5e3);
  EXPECT_DOUBLE_EQ(table.column("displacement", "m")[0], 2e-4);
  EXPECT_TRUE(std::isnan(table.column("load", "N")[1]));
  EXPECT_NE(refusal([&] { table.column("load", "Pa"); }).find("load"), std::string::npos);
  EXPECT_NE(refusal([&] { table.column("strain", "1"); }).find("strain"), std::string::npos);
}

TEST(Table, RefusesWithFileLineAndReason)
{
  const std::pair<const char *, const char *> cases[] = {
      {"time,load\n0,0\n1,2\n", ":2: the second row must hold the units"},
      {"time,load\ns,N\n0,zero\n", ":3: column 'load': 'zero' is not a number"},
      {"time,load\ns,N\n0\n", ":3: 1 cells where the row of names has 2"},
      {"time,load\ns,N\n0,1,5\n", ":3: 3 cells"},
      {"time,load\n", "a row of names and a row of units"},
      {"", "a row of names and a row of units"}};
  for (const auto &[text, reason] : cases) {
    core::write_file("bad.csv", text);
    const std::string message = refusal([] { read_csv("bad.csv"); });
    EXPECT_NE(message.find("bad.csv"), std::string::npos) << message;
    EXPECT_NE(message.find(reason), std::string::npos) << message;
  }
  EXPECT_THROW(read_csv("not_there.csv"), core::InputError);
}
} // namespace
