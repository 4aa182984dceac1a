#include "src/drawing/plot.h"

#include "src/output/format.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ligament::program
{
namespace
{
constexpr double right_margin = 18, bottom_margin = 48; // pixels
constexpr double text_size = 12, legend_row = 18, marker_radius = 3.5;

const Drawing::Font text_font = {text_size};

/// Distinguishable also without colour vision and in print.
constexpr std::array<Color, 10> colors = {{{27, 108, 168},
                                           {209, 73, 91},
                                           {46, 139, 87},
                                           {224, 142, 11},
                                           {106, 76, 147},
                                           {17, 122, 139},
                                           {140, 86, 75},
                                           {194, 24, 91},
                                           {122, 139, 11},
                                           {85, 85, 85}}};
constexpr Color grid_color = {227, 230, 234}, frame_color = {85, 85, 85};

/// 10 with the exponent as superscript.
std::string power_of_ten(int exponent)
{
  static constexpr const char *digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "10⁻" : "10";
  for (const char c : std::to_string(std::abs(exponent)))
    text += digits[c - '0'];
  return text;
}

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
    prefix_ = unit_prefix(std::max(std::abs(lower), std::abs(upper)), axis.unit);
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
        result.push_back({place(t), power_of_ten(int(t))});
    else {
      const auto values = nice_ticks(lower_, upper_, n);
      for (const double t : values)
        result.push_back({place(t), tick_text(t, values[1] - values[0])});
    }
    return result;
  }

  /// Of 2, 3, ... 9 times the powers of ten.
  std::vector<double> fine_ticks() const
  {
    std::vector<double> places;
    if (axis_.logarithmic && upper_ - lower_ <= 6)
      for (double t = lower_; t < upper_; ++t)
        for (int k = 2; k < 10; ++k)
          places.push_back((t + std::log10(k) - lower_) / (upper_ - lower_));
    return places;
  }

  std::string title() const { return with_unit(axis_.label, prefix_, axis_.unit); }

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

/// Lines of a curve: what falls into the same half pixel column is drawn as its extremes, and no
/// way twice, or dashes would fill each other's gaps.
class CurveLines
{
public:
  void add(const Spot &at)
  {
    if (column_ >= 0 && std::abs(at[0] - column_) < 0.5) {
      low_ = std::min(low_, at[1]);
      high_ = std::max(high_, at[1]);
    } else {
      finish_column();
      put(at[0], at[1]);
      column_ = at[0];
      low_ = high_ = first_ = at[1];
    }
    last_ = at[1];
  }

  /// The next point starts a new line.
  void interrupt()
  {
    finish_column();
    connected_ = false;
  }

  std::vector<std::vector<Spot>> lines()
  {
    finish_column();
    return std::move(lines_);
  }

private:
  void put(double x, double y)
  {
    if (!connected_)
      lines_.emplace_back();
    lines_.back().push_back({x, y});
    connected_ = true;
  }

  void finish_column()
  {
    if (column_ >= 0) {
      if (std::min(first_, last_) > low_)
        put(column_, low_);
      if (std::max(first_, last_) < high_)
        put(column_, high_);
      if (last_ != lines_.back().back()[1])
        put(column_, last_);
    }
    column_ = -1;
  }

  std::vector<std::vector<Spot>> lines_;
  bool connected_ = false;
  double column_ = -1, low_ = 0, high_ = 0, first_ = 0, last_ = 0;
};

/// The legend stands above the frame in rows, so that it never covers a curve.
struct LegendPlace
{
  std::size_t series;
  Spot at; // left end of the mark
};

class PlotPainter
{
public:
  PlotPainter(const Plot &plot, ImageFormat format)
      : plot_(plot), x_(scale_of(plot, plot.x, &Series::x, 0)),
        y_(scale_of(plot, plot.y, &Series::y, 0.06)), drawing_(plot.width, plot.height, format)
  {
    double widest = 0;
    for (const auto &tick : y_ticks())
      widest = std::max(widest, Drawing::text_width(tick.text, text_font));
    frame_.left = std::max(48., widest + 34);
    frame_.width = plot.width - frame_.left - right_margin;
    frame_.top = place_legend() + 10;
    frame_.height = plot.height - frame_.top - bottom_margin;
  }

  std::string paint()
  {
    grid();
    for (std::size_t s = 0; s < plot_.series.size(); ++s)
      curve(plot_.series[s], color(s));
    drawing_.outline({{frame_.left, frame_.top},
                      {frame_.left + frame_.width, frame_.top},
                      {frame_.left + frame_.width, frame_.top + frame_.height},
                      {frame_.left, frame_.top + frame_.height}},
                     {frame_color, 1});
    titles();
    for (const auto &place : legend_)
      legend_entry(place);
    return drawing_.file();
  }

private:
  static Color color(std::size_t series) { return colors[series % colors.size()]; }

  std::vector<Scale::Tick> x_ticks() const { return x_.ticks(std::max(3, plot_.width / 100)); }
  std::vector<Scale::Tick> y_ticks() const { return y_.ticks(std::max(3, plot_.height / 60)); }

  /// The lower end of title and legend.
  double place_legend()
  {
    double y = plot_.title.empty() ? 6 : 28, x = frame_.left;
    if (plot_.series.size() < 2)
      return y;
    for (std::size_t s = 0; s < plot_.series.size(); ++s) {
      const double width = 46 + Drawing::text_width(plot_.series[s].label, text_font);
      if (x > frame_.left && x + width > plot_.width - right_margin + 18) {
        y += legend_row;
        x = frame_.left;
      }
      legend_.push_back({s, {x, y + 0.5 * legend_row}});
      x += width;
    }
    return y + legend_row;
  }

  void legend_entry(const LegendPlace &place)
  {
    const Series &series = plot_.series[place.series];
    if (series.line)
      drawing_.line(place.at, {place.at[0] + 22, place.at[1]}, pen(series, color(place.series)));
    if (series.markers)
      marker(series, color(place.series), {place.at[0] + 11, place.at[1]});
    drawing_.text({place.at[0] + 27, place.at[1] + 0.36 * text_size}, series.label, text_font);
  }

  void grid()
  {
    std::vector<std::vector<Spot>> lines, fine;
    const auto upright = [&](double place) {
      const double x = frame_.left + frame_.width * place;
      return std::vector<Spot>{{x, frame_.top}, {x, frame_.top + frame_.height}};
    };
    const auto level = [&](double place) {
      const double y = frame_.top + frame_.height * (1 - place);
      return std::vector<Spot>{{frame_.left, y}, {frame_.left + frame_.width, y}};
    };
    for (const auto &tick : x_ticks()) {
      lines.push_back(upright(tick.place));
      drawing_.text({lines.back()[1][0], frame_.top + frame_.height + 17}, tick.text,
                    {text_size, ink, Drawing::Align::centre});
    }
    for (const auto &tick : y_ticks()) {
      lines.push_back(level(tick.place));
      drawing_.text({frame_.left - 7, lines.back()[0][1] + 0.36 * text_size}, tick.text,
                    {text_size, ink, Drawing::Align::right});
    }
    for (const double place : x_.fine_ticks())
      fine.push_back(upright(place));
    for (const double place : y_.fine_ticks())
      fine.push_back(level(place));
    drawing_.lines(fine, {grid_color, 0.5});
    drawing_.lines(lines, {grid_color, 1});
  }

  void titles()
  {
    drawing_.text({frame_.left + frame_.width / 2, plot_.height - 11.}, x_.title(),
                  {text_size, ink, Drawing::Align::centre});
    drawing_.text({16, frame_.top + frame_.height / 2}, y_.title(),
                  {text_size, ink, Drawing::Align::centre, false, true});
    if (!plot_.title.empty())
      drawing_.text({frame_.left, 20}, plot_.title, {14, ink, Drawing::Align::left, true});
  }

  static Drawing::Pen pen(const Series &series, Color color)
  {
    return {color, 1.8, 1, series.dashed};
  }

  void marker(const Series &series, Color color, const Spot &at)
  {
    if (series.hollow)
      drawing_.ring(at, 5, {color, 2});
    else
      drawing_.disc(at, marker_radius, color);
  }

  /// Text beside a point, on the side where there is room.
  void note(const std::string &text, Color color, const Spot &at)
  {
    Drawing::Font font = {11, color};
    const bool to_the_left =
        at[0] + 10 + Drawing::text_width(text, font) > frame_.left + frame_.width;
    font.align = to_the_left ? Drawing::Align::right : Drawing::Align::left;
    drawing_.text({at[0] + (to_the_left ? -8 : 8), at[1] + 4}, text, font);
  }

  void curve(const Series &series, Color color)
  {
    CurveLines curve;
    std::vector<std::size_t> shown;
    const auto spot = [&](std::size_t i) {
      return Spot{frame_.left + frame_.width * x_(series.x[i]),
                  frame_.top + frame_.height * (1 - y_(series.y[i]))};
    };
    for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i)
      if (x_.shows(series.x[i]) && y_.shows(series.y[i])) {
        shown.push_back(i);
        curve.add(spot(i));
      } else
        curve.interrupt();
    if (series.line)
      drawing_.lines(curve.lines(), pen(series, color));
    for (const std::size_t i : shown) {
      if (series.markers)
        marker(series, color, spot(i));
      if (i < series.notes.size() && !series.notes[i].empty())
        note(series.notes[i], color, spot(i));
    }
  }

  const Plot &plot_;
  Scale x_, y_;
  Drawing drawing_;
  Frame frame_ = {};
  std::vector<LegendPlace> legend_;
};
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

std::string draw_plot(const Plot &plot, ImageFormat format)
{
  return PlotPainter(plot, format).paint();
}
} // namespace ligament::program
