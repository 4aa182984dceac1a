// Plots: round ticks, curves where they belong, well-formed SVG.
#include "src/drawing/plot.h"

#include "tests/unit/output/xml.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

using namespace ligament;
using namespace ligament::program;

namespace
{
TEST(Plot, TicksAreRoundAndCoverTheRange)
{
  for (const auto &[lower, upper] :
       {std::pair(0., 1.), std::pair(-3.7e-9, 8.1e-9), std::pair(12., 12.7), std::pair(-5e6, 0.)})
  {
    const auto ticks = nice_ticks(lower, upper, 5);
    ASSERT_GE(ticks.size(), 2u);
    const double step = ticks[1] - ticks[0];
    const double lead = step / std::pow(10, std::floor(std::log10(step) + 1e-9));
    EXPECT_LT(std::min({std::abs(lead - 1), std::abs(lead - 2), std::abs(lead - 5)}), 1e-6);
    EXPECT_GE(ticks.front(), lower - 1e-6 * step);
    EXPECT_LE(ticks.back(), upper + 1e-6 * step);
    EXPECT_LT(ticks.front() - lower, step);
    EXPECT_LT(upper - ticks.back(), step);
  }
  EXPECT_EQ(tick_text(0.25, 0.05), "0.25");
  EXPECT_EQ(tick_text(2, 1), "2");
}

/// "M x y L x y ..." as Cairo writes it.
std::vector<std::array<double, 2>> path_points(const tests::Element &path)
{
  std::vector<std::array<double, 2>> points;
  std::istringstream words(path.attributes.at("d"));
  for (std::string command; words >> command;) {
    points.emplace_back();
    words >> points.back()[0] >> points.back()[1];
  }
  return points;
}

/// The first one in the colour of the first series.
tests::Element curve_of(const std::string &text)
{
  for (const auto &element : tests::parse_xml(text))
    if (element.name == "path" &&
        element.attributes.at("style").find("stroke:rgb(10.588235%,42.352941%,65.882353%)") !=
            std::string::npos)
      return element;
  throw std::runtime_error("no curve");
}

TEST(Plot, StraightLineStaysStraight)
{
  Plot plot;
  plot.title = "a < b & c";
  plot.x = {"time", "s", false};
  plot.y = {"stress", "Pa", false};
  Series line{"", {}, {}};
  for (int i = 0; i <= 10; ++i) {
    line.x.push_back(1e-5 * i);
    line.y.push_back(2e6 * i);
  }
  plot.series = {line};
  const std::string text = draw_plot(plot);
  const auto points = path_points(curve_of(text));
  ASSERT_GE(points.size(), 2u); // Cairo leaves out what lies between
  const auto &first = points.front(), &last = points.back();
  const double slope = (last[1] - first[1]) / (last[0] - first[0]);
  EXPECT_GT(last[0], first[0] + plot.width / 2);
  EXPECT_LT(slope, 0);         // y points downwards on the screen
  for (const auto &p : points) // an eighth of a pixel
    EXPECT_NEAR(p[1], first[1] + slope * (p[0] - first[0]), 0.13);
  EXPECT_NE(text.find("stress (MPa)"), std::string::npos);
  EXPECT_NE(text.find("time (µs)"), std::string::npos);
  EXPECT_NE(text.find("a &lt; b &amp; c"), std::string::npos);
  EXPECT_EQ(text, draw_plot(plot)); // nothing in it counts drawings
  EXPECT_EQ(draw_plot(plot, ImageFormat::png).substr(1, 3), "PNG");
}

// A hundred thousand points between two spikes: few points in the file, both spikes kept.
TEST(Plot, LongCurvesKeepTheirExtremes)
{
  Plot plot;
  Series noise{"", {}, {}};
  const int n = 100000;
  for (int i = 0; i < n; ++i) {
    noise.x.push_back(i);
    noise.y.push_back(i == n / 3 ? 1 : i == n / 2 ? -1 : 0);
  }
  plot.series = {noise};
  const auto points = path_points(curve_of(draw_plot(plot)));
  EXPECT_LT(points.size(), std::size_t(10 * plot.width));
  double top = HUGE_VAL, bottom = -HUGE_VAL;
  for (const auto &p : points) {
    top = std::min(top, p[1]);
    bottom = std::max(bottom, p[1]);
  }
  const double zero = points.front()[1];
  EXPECT_NEAR(zero - top, bottom - zero, 0.2);
  EXPECT_GT(zero - top, 0.3 * plot.height);
}

// A line up, two points, is drawn once: a second pass would fill the gaps between its dashes.
TEST(Plot, UprightLinesAreDrawnOnce)
{
  Plot plot;
  plot.series = {{"limit", {1, 1}, {0, 5}, true}, {"", {0, 2}, {0, 5}}};
  const auto points = path_points(curve_of(draw_plot(plot)));
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0][0], points[1][0]);
  EXPECT_GT(points[0][1], points[1][1]);
  plot.series[0] = {"spike", {1, 1, 1}, {0, 5, 0}};
  EXPECT_EQ(path_points(curve_of(draw_plot(plot))).size(), 3u);
}

TEST(Plot, EmptyConstantAndLogarithmicCurves)
{
  Plot plot;
  EXPECT_NO_THROW(tests::parse_xml(draw_plot(plot)));
  plot.series = {{"constant", {0, 1, 2}, {3, 3, 3}}, {"with gaps", {0, NAN, 2}, {NAN, 1, 2}}};
  const std::string text = draw_plot(plot);
  EXPECT_NO_THROW(tests::parse_xml(text));
  EXPECT_EQ(text.find("nan"), std::string::npos);
  plot.x.logarithmic = plot.y.logarithmic = true;
  plot.series = {{"powers", {0, 1e-3, 1e-2, 1e-1}, {1, 1, 100, 10000}}};
  const auto points = path_points(curve_of(draw_plot(plot)));
  ASSERT_EQ(points.size(), 3u); // 0 has no logarithm
  EXPECT_NEAR(points[1][0] - points[0][0], points[2][0] - points[1][0], 0.13);
  EXPECT_NEAR(points[1][1] - points[0][1], points[2][1] - points[1][1], 0.13);
}
} // namespace
