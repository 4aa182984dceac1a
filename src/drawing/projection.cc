#include "src/drawing/projection.h"

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
using Axis = std::array<double, 3>;

Axis normalized(const Axis &a)
{
  const double length = std::hypot(a[0], a[1], a[2]);
  return {a[0] / length, a[1] / length, a[2] / length};
}

Axis cross(const Axis &a, const Axis &b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const double *a, const Axis &b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
} // namespace

Projection::Projection(const Picture &picture, double width, double height)
    : lower_{HUGE_VAL, HUGE_VAL}, upper_{-HUGE_VAL, -HUGE_VAL}
{
  if (picture.dimension == 3) {
    towards_ = normalized(picture.view);
    const bool from_above = std::abs(towards_[1]) > 0.999;
    right_ = normalized(cross(from_above ? Axis{0, 0, -1} : Axis{0, 1, 0}, towards_));
    up_ = cross(towards_, right_);
  }
  for (const auto &layer : picture.quads)
    for (const std::int64_t corner : layer.corners)
      include(&layer.points[3 * corner], 0);
  for (const auto &layer : picture.scatters)
    for (std::size_t i = 0; i < layer.radii.size(); ++i)
      include(&layer.positions[3 * i], layer.radii[i]);
  for (const auto &layer : picture.segments)
    for (std::size_t i = 0; i + 2 < layer.points.size(); i += 3)
      include(&layer.points[i], 0);
  if (!(lower_[0] <= upper_[0]))
    lower_ = {0, 0}, upper_ = {1, 1};
  const double w = upper_[0] - lower_[0], h = upper_[1] - lower_[1];
  pixels_per_metre_ =
      std::min(width / std::max({w, 1e-12 * h, 1e-300}), height / std::max({h, 1e-12 * w, 1e-300}));
}

void Projection::include(const double *x, double radius)
{
  for (int c = 0; c < 2; ++c) {
    const double place = dot(x, c == 0 ? right_ : up_);
    lower_[c] = std::min(lower_[c], place - radius);
    upper_[c] = std::max(upper_[c], place + radius);
  }
}

DepthRaster::Vertex Projection::operator()(const double *x, double t) const
{
  return {(dot(x, right_) - lower_[0]) * pixels_per_metre_,
          (upper_[1] - dot(x, up_)) * pixels_per_metre_, dot(x, towards_) * pixels_per_metre_, t};
}

Spot Projection::direction(const double *x) const
{
  const double length = std::hypot(x[0], x[1], x[2]);
  return {dot(x, right_) / length, -dot(x, up_) / length};
}
} // namespace ligament::program
