#include "src/output/picture.h"

#include "core/files.h"
#include "src/output/canvas.h"
#include "src/output/format.h"
#include "src/output/plot.h"
#include "src/output/stroke_font.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
constexpr double margin = 24, title_height = 15, label_height = 11; // pixels
constexpr double bar_width = 18, bar_gap = 26;
constexpr int largest_height = 1500;
constexpr Color ink = {40, 40, 40};

using Point = std::array<double, 3>;

Point normalized(const Point &a)
{
  const double length = std::hypot(a[0], a[1], a[2]);
  return {a[0] / length, a[1] / length, a[2] / length};
}

Point cross(const Point &a, const Point &b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const double *a, const Point &b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Orthographic projection: right, up and towards the viewer; then to pixels.
class Projection
{
public:
  explicit Projection(const Picture &picture)
  {
    if (picture.dimension == 3) {
      towards_ = normalized(picture.view);
      const bool from_above = std::abs(towards_[1]) > 0.999;
      right_ = normalized(cross(from_above ? Point{0, 0, -1} : Point{0, 1, 0}, towards_));
      up_ = cross(towards_, right_);
    }
    for (const auto &layer : picture.quads)
      include(layer.points, 0);
    for (const auto &layer : picture.scatters)
      include(layer.positions, layer.radius);
    for (const auto &layer : picture.segments)
      include(layer.points, 0);
    if (!(lower_[0] <= upper_[0]))
      lower_ = {0, 0}, upper_ = {1, 1};

    const bool bar = !picture.value_label.empty();
    // Room for the widest prefix of the unit; tick texts need less.
    const double bar_column =
        bar ? bar_gap + std::max(100., label_height * stroke_text(picture.value_label + " (" + "M" +
                                                                  picture.value_unit + ")")
                                                          .width)
            : 0;
    const double free_width = picture.width - 2 * margin - bar_column;
    const double free_height = largest_height - 2 * margin - header() - footer();
    const double w = upper_[0] - lower_[0], h = upper_[1] - lower_[1];
    pixels_per_metre_ =
        std::min(free_width / std::max(w, 1e-12 * h), free_height / std::max(h, 1e-12 * w));
    right_edge_ = margin + w * pixels_per_metre_;
    bottom_edge_ = margin + header() + h * pixels_per_metre_;
    width = int(std::ceil(std::max(right_edge_ + bar_column + margin, 420.)));
    height = int(std::ceil(std::max(bottom_edge_ + footer() + margin, bar ? 260. : 0.)));
  }

  Canvas::Vertex operator()(const double *x, double t = 0) const
  {
    return {margin + (dot(x, right_) - lower_[0]) * pixels_per_metre_,
            bottom_edge_ - (dot(x, up_) - lower_[1]) * pixels_per_metre_,
            dot(x, towards_) * pixels_per_metre_, t};
  }

  static double header() { return title_height + 14; }
  static double footer() { return 34; }
  double pixels_per_metre() const { return pixels_per_metre_; }
  double right_edge() const { return right_edge_; }
  double bottom_edge() const { return bottom_edge_; }

  int width, height; // of the picture

private:
  void include(const std::vector<double> &points, double radius)
  {
    for (std::size_t i = 0; i + 2 < points.size(); i += 3)
      for (int c = 0; c < 2; ++c) {
        const double x = dot(&points[i], c == 0 ? right_ : up_);
        lower_[c] = std::min(lower_[c], x - radius);
        upper_[c] = std::max(upper_[c], x + radius);
      }
  }

  Point right_ = {1, 0, 0}, up_ = {0, 1, 0}, towards_ = {0, 0, 1};
  std::array<double, 2> lower_ = {HUGE_VAL, HUGE_VAL}, upper_ = {-HUGE_VAL, -HUGE_VAL};
  double pixels_per_metre_, right_edge_, bottom_edge_;
};

/// A few hot particles at a crack tip must not turn all others dark.
std::array<double, 2> value_range(const Picture &picture)
{
  if (picture.range)
    return *picture.range;
  std::vector<double> values;
  const auto collect = [&](const std::vector<double> &more) {
    std::copy_if(more.begin(), more.end(), std::back_inserter(values),
                 [](double v) { return std::isfinite(v); });
  };
  for (const auto &layer : picture.quads)
    collect(layer.values);
  for (const auto &layer : picture.scatters)
    collect(layer.values);
  if (values.empty())
    return {0, 1};
  const auto quantile = [&](double q) {
    const auto place = values.begin() + std::ptrdiff_t(q * double(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return *place;
  };
  const double lower = quantile(0.01), upper = quantile(0.99);
  const double least = std::max(1e-12 * std::max(std::abs(lower), std::abs(upper)), 1e-300);
  return {lower, std::max(upper, lower + least)};
}

class Painter
{
public:
  explicit Painter(const Picture &picture)
      : picture_(picture), project_(picture), range_(value_range(picture)),
        canvas_(project_.width, project_.height, picture.dimension == 3)
  {
  }

  std::string paint()
  {
    for (const auto &layer : picture_.quads)
      fill(layer);
    for (const auto &layer : picture_.scatters)
      discs(layer);
    // Above the particles, so that the mesh shows through where the models overlap.
    for (const auto &layer : picture_.quads)
      if (layer.edges)
        edges(layer);
    for (const auto &layer : picture_.segments)
      lines(layer);
    for (const auto &label : picture_.labels) {
      const auto at = project_(label.position.data());
      canvas_.text(at.x, at.y + label_height / 2, label.text, label_height, label.color,
                   Canvas::Align::centre);
    }
    if (!picture_.title.empty())
      canvas_.text(margin, margin + title_height, picture_.title, title_height, ink);
    if (!picture_.value_label.empty())
      color_bar();
    scale_bar();
    return canvas_.png();
  }

private:
  double normal(double value) const { return (value - range_[0]) / (range_[1] - range_[0]); }

  /// The palette of a layer and the place of item i in it.
  Palette palette(const std::vector<double> &values, Color color) const
  {
    return values.empty() ? flat_palette(color) : colormap_palette();
  }
  double place(const std::vector<double> &values, std::size_t i) const
  {
    return values.empty() || !std::isfinite(values[i]) ? 0 : normal(values[i]);
  }

  void fill(const Quads &layer)
  {
    const Palette colors = palette(layer.values, layer.color);
    for (std::size_t q = 0; q + 3 < layer.corners.size(); q += 4) {
      std::array<Canvas::Vertex, 4> v;
      for (int k = 0; k < 4; ++k) {
        const auto i = std::size_t(layer.corners[q + k]);
        v[k] = project_(&layer.points[3 * i], place(layer.values, i));
      }
      double shade = 1;
      if (picture_.dimension == 3) {
        const Point a = {v[2].x - v[0].x, v[2].y - v[0].y, v[2].z - v[0].z};
        const Point b = {v[3].x - v[1].x, v[3].y - v[1].y, v[3].z - v[1].z};
        const Point n = normalized(cross(a, b));
        // Faces are seen from either side: the light falls on the side of the viewer.
        const double side = n[2] < 0 ? -1 : 1;
        shade = 0.7 + 0.32 * std::max(0., side * (-0.4 * n[0] - 0.5 * n[1] + 0.77 * n[2]));
      }
      canvas_.triangle({v[0], v[1], v[2]}, colors, shade);
      canvas_.triangle({v[0], v[2], v[3]}, colors, shade);
    }
  }

  void discs(const Scatter &layer)
  {
    const Palette colors = palette(layer.values, layer.color);
    const double radius = std::max(layer.radius * project_.pixels_per_metre(), 0.75);
    const auto draw = [&](double r, const Palette &palette) {
      for (std::size_t i = 0; 3 * i + 2 < layer.positions.size(); ++i)
        canvas_.disc(project_(&layer.positions[3 * i], place(layer.values, i)), r, palette);
    };
    if (picture_.dimension == 2) {
      // Closes the gaps between touching discs (2/sqrt(3) radii reach their middle), a little
      // darker so that the particles remain to be seen.
      Palette darker = colors;
      for (Color &c : darker)
        c = {std::uint8_t(0.85 * c.r), std::uint8_t(0.85 * c.g), std::uint8_t(0.85 * c.b)};
      draw(2 / std::sqrt(3.) * radius, darker);
    }
    draw(radius, colors);
  }

  void edges(const Quads &layer)
  {
    const Canvas::Pen pen{{255, 255, 255}, 1, 0.45, 0};
    for (std::size_t q = 0; q + 3 < layer.corners.size(); q += 4)
      for (int k = 0; k < 4; ++k) {
        auto a = project_(&layer.points[3 * layer.corners[q + k]]);
        auto b = project_(&layer.points[3 * layer.corners[q + (k + 1) % 4]]);
        a.z += 1; // in front of the faces that they bound
        b.z += 1;
        canvas_.line(a, b, pen);
      }
  }

  void lines(const Segments &layer)
  {
    const Canvas::Pen pen{layer.color, layer.width, 1, 0.5};
    for (std::size_t i = 0; i + 5 < layer.points.size(); i += 6) {
      auto a = project_(&layer.points[i]), b = project_(&layer.points[i + 3]);
      a.z += 1;
      b.z += 1;
      if (layer.dashed)
        canvas_.dashed_line(a, b, pen);
      else
        canvas_.line(a, b, pen);
    }
  }

  void color_bar()
  {
    const double x = project_.right_edge() + bar_gap, top = margin + Projection::header() + 26;
    const double length = std::clamp(project_.bottom_edge() - top, 120., 420.);
    const Palette colors = colormap_palette();
    for (int i = 0; i < 256; ++i)
      canvas_.fill_rectangle(x, top + length * (255 - i) / 256., x + bar_width,
                             top + length * (256 - i) / 256., colors[i]);
    const bool plain = picture_.value_unit.empty() || picture_.value_unit == "1" ||
                       picture_.value_unit.find_first_of("^*/ ") != std::string::npos;
    const double magnitude = std::max(std::abs(range_[0]), std::abs(range_[1]));
    const Prefix prefix = plain ? Prefix{1, ""} : si_prefix(magnitude);
    const auto ticks = nice_ticks(range_[0] / prefix.factor, range_[1] / prefix.factor, 5);
    for (const double tick : ticks) {
      const double y = top + length * (1 - normal(tick * prefix.factor));
      if (y < top - 1 || y > top + length + 1)
        continue;
      canvas_.fill_rectangle(x + bar_width, y - 0.5, x + bar_width + 5, y + 0.5, ink);
      canvas_.text(x + bar_width + 9, y + label_height / 2, tick_text(tick, ticks[1] - ticks[0]),
                   label_height, ink);
    }
    const std::string unit = picture_.value_unit == "1" ? "" : prefix.symbol + picture_.value_unit;
    canvas_.text(x, top - 12, picture_.value_label + (unit.empty() ? "" : " (" + unit + ")"),
                 label_height, ink);
  }

  /// A round length of about a fifth of the picture.
  void scale_bar()
  {
    const double wanted = 0.2 * (project_.right_edge() - margin) / project_.pixels_per_metre();
    const double length = nice_ticks(0, wanted, 1)[1];
    const double y = project_.bottom_edge() + 20, pixels = length * project_.pixels_per_metre();
    canvas_.fill_rectangle(margin, y, margin + pixels, y + 3, ink);
    const Prefix prefix = si_prefix(length);
    canvas_.text(margin + pixels + 10, y + label_height / 2 + 1,
                 fmt::format("{:g} {}m", length / prefix.factor, prefix.symbol), label_height, ink);
  }

  const Picture &picture_;
  Projection project_;
  std::array<double, 2> range_;
  Canvas canvas_;
};
} // namespace

void write_picture(const std::string &path, const Picture &picture)
{
  core::write_file(path, Painter(picture).paint());
}
} // namespace ligament::program
