#include "src/output/plot.h"

#include "src/output/format.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ligament::program
{
namespace
{
constexpr int left_margin = 70, right_margin = 18, bottom_margin = 48;

/// Distinguishable also without colour vision and in print.
constexpr std::array<const char *, 10> colors = {"#1b6ca8", "#d1495b", "#2e8b57", "#e08e0b",
                                                 "#6a4c93", "#117a8b", "#8c564b", "#c2185b",
                                                 "#7a8b0b", "#555555"};

/// One axis: from values to [0, 1], with the prefix of its unit.
class Scale
{
public:
  Scale(const PlotAxis &axis, double lower, double upper) : axis_(axis)
  {
    if (axis.logarithmic) {
      lower_ = std::floor(std::log10(lower) + 1e-9);
      upper_ = std::max(std::ceil(std::log10(upper) - 1e-9), lower_ + 1);
      return;
    }
    const bool plain = axis.unit.empty() || axis.unit == "1" ||
                       axis.unit.find_first_of("^*/ ") != std::string::npos;
    if (!plain)
      prefix_ = si_prefix(std::max(std::abs(lower), std::abs(upper)));
    lower_ = lower / prefix_.factor;
    upper_ = upper / prefix_.factor;
    if (!(upper_ - lower_ > 1e-9 * std::max(std::abs(lower_), std::abs(upper_)))) {
      const double half = lower_ == 0 ? 1 : 0.1 * std::abs(lower_);
      lower_ -= half;
      upper_ += half;
    }
  }

  double operator()(double value) const
  {
    const double scaled = axis_.logarithmic ? std::log10(value) : value / prefix_.factor;
    return (scaled - lower_) / (upper_ - lower_);
  }
  bool shows(double value) const
  {
    return std::isfinite(value) && (!axis_.logarithmic || value > 0);
  }

  struct Tick
  {
    double place; // in [0, 1]
    std::string text;
  };
  std::vector<Tick> ticks(int n) const
  {
    std::vector<Tick> result;
    const auto place = [&](double t) { return (t - lower_) / (upper_ - lower_); };
    if (axis_.logarithmic)
      for (double t = lower_; t <= upper_; ++t)
        result.push_back({place(t), fmt::format("1e{:.0f}", t)});
    else {
      const auto values = nice_ticks(lower_, upper_, n);
      for (const double t : values)
        result.push_back({place(t), tick_text(t, values[1] - values[0])});
    }
    return result;
  }

  std::string title() const
  {
    if (axis_.unit.empty() || axis_.unit == "1")
      return axis_.label;
    return fmt::format("{} ({}{})", axis_.label, prefix_.symbol, axis_.unit);
  }

private:
  PlotAxis axis_;
  Prefix prefix_{1, ""};
  double lower_, upper_; // scaled by the prefix, or powers of ten
};

Scale scale_of(const Plot &plot, const PlotAxis &axis, std::vector<double> Series::*values,
               double headroom)
{
  double lower = HUGE_VAL, upper = -HUGE_VAL;
  for (const auto &series : plot.series)
    for (const double value : series.*values)
      if (std::isfinite(value) && (!axis.logarithmic || value > 0)) {
        lower = std::min(lower, value);
        upper = std::max(upper, value);
      }
  if (!(lower <= upper))
    return {axis, axis.logarithmic ? 1. : 0., axis.logarithmic ? 10. : 1.};
  const double extra = axis.logarithmic ? 0 : headroom * (upper - lower);
  return {axis, lower < 0 ? lower - extra : lower, upper > 0 ? upper + extra : upper};
}

struct Frame
{
  double left, top, width, height;
};

/// Path of a curve: what falls into the same half pixel column is drawn as its extremes, and no
/// way twice, or dashes would fill each other's gaps.
std::string path(const Series &series, const Scale &x, const Scale &y, const Frame &frame)
{
  std::string text;
  bool connected = false;
  double column = -1, low = 0, high = 0, first_y = 0, last_y = 0, y_now = 0;
  const auto put = [&](double px, double py) {
    text += fmt::format("{}{:.1f} {:.1f}", connected ? "L" : "M", px, py);
    connected = true;
    y_now = py;
  };
  const auto finish_column = [&] {
    if (column >= 0) {
      if (std::min(first_y, last_y) > low)
        put(column, low);
      if (std::max(first_y, last_y) < high)
        put(column, high);
      if (last_y != y_now)
        put(column, last_y);
    }
    column = -1;
  };
  for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
    if (!x.shows(series.x[i]) || !y.shows(series.y[i])) {
      finish_column();
      connected = false;
      continue;
    }
    const double px = frame.left + frame.width * x(series.x[i]);
    const double py = frame.top + frame.height * (1 - y(series.y[i]));
    if (column >= 0 && std::abs(px - column) < 0.5) {
      low = std::min(low, py);
      high = std::max(high, py);
    } else {
      finish_column();
      put(px, py);
      column = px;
      low = high = first_y = py;
    }
    last_y = py;
  }
  finish_column();
  return text;
}

std::string axes(const Plot &plot, const Scale &x, const Scale &y, const Frame &f)
{
  std::string text;
  for (const auto &tick : x.ticks(std::max(3, plot.width / 100))) {
    const double px = f.left + f.width * tick.place;
    text +=
        fmt::format("<path class=\"grid\" d=\"M{0:.1f} {1}V{2}\"/><text x=\"{0:.1f}\" y=\"{3}\" "
                    "text-anchor=\"middle\">{4}</text>\n",
                    px, f.top, f.top + f.height, f.top + f.height + 16, tick.text);
  }
  for (const auto &tick : y.ticks(std::max(3, plot.height / 60))) {
    const double py = f.top + f.height * (1 - tick.place);
    text +=
        fmt::format("<path class=\"grid\" d=\"M{1} {0:.1f}H{2}\"/><text x=\"{3}\" y=\"{4:.1f}\" "
                    "text-anchor=\"end\">{5}</text>\n",
                    py, f.left, f.left + f.width, f.left - 6, py + 4, tick.text);
  }
  text += fmt::format("<rect class=\"frame\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n",
                      f.left, f.top, f.width, f.height);
  text += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n",
                      f.left + f.width / 2, plot.height - 10, escape_xml(x.title()));
  text += fmt::format("<text transform=\"translate(16 {}) rotate(-90)\" "
                      "text-anchor=\"middle\">{}</text>\n",
                      f.top + f.height / 2, escape_xml(y.title()));
  if (!plot.title.empty())
    text += fmt::format("<text class=\"title\" x=\"{}\" y=\"20\">{}</text>\n", f.left,
                        escape_xml(plot.title));
  return text;
}

