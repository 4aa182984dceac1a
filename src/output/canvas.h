// A raster that knows discs, lines, triangles and text, with smooth edges and optional depth.
#pragma once

#include "src/output/color.h"

#include <array>
#include <string>
#include <vector>

namespace ligament::program
{
/// Colours of a value t in [0, 1].
using Palette = std::array<Color, 256>;
Palette colormap_palette();
Palette flat_palette(Color color);

/// Coordinates in pixels, x to the right, y downwards; z towards the viewer. Drawn at twice the
/// resolution and averaged in the end.
class Canvas
{
public:
  /// With depth, nearer items hide farther ones; otherwise later ones hide earlier ones.
  Canvas(int width, int height, bool depth);

  struct Vertex
  {
    double x, y, z, t;
  };

  /// shade: factor on the colour.
  void triangle(const std::array<Vertex, 3> &corners, const Palette &palette, double shade = 1);
  /// A disc; with depth a sphere lit from the upper left in front.
  void disc(const Vertex &centre, double radius, const Palette &palette);

  struct Pen
  {
    Color color;
    double width; // pixels
    double opacity = 1;
    double hidden = 1; // opacity where something lies in front of it
  };
  void line(const Vertex &a, const Vertex &b, const Pen &pen);
  void dashed_line(const Vertex &a, const Vertex &b, const Pen &pen);
  void fill_rectangle(double x0, double y0, double x1, double y1, Color color);

  enum class Align
  {
    left,
    centre,
    right
  };
  /// Base line of the text at y; height of capitals in pixels.
  void text(double x, double y, const std::string &text, double height, Color color,
            Align align = Align::left);

  /// The picture as a PNG file in memory.
  std::string png() const;

private:
  void blend(int pixel, Color color, double opacity);

  int width_, height_; // of the fine raster
  std::vector<Color> pixels_;
  std::vector<float> depth_;
};
} // namespace ligament::program
