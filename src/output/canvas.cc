#include "src/output/canvas.h"

#include "core/check.h"
#include "src/output/colormap.h"
#include "src/output/stroke_font.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ligament::program
{
namespace
{
/// Fine pixels per pixel, in both directions.
constexpr int fine = 2;

Color shaded(Color c, double shade)
{
  const auto channel = [&](std::uint8_t v) {
    return std::uint8_t(std::clamp(v * shade, 0., 255.));
  };
  return {channel(c.r), channel(c.g), channel(c.b)};
}

const Color &pick(const Palette &palette, double t)
{
  return palette[std::size_t(std::clamp(t, 0., 1.) * 255 + 0.5)];
}

/// Fine pixels whose centres may lie in [lower, upper], cut to the raster.
struct Range
{
  int begin, end;
  Range(double lower, double upper, int size)
      : begin(int(std::clamp(std::floor(lower), 0., double(size)))),
        end(int(std::clamp(std::ceil(upper) + 1, 0., double(size))))
  {
  }
};
} // namespace

Palette colormap_palette()
{
  Palette palette;
  for (std::size_t i = 0; i < palette.size(); ++i)
    palette[i] = colormap(double(i) / double(palette.size() - 1));
  return palette;
}

Palette flat_palette(Color color)
{
  Palette palette;
  palette.fill(color);
  return palette;
}

Canvas::Canvas(int width, int height, bool depth)
    : width_(fine * width), height_(fine * height),
      pixels_(std::size_t(width_) * height_, Color{255, 255, 255}),
      depth_(depth ? pixels_.size() : 0, -std::numeric_limits<float>::infinity())
{
}

void Canvas::blend(int pixel, Color color, double opacity)
{
  Color &p = pixels_[pixel];
  const auto mix = [&](std::uint8_t below, std::uint8_t above) {
    return std::uint8_t(std::lround(below + opacity * (above - below)));
  };
  p = {mix(p.r, color.r), mix(p.g, color.g), mix(p.b, color.b)};
}

void Canvas::triangle(const std::array<Vertex, 3> &corners, const Palette &palette, double shade)
{
  std::array<Vertex, 3> v = corners;
  for (auto &c : v) {
    c.x *= fine;
    c.y *= fine;
  }
  const double area = (v[1].x - v[0].x) * (v[2].y - v[0].y) - (v[2].x - v[0].x) * (v[1].y - v[0].y);
  if (!(std::abs(area) > 0))
    return;
  const Range xs(std::min({v[0].x, v[1].x, v[2].x}) - 1, std::max({v[0].x, v[1].x, v[2].x}),
                 width_);
  const Range ys(std::min({v[0].y, v[1].y, v[2].y}) - 1, std::max({v[0].y, v[1].y, v[2].y}),
                 height_);
  // Neighbours share their edge: a hair of overlap leaves no gap between them.
  constexpr double hair = -1e-9;
  for (int y = ys.begin; y < ys.end; ++y)
    for (int x = xs.begin; x < xs.end; ++x) {
      const double px = x + 0.5, py = y + 0.5;
      const double b1 =
          ((px - v[0].x) * (v[2].y - v[0].y) - (v[2].x - v[0].x) * (py - v[0].y)) / area;
      const double b2 =
          ((v[1].x - v[0].x) * (py - v[0].y) - (px - v[0].x) * (v[1].y - v[0].y)) / area;
      const double b0 = 1 - b1 - b2;
      if (b0 < hair || b1 < hair || b2 < hair)
        continue;
      const int pixel = y * width_ + x;
      if (!depth_.empty()) {
        const float z = float(b0 * v[0].z + b1 * v[1].z + b2 * v[2].z);
        if (z <= depth_[pixel])
          continue;
        depth_[pixel] = z;
      }
      pixels_[pixel] = shaded(pick(palette, b0 * v[0].t + b1 * v[1].t + b2 * v[2].t), shade);
    }
}

void Canvas::disc(const Vertex &centre, double radius, const Palette &palette)
{
  const double cx = fine * centre.x, cy = fine * centre.y, r = fine * radius;
  const Color color = pick(palette, centre.t);
  const Range xs(cx - r - 1, cx + r + 1, width_), ys(cy - r - 1, cy + r + 1, height_);
  for (int y = ys.begin; y < ys.end; ++y)
    for (int x = xs.begin; x < xs.end; ++x) {
      const double dx = x + 0.5 - cx, dy = y + 0.5 - cy, d2 = dx * dx + dy * dy;
      const int pixel = y * width_ + x;
      if (depth_.empty()) {
        const double cover = std::clamp(r - std::sqrt(d2) + 0.5, 0., 1.);
        if (cover > 0)
          blend(pixel, color, cover);
        continue;
      }
      if (d2 >= r * r)
        continue;
      const double height = std::sqrt(r * r - d2);
      const float z = float(centre.z + height / fine);
      if (z <= depth_[pixel])
        continue;
      depth_[pixel] = z;
      const double light = (-0.4 * dx - 0.5 * dy + 0.77 * height) / r;
      pixels_[pixel] = shaded(color, 0.62 + 0.42 * std::max(light, 0.));
    }
}

void Canvas::line(const Vertex &a, const Vertex &b, const Pen &pen)
{
  const double ax = fine * a.x, ay = fine * a.y, bx = fine * b.x, by = fine * b.y;
  const double half = 0.5 * fine * pen.width;
  const double dx = bx - ax, dy = by - ay, length2 = dx * dx + dy * dy;
  // One row at a time, only the columns that the line can touch there.
  const Range ys(std::min(ay, by) - half - 1, std::max(ay, by) + half + 1, height_);
  for (int y = ys.begin; y < ys.end; ++y) {
    double left = std::min(ax, bx), right = std::max(ax, bx);
    if (std::abs(dy) > 1) {
      const double reach = half * std::sqrt(length2) / std::abs(dy) + 1;
      const double x = ax + dx * (y + 0.5 - ay) / dy;
      const double slack = std::abs(dx / dy);
      left = std::max(left, x - reach - slack);
      right = std::min(right, x + reach + slack);
    }
    const Range xs(left - half - 1, right + half + 1, width_);
    for (int x = xs.begin; x < xs.end; ++x) {
      const double px = x + 0.5 - ax, py = y + 0.5 - ay;
      const double s = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0., 1.) : 0;
      const double distance = std::hypot(px - s * dx, py - s * dy);
      double cover = std::clamp(half - distance + 0.5, 0., 1.) * pen.opacity;
      if (cover <= 0)
        continue;
      const int pixel = y * width_ + x;
      if (!depth_.empty() && a.z + s * (b.z - a.z) < depth_[pixel])
        cover *= pen.hidden;
      blend(pixel, pen.color, cover);
    }
  }
}

