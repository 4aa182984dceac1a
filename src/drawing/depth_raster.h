// What lies in front: faces, spheres and cells of particles with a depth per pixel, which a page of
// lines and text does not know.
#pragma once

#include "src/drawing/color.h"

#include <array>
#include <cstdint>
#include <vector>

namespace ligament::program
{
/// Coordinates in pixels, x to the right, y downwards, z towards the viewer; t in [0, 1] picks the
/// colour. Drawn at twice the resolution and averaged in the end.
class DepthRaster
{
public:
  DepthRaster(int width, int height);

  struct Vertex
  {
    double x, y, z, t;
  };

  /// shade: factor on the colour.
  void triangle(const std::array<Vertex, 3> &corners, const Palette &palette, double shade = 1);
  /// Lit from the upper left in front.
  void sphere(const Vertex &centre, double radius, const Palette &palette);
  /// A particle of a plane packing: nearer than others where its power distance is the smallest,
  /// which gives it its Laguerre cell as far as `reach` from its centre. z of the centre is not
  /// used: cells lie in front of everything with z below -1e9.
  void cell(const Vertex &centre, double radius, double reach, const Palette &palette);

  /// True where something lies in front of this place.
  bool hides(double x, double y, double z) const;

  /// Rows of premultiplied 0xAARRGGBB, transparent where nothing is.
  std::vector<std::uint32_t> pixels() const;
  int width() const { return width_ / fine; }
  int height() const { return height_ / fine; }

private:
  /// Fine pixels per pixel, in both directions.
  static constexpr int fine = 2;

  /// visit(pixel, dx, dy, squared distance) for the fine pixels of a disc.
  template <typename Visit>
  void for_each_in_disc(double x, double y, double radius, Visit &&visit);
  /// Puts the colour there if nothing is nearer.
  void put(int pixel, float z, Color color, double shade);

  int width_, height_; // of the fine raster
  std::vector<Color> colors_;
  std::vector<float> depth_; // -infinity: nothing there
};
} // namespace ligament::program
