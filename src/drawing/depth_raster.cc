#include "src/drawing/depth_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ligament::program
{
namespace
{
constexpr float nothing = -std::numeric_limits<float>::infinity();

/// Smaller particles are not shaded: nobody would see more than a darker colour.
constexpr double smallest_shaded = 5; // fine pixels

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

DepthRaster::DepthRaster(int width, int height)
    : width_(fine * width), height_(fine * height),
      colors_(std::size_t(width_) * height_, Color{255, 255, 255}), depth_(colors_.size(), nothing)
{
}

void DepthRaster::put(int pixel, float z, Color color, double shade)
{
  if (z <= depth_[pixel])
    return;
  depth_[pixel] = z;
  colors_[pixel] = shade == 1 ? color : shaded(color, shade);
}

void DepthRaster::triangle(const std::array<Vertex, 3> &corners, const Palette &palette,
                           double shade)
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
      if (b0 >= hair && b1 >= hair && b2 >= hair)
        put(y * width_ + x, float(b0 * v[0].z + b1 * v[1].z + b2 * v[2].z),
            pick(palette, b0 * v[0].t + b1 * v[1].t + b2 * v[2].t), shade);
    }
}

template <typename Visit>
void DepthRaster::for_each_in_disc(double x, double y, double radius, Visit &&visit)
{
  const Range xs(x - radius - 1, x + radius, width_), ys(y - radius - 1, y + radius, height_);
  for (int row = ys.begin; row < ys.end; ++row)
    for (int column = xs.begin; column < xs.end; ++column) {
      const double dx = column + 0.5 - x, dy = row + 0.5 - y, d2 = dx * dx + dy * dy;
      if (d2 < radius * radius)
        visit(row * width_ + column, dx, dy, d2);
    }
}

void DepthRaster::sphere(const Vertex &centre, double radius, const Palette &palette)
{
  const double r = fine * radius;
  const Color color = pick(palette, centre.t);
  for_each_in_disc(
      fine * centre.x, fine * centre.y, r, [&](int pixel, double dx, double dy, double d2) {
        const double height = std::sqrt(r * r - d2);
        const double light = (-0.4 * dx - 0.5 * dy + 0.77 * height) / r;
        put(pixel, float(centre.z + height / fine), color, 0.62 + 0.42 * std::max(light, 0.));
      });
}

void DepthRaster::cell(const Vertex &centre, double radius, double reach, const Palette &palette)
{
  const double r2 = fine * fine * radius * radius;
  const Color color = pick(palette, centre.t);
  const double darker = fine * radius < smallest_shaded ? 0 : 0.3;
  for_each_in_disc(fine * centre.x, fine * centre.y, fine * reach,
                   [&](int pixel, double, double, double d2) {
                     const double rim = std::clamp(d2 / r2 - 0.5, 0., 0.5);
                     put(pixel, float(r2 - d2), color, 1 - darker * rim);
                   });
}

bool DepthRaster::hides(double x, double y, double z) const
{
  const int column = int(std::floor(fine * x)), row = int(std::floor(fine * y));
  if (column < 0 || row < 0 || column >= width_ || row >= height_)
    return false;
  return depth_[std::size_t(row) * width_ + column] > z;
}

std::vector<std::uint32_t> DepthRaster::pixels() const
{
  std::vector<std::uint32_t> result(std::size_t(width()) * height());
  for (int y = 0; y < height(); ++y)
    for (int x = 0; x < width(); ++x) {
      std::uint32_t sum[4] = {};
      for (int k = 0; k < fine * fine; ++k) {
        const std::size_t i = std::size_t(fine * y + k / fine) * width_ + fine * x + k % fine;
        if (depth_[i] == nothing)
          continue;
        sum[0] += colors_[i].b;
        sum[1] += colors_[i].g;
        sum[2] += colors_[i].r;
        sum[3] += 255;
      }
      for (int c = 0; c < 4; ++c)
        result[std::size_t(y) * width() + x] |= (sum[c] + fine * fine / 2) / (fine * fine)
                                                << (8 * c);
    }
  return result;
}
} // namespace ligament::program