void Canvas::dashed_line(const Vertex &a, const Vertex &b, const Pen &pen)
{
  const double dash = 7, period = 12; // pixels
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  const auto at = [&](double along) {
    const double s = std::min(along / length, 1.);
    return Vertex{a.x + s * (b.x - a.x), a.y + s * (b.y - a.y), a.z + s * (b.z - a.z), 0};
  };
  for (double begin = 0; begin < length; begin += period)
    line(at(begin), at(begin + dash), pen);
}

void Canvas::fill_rectangle(double x0, double y0, double x1, double y1, Color color)
{
  const int left = std::max(0, int(std::lround(fine * x0)));
  const int right = std::min(width_, int(std::lround(fine * x1)));
  const int top = std::max(0, int(std::lround(fine * y0)));
  const int bottom = std::min(height_, int(std::lround(fine * y1)));
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x)
      pixels_[y * width_ + x] = color;
}

void Canvas::text(double x, double y, const std::string &text, double height, Color color,
                  Align align)
{
  const StrokedText strokes = stroke_text(text);
  if (align != Align::left)
    x -= strokes.width * height * (align == Align::centre ? 0.5 : 1);
  constexpr double front = std::numeric_limits<float>::max();
  const Pen pen{color, std::max(1., 0.13 * height)};
  for (const auto &stroke : strokes.strokes)
    for (std::size_t i = 1; i < stroke.size(); ++i)
      line({x + height * stroke[i - 1][0], y - height * stroke[i - 1][1], front, 0},
           {x + height * stroke[i][0], y - height * stroke[i][1], front, 0}, pen);
}

std::string Canvas::png() const
{
  const int width = width_ / fine, height = height_ / fine;
  std::string rows(std::size_t(width) * height * 3, '\0');
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      int sum[3] = {};
      for (int k = 0; k < fine * fine; ++k) {
        const Color &p = pixels_[(fine * y + k / fine) * width_ + fine * x + k % fine];
        sum[0] += p.r;
        sum[1] += p.g;
        sum[2] += p.b;
      }
      for (int c = 0; c < 3; ++c)
        rows[3 * (std::size_t(y) * width + x) + c] =
            char((sum[c] + fine * fine / 2) / (fine * fine));
    }

  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string file(size, '\0');
  const bool good =
      png_image_write_to_memory(&image, file.data(), &size, 0, rows.data(), 0, nullptr);
  core::require<core::EnvironmentError>(good, std::string("libpng: ") + image.message);
  file.resize(size);
  return file;
}
} // namespace ligament::program
