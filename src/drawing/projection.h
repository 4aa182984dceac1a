// From places of a body to pixels of its picture: orthographic, straight on in 2D.
#pragma once

#include "src/drawing/depth_raster.h"
#include "src/drawing/picture.h"

namespace ligament::program
{
class Projection
{
public:
  /// The body of the picture as large as `width` x `height` pixels allow; its upper left corner is
  /// pixel (0, 0).
  Projection(const Picture &picture, double width, double height);

  /// x, y, z of a place in m; t is passed on.
  DepthRaster::Vertex operator()(const double *x, double t = 0) const;
  /// The same for a direction, of length 1 in space.
  Spot direction(const double *x) const;

  double pixels_per_metre() const { return pixels_per_metre_; }
  /// Size of the body in pixels.
  double width() const { return (upper_[0] - lower_[0]) * pixels_per_metre_; }
  double height() const { return (upper_[1] - lower_[1]) * pixels_per_metre_; }

private:
  using Axis = std::array<double, 3>;
  void include(const double *x, double radius);

  Axis right_ = {1, 0, 0}, up_ = {0, 1, 0}, towards_ = {0, 0, 1};
  Spot lower_, upper_; // m, of the projected body
  double pixels_per_metre_;
};
} // namespace ligament::program