std::string marker(const Series &series, const char *color, double px, double py)
{
  const std::string look =
      series.hollow ? fmt::format("r=\"5\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"", color)
                    : fmt::format("r=\"3.5\" fill=\"{}\"", color);
  return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" {}/>\n", px, py, look);
}

/// Text beside a point, on the side where there is room.
std::string note(const std::string &text, const char *color, double px, double py,
                 const Frame &frame)
{
  const bool to_the_left = px + 7. * double(text.size()) + 12 > frame.left + frame.width;
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"11\" fill=\"{}\"{}>{}</text>\n",
                     px + (to_the_left ? -8 : 8), py + 4, color,
                     to_the_left ? " text-anchor=\"end\"" : "", escape_xml(text));
}

std::string curve(const Series &series, const char *color, const Scale &x, const Scale &y,
                  const Frame &frame)
{
  std::string text;
  if (series.line)
    text +=
        fmt::format("<path class=\"curve\" stroke=\"{}\"{} d=\"{}\"/>\n", color,
                    series.dashed ? " stroke-dasharray=\"7 4\"" : "", path(series, x, y, frame));
  for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
    if (!x.shows(series.x[i]) || !y.shows(series.y[i]))
      continue;
    const double px = frame.left + frame.width * x(series.x[i]);
    const double py = frame.top + frame.height * (1 - y(series.y[i]));
    if (series.markers)
      text += marker(series, color, px, py);
    if (i < series.notes.size() && !series.notes[i].empty())
      text += note(series.notes[i], color, px, py, frame);
  }
  return text;
}
} // namespace

std::vector<double> nice_ticks(double lower, double upper, int n)
{
  const double raw = (upper - lower) / std::max(n, 1);
  const double power = std::pow(10, std::floor(std::log10(raw)));
  const double lead = raw / power;
  const double step = power * (lead <= 1.0001 ? 1 : lead <= 2.0001 ? 2 : lead <= 5.0001 ? 5 : 10);
  std::vector<double> ticks;
  const double slack = 1e-6;
  for (double k = std::ceil(lower / step - slack); k * step <= upper + slack * step; ++k)
    ticks.push_back(k == 0 ? 0 : k * step);
  if (ticks.size() == 1)
    ticks.push_back(ticks[0] + step);
  return ticks;
}

std::string tick_text(double tick, double distance)
{
  const double magnitude = std::max(std::abs(tick), distance);
  if (magnitude >= 1e5 || magnitude < 1e-3)
    return fmt::format("{:.3g}", tick);
  const int decimals = std::max(0, int(std::ceil(-std::log10(distance) - 1e-6)));
  return fmt::format("{:.{}f}", tick, decimals);
}

std::string svg(const Plot &plot)
{
  const Scale x = scale_of(plot, plot.x, &Series::x, 0);
  const Scale y = scale_of(plot, plot.y, &Series::y, 0.06);
  // The legend stands above the frame in rows, so that it never covers a curve.
  int rows = 0, column = 0;
  std::string legend;
  const int top = plot.title.empty() ? 8 : 30;
  if (plot.series.size() > 1) {
    rows = 1;
    for (std::size_t s = 0; s < plot.series.size(); ++s) {
      const int width = 40 + int(7 * plot.series[s].label.size());
      if (column > 0 && left_margin + column + width > plot.width - right_margin) {
        ++rows;
        column = 0;
      }
      const int px = left_margin + column, py = top + 16 * rows - 4;
      if (!plot.series[s].line)
        legend += marker(plot.series[s], colors[s % colors.size()], px + 11, py - 4);
      else
        legend += fmt::format("<path class=\"curve\" stroke=\"{}\"{} d=\"M{} {}h22\"/>",
                              colors[s % colors.size()],
                              plot.series[s].dashed ? " stroke-dasharray=\"7 4\"" : "", px, py - 4);
      legend += fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", px + 27, py,
                            escape_xml(plot.series[s].label));
      column += width;
    }
  }
  const double frame_top = top + 16 * rows + 4;
  const Frame frame{left_margin, frame_top, double(plot.width - left_margin - right_margin),
                    plot.height - frame_top - bottom_margin};

  std::string text =
      fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
                  "height=\"{1}\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#222\">\n"
                  "<style>.grid{{stroke:#e3e6ea;fill:none}}.frame{{stroke:#555;fill:none}}"
                  ".curve{{fill:none;stroke-width:1.8;stroke-linejoin:round}}"
                  ".title{{font-size:14px;font-weight:bold}}</style>\n"
                  "<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
                  plot.width, plot.height);
  text += axes(plot, x, y, frame);
  for (std::size_t s = 0; s < plot.series.size(); ++s)
    text += curve(plot.series[s], colors[s % colors.size()], x, y, frame);
  return text + legend + "</svg>\n";
}
} // namespace ligament::program
