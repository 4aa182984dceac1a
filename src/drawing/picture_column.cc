#include "src/drawing/picture_column.h"

#include "src/drawing/colormap.h"
#include "src/drawing/plot.h"

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
// Pixels.
constexpr double text_size = PictureColumn::text_size, line_height = PictureColumn::line_height;
constexpr double bar_width = 20, longest_bar = 420, shortest_bar = 150;
constexpr double mark_width = 26, mark_gap = 10;

const Drawing::Font text_font = {text_size};

double bar_length(double body)
{
  return std::clamp(body - 3 * line_height, shortest_bar, longest_bar);
}

bool has_values(const Picture &picture)
{
  const auto colored = [](const auto &layer) { return !layer.values.empty(); };
  return std::any_of(picture.quads.begin(), picture.quads.end(), colored) ||
         std::any_of(picture.scatters.begin(), picture.scatters.end(), colored);
}

void mark(Drawing &drawing, const LegendEntry &entry, double x, double y)
{
  using Mark = LegendEntry::Mark;
  const double middle = y + 0.64 * text_size;
  const Spot left = {x, middle}, right = {x + mark_width, middle};
  if (entry.mark == Mark::patch)
    drawing.rectangle(x, middle - 7, x + mark_width, middle + 7, entry.color);
  else if (entry.mark == Mark::arrow)
    drawing.arrow(left, right, {entry.color, 2.5});
  else
    drawing.line(left, right, {entry.color, 3, 1, entry.mark == Mark::dashes});
}
} // namespace

PictureColumn::PictureColumn(const Picture &picture, const ValueRange &range)
    : picture_(picture), range_(range)
{
  const double largest = std::max(std::abs(range[0]), std::abs(range[1]));
  prefix_ = unit_prefix(largest, picture.value_unit);
  title_ = with_unit(picture.value_label, prefix_, picture.value_unit);
  has_bar_ = !picture.value_label.empty() && has_values(picture);
  if (has_bar_)
    width_ = std::max(bar_width + 90, Drawing::text_width(title_, text_font));
  for (const auto &entry : picture.legend)
    width_ = std::max(width_, mark_width + mark_gap + Drawing::text_width(entry.text, text_font));
}

double PictureColumn::height(double body) const
{
  return (has_bar_ ? 2 * line_height + bar_length(body) : 0) +
         double(picture_.legend.size()) * line_height;
}

void PictureColumn::draw(Drawing &drawing, double x, double y, double body) const
{
  if (has_bar_) {
    drawing.text({x, y + text_size}, title_, text_font);
    bar(drawing, x, y + 1.6 * line_height, bar_length(body));
    y += 2.4 * line_height + bar_length(body);
  }
  for (const auto &entry : picture_.legend) {
    mark(drawing, entry, x, y);
    drawing.text({x + mark_width + mark_gap, y + text_size}, entry.text, text_font);
    y += line_height;
  }
}

void PictureColumn::bar(Drawing &drawing, double x, double top, double length) const
{
  constexpr int n = 256;
  const Palette colors = colormap_palette();
  // Each colour reaches down to the end: no seams between them.
  for (int i = n - 1; i >= 0; --i)
    drawing.rectangle(x, top + length * (n - 1 - i) / n, x + bar_width, top + length, colors[i]);
  const auto [below, above] = outside();
  const double tip = 0.6 * bar_width, middle = x + bar_width / 2;
  if (above)
    drawing.polygon({{x, top}, {middle, top - tip}, {x + bar_width, top}}, colors[n - 1]);
  if (below)
    drawing.polygon(
        {{x, top + length}, {middle, top + length + tip}, {x + bar_width, top + length}},
        colors[0]);
  const double lower = range_[0] / prefix_.factor, upper = range_[1] / prefix_.factor;
  const auto ticks = nice_ticks(lower, upper, 5);
  for (const double tick : ticks) {
    const double y = top + length * (upper - tick) / (upper - lower);
    if (y < top - 1 || y > top + length + 1)
      continue;
    drawing.line({x + bar_width, y}, {x + bar_width + 6, y}, {ink, 1.5});
    drawing.text({x + bar_width + 11, y + 0.36 * text_size}, tick_text(tick, ticks[1] - ticks[0]),
                 text_font);
  }
}

std::array<bool, 2> PictureColumn::outside() const
{
  std::array<bool, 2> result = {false, false};
  const auto look = [&](const std::vector<double> &values) {
    for (const double value : values) {
      result[0] |= value < range_[0];
      result[1] |= value > range_[1];
    }
  };
  for (const auto &layer : picture_.quads)
    look(layer.values);
  for (const auto &layer : picture_.scatters)
    look(layer.values);
  return result;
}
} // namespace ligament::program
