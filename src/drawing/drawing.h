// A page to draw on through Cairo: lines, shapes and text, as PNG or SVG from the same calls.
#pragma once

#include "src/drawing/color.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

struct _cairo; // the types of <cairo/cairo.h>, which only the source includes
struct _cairo_surface;

namespace ligament::program
{
enum class ImageFormat
{
  png,
  svg
};

/// A place on the page in pixels: x to the right, y downwards.
using Spot = std::array<double, 2>;

/// Later calls draw over earlier ones; text is always on top. The same calls give the same bytes.
/// EnvironmentError when Cairo runs out of memory.
class Drawing
{
public:
  Drawing(int width, int height, ImageFormat format);
  Drawing(const Drawing &) = delete;
  Drawing &operator=(const Drawing &) = delete;

  struct Pen
  {
    Color color = ink;
    double width = 1; // pixels
    double opacity = 1;
    bool dashed = false;
  };
  /// Open lines, each through its points.
  void lines(const std::vector<std::vector<Spot>> &lines, const Pen &pen);
  void line(const Spot &a, const Spot &b, const Pen &pen) { lines({{a, b}}, pen); }
  /// A closed outline.
  void outline(const std::vector<Spot> &corners, const Pen &pen);
  void polygon(const std::vector<Spot> &corners, Color color);
  void rectangle(double x0, double y0, double x1, double y1, Color color);
  void disc(const Spot &centre, double radius, Color color);
  void ring(const Spot &centre, double radius, const Pen &pen);
  /// A shaft and a filled head at `to`.
  void arrow(const Spot &from, const Spot &to, const Pen &pen);
  /// Rows of premultiplied 0xAARRGGBB, the upper left corner at (x, y).
  void image(double x, double y, int width, int height, const std::vector<std::uint32_t> &argb);

  enum class Align
  {
    left,
    centre,
    right
  };
  struct Font
  {
    double size = 12; // pixels
    Color color = ink;
    Align align = Align::left;
    bool bold = false;
    bool upright = false; // turned by 90 degrees, read from below
    bool halo = false;    // white behind the letters, for text on top of a picture
  };
  /// UTF-8; the spot lies on the base line.
  void text(const Spot &at, const std::string &text, const Font &font);
  /// Pixels.
  static double text_width(const std::string &text, const Font &font);

  /// The finished file; the last call. SVG: one <svg> element, whose texts remain texts.
  std::string file();

private:
  void set_color(Color color, double opacity);
  void add_path(const std::vector<Spot> &line);
  void outline_path(const std::vector<Spot> &corners);
  void stroke(const Pen &pen);
  Spot snapped(const Spot &at) const;

  ImageFormat format_;
  std::string svg_, svg_texts_; // the surface writes into the first until it goes
  std::unique_ptr<_cairo_surface, void (*)(_cairo_surface *)> surface_;
  std::unique_ptr<_cairo, void (*)(_cairo *)> cairo_;
};
} // namespace ligament::program
