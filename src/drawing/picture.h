// Pictures of bodies without a display: particles, cells, lines and arrows with a legend.
#pragma once

#include "src/drawing/color.h"
#include "src/drawing/drawing.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace ligament::program
{
/// Particles drawn as their cells (2D) or as shaded spheres (3D). x, y, z per particle.
struct Scatter
{
  std::vector<double> positions; // m
  std::vector<double> radii;     // m, one per particle
  std::vector<double> values;    // one per particle; empty: all in `color`
  Color color = {120, 140, 160};
};

/// Quadrilaterals with corners in ring order; x, y, z per corner.
struct Quads
{
  std::vector<double> points;        // m
  std::vector<std::int64_t> corners; // 4 per quadrilateral
  std::vector<double> values;        // one per point, interpolated; empty: all in `color`
  Color color = {210, 216, 224};
  Color edge_color = {255, 255, 255};
};

/// Straight lines on top of everything; 3D: hidden parts shine through.
struct Segments
{
  std::vector<double> points; // m, two ends of x, y, z per segment
  Color color = {220, 20, 60};
  double width = 2; // pixels
  bool dashed = false;
};

/// An arrow that starts or ends at a place of the body; its length is in pixels, since it shows a
/// direction only.
struct Arrow
{
  std::array<double, 3> place;     // m
  std::array<double, 3> direction; // its length does not matter
  bool ends_there = false;         // the head is at the place
  Color color = {20, 20, 20};
  double length = 34; // pixels
};

/// A text at a place of the specimen.
struct Label
{
  std::array<double, 3> position; // m
  std::string text;
  Color color = {40, 40, 40};
};

/// What a colour or line means.
struct LegendEntry
{
  enum class Mark
  {
    patch,
    line,
    dashes,
    arrow
  };
  std::string text;
  Color color;
  Mark mark = Mark::patch;
};

using ValueRange = std::array<double, 2>;

struct Picture
{
  int dimension = 2;
  std::vector<Quads> quads; // drawn first in 2D; depth decides in 3D
  std::vector<Scatter> scatters;
  std::vector<Segments> segments; // drawn last
  std::vector<Arrow> arrows;
  std::vector<Label> labels;

  std::string title;
  std::string value_label; // beside the colour bar; empty: no bar
  std::string value_unit;
  /// Colour range; empty: value_range() of this picture. What lies outside has the outermost
  /// colour, and the bar has a tip.
  std::optional<ValueRange> range;
  std::vector<LegendEntry> legend;
  std::vector<std::string> notes; // lines below the picture
  int width = 1400;               // pixels at most for the body; the height follows from its shape
  /// 3D: direction from which the specimen is seen.
  std::array<double, 3> view = {0.5, 0.35, 1};
};

/// From the 1 % to the 99 % quantile of all values of these pictures: a few hot particles at a
/// crack tip must not turn all others dark.
ValueRange value_range(const std::vector<Picture> &pictures);

std::string draw_picture(const Picture &picture, ImageFormat format = ImageFormat::png);

/// PNG; EnvironmentError when the disk refuses.
void write_picture(const std::string &path, const Picture &picture);
} // namespace ligament::program
