#include "src/commands/gauge_marks.h"

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
constexpr Color gauge_color = {10, 130, 60};

constexpr double cross_share = 0.012; // of the specimen's longest edge

class GaugeLines
{
public:
  explicit GaugeLines(const Scene &scene) : scene_(scene)
  {
    lines.color = gauge_color;
    lines.width = 2;
  }

  void line(const Point &a, const Point &b)
  {
    for (const Point *end : {&a, &b})
      lines.points.insert(lines.points.end(), end->begin(), end->end());
  }

  void cross(const Point &centre)
  {
    const Point &size = scene_.specimen.size;
    const double arm = cross_share * *std::max_element(size.begin(), size.end());
    for (int c = 0; c < scene_.dimension; ++c) {
      Point from = centre, to = centre;
      from[c] -= arm;
      to[c] += arm;
      line(from, to);
    }
  }

  void box(const Point &lower, const Point &upper)
  {
    const auto at = [&](int corner) {
      Point p = {0, 0, 0};
      for (int c = 0; c < scene_.dimension; ++c) {
        const Specimen &s = scene_.specimen;
        p[c] = std::clamp(corner >> c & 1 ? upper[c] : lower[c], s.lower(c), s.upper(c));
      }
      return p;
    };
    for (int corner = 0; corner < 1 << scene_.dimension; ++corner)
      for (int axis = 0; axis < scene_.dimension; ++axis)
        if (!(corner >> axis & 1))
          line(at(corner), at(corner | 1 << axis));
  }

  Segments lines;

private:
  const Scene &scene_;
};

/// The rectangles of a J-integral reach through the specimen along the crack's front.
Point along_front(const GaugeParameters &gauge, Point corner, double end)
{
  for (int c = 0; c < 3; ++c)
    if (gauge.direction[c] == 0 && gauge.normal[c] == 0)
      corner[c] = end;
  return corner;
}
/// Else the gauge reads all that is there.
bool is_bounded(const GaugeParameters &gauge)
{
  const auto is_finite = [](double x) { return std::isfinite(x); };
  return std::any_of(gauge.lower.begin(), gauge.lower.end(), is_finite) ||
         std::any_of(gauge.upper.begin(), gauge.upper.end(), is_finite);
}
} // namespace

void add_gauges(const Scene &scene, Picture &picture)
{
  GaugeLines lines(scene);
  for (const GaugeParameters &gauge : scene.gauges) {
    for (const Point &point : gauge.points)
      lines.cross(point);
    if (gauge.points.size() == 2)
      lines.line(gauge.points[0], gauge.points[1]);
    if (gauge.kind == GaugeKind::j_integral) {
      const bool solid = scene.dimension == 3;
      const auto end = [&](const Point &p, double side) {
        return solid ? along_front(gauge, p, side) : p;
      };
      lines.box(end(gauge.lower, -infinity), end(gauge.upper, infinity));
      lines.box(end(gauge.inner_lower, -infinity), end(gauge.inner_upper, infinity));
    }
    const bool has_box = gauge.kind == GaugeKind::strain || gauge.kind == GaugeKind::stress ||
                         (gauge.kind == GaugeKind::virial_stress && is_bounded(gauge));
    if (has_box && gauge.points.empty())
      lines.box(gauge.lower, gauge.upper);
  }
  if (lines.lines.points.empty())
    return;
  picture.segments.push_back(std::move(lines.lines));
  picture.legend.push_back({"gauges", gauge_color, LegendEntry::Mark::line});
}
} // namespace ligament::program
