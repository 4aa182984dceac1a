// Curves: axes with round ticks, SI prefixes, a legend; SVG or PNG.
#pragma once

#include "src/drawing/drawing.h"

#include <string>
#include <vector>

namespace ligament::program
{
struct Series
{
  std::string label;
  std::vector<double> x, y; // SI; points that are not finite break the line
  bool dashed = false;
  bool markers = false; // a dot at every point
  bool line = true;
  bool hollow = false;                 // markers are rings
  std::vector<std::string> notes = {}; // text beside a point; may be shorter than x
};

struct PlotAxis
{
  std::string label;
  std::string unit; // "" or "1" for plain numbers; others get an SI prefix that fits
  bool logarithmic = false;
};

struct Plot
{
  std::string title;
  PlotAxis x, y;
  std::vector<Series> series;
  int width = 720, height = 400; // pixels
};

/// A complete <svg> element, or a PNG file.
std::string draw_plot(const Plot &plot, ImageFormat format = ImageFormat::svg);

/// Round values that divide [lower, upper] into about n parts: multiples of 1, 2 or 5 times a power
/// of ten.
std::vector<double> nice_ticks(double lower, double upper, int n);

/// A tick with as many decimals as the distance to its neighbours needs.
std::string tick_text(double tick, double distance);
} // namespace ligament::program
