#include "src/drawing/picture.h"

#include "core/files.h"
#include "src/drawing/colormap.h"
#include "src/drawing/picture_column.h"
#include "src/drawing/plot.h"
#include "src/drawing/projection.h"
#include "src/output/format.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
using Vertex = DepthRaster::Vertex;

// Pixels.
constexpr double margin = 22, title_size = 20;
constexpr double text_size = PictureColumn::text_size, line_height = PictureColumn::line_height;
constexpr double largest_height = 1300;   // of the body
constexpr double smallest_particle = 0.6; // radius
constexpr double axes_height = 64;        // 3D, of the small axes below the body

/// Particles are filled as far as this from their centres, in radii: the corner of a square cell
/// lies at 1.41, of a hexagonal one at 1.15; those of random packings reach farther now and then.
constexpr double reach = 1.5;

const Drawing::Font text_font = {text_size};
const Drawing::Font title_font = {title_size, ink, Drawing::Align::left, true};

/// Where everything stands on the page, in pixels.
struct Layout
{
  PictureColumn column;
  double room; // around the body, for arrows
  Projection project;
  double left, top; // of the body
  int width, height;

  Layout(const Picture &picture, const ValueRange &range)
      : column(picture, range), room(picture.arrows.empty() ? 0 : 46),
        project(picture, picture.width - 2 * margin - 2 * room - column.width(), largest_height),
        left(margin + room), top(margin + (picture.title.empty() ? 0 : title_size + 16) + room)
  {
    double right = std::max(column_left() + column.width() - PictureColumn::gap,
                            margin + Drawing::text_width(picture.title, title_font));
    for (const auto &note : picture.notes)
      right = std::max(right, margin + Drawing::text_width(note, text_font));
    width = int(std::ceil(std::max(right, 300.) + margin));
    const double notes_end = footer() + 34 + (picture.dimension == 3 ? axes_height : 0) +
                             double(picture.notes.size()) * line_height;
    height = int(std::ceil(std::max(notes_end, top + column.height(project.height())) + 6));
  }

  double column_left() const { return left + project.width() + room + PictureColumn::gap; }
  double footer() const { return top + project.height() + room; }
};

class Painter
{
public:
  Painter(const Picture &picture, ImageFormat format)
      : picture_(picture), range_(picture.range ? *picture.range : value_range({picture})),
        layout_(picture, range_), drawing_(layout_.width, layout_.height, format),
        raster_(int(std::ceil(layout_.project.width())) + 1,
                int(std::ceil(layout_.project.height())) + 1)
  {
  }

  std::string paint()
  {
    for (const auto &layer : picture_.quads)
      fill(layer);
    for (const auto &layer : picture_.scatters)
      particles(layer);
    drawing_.image(layout_.left, layout_.top, raster_.width(), raster_.height(), raster_.pixels());
    // Above the particles, so that the mesh shows through where the models overlap.
    for (const auto &layer : picture_.quads)
      edges(layer);
    for (const auto &layer : picture_.segments)
      segments(layer);
    for (const auto &arrow : picture_.arrows)
      draw(arrow);
    for (const auto &label : picture_.labels) {
      const Vertex at = layout_.project(label.position.data());
      drawing_.text({layout_.left + at.x, layout_.top + at.y + 0.36 * text_size}, label.text,
                    {text_size, label.color, Drawing::Align::centre, false, false, true});
    }
    drawing_.text({margin, margin + title_size - 2}, picture_.title, title_font);
    layout_.column.draw(drawing_, layout_.column_left(), layout_.top, layout_.project.height());
    scale();
    return drawing_.file();
  }

private:
  double place(const std::vector<double> &values, std::size_t i) const
  {
    if (values.empty() || !std::isfinite(values[i]))
      return 0;
    return (values[i] - range_[0]) / (range_[1] - range_[0]);
  }
  static Palette palette(const std::vector<double> &values, Color color)
  {
    return values.empty() ? flat_palette(color) : colormap_palette();
  }

  void fill(const Quads &layer)
  {
    const Palette colors = palette(layer.values, layer.color);
    for (std::size_t q = 0; q + 3 < layer.corners.size(); q += 4) {
      std::array<Vertex, 4> v;
      for (int k = 0; k < 4; ++k) {
        const auto i = std::size_t(layer.corners[q + k]);
        v[k] = layout_.project(&layer.points[3 * i], place(layer.values, i));
        if (picture_.dimension == 2)
          v[k].z = -1e30; // behind all particles
      }
      const double shade = picture_.dimension == 2 ? 1 : light(v);
      raster_.triangle({v[0], v[1], v[2]}, colors, shade);
      raster_.triangle({v[0], v[2], v[3]}, colors, shade);
    }
  }

  /// Faces are seen from either side: the light falls on the side of the viewer.
  static double light(const std::array<Vertex, 4> &v)
  {
    const double a[3] = {v[2].x - v[0].x, v[2].y - v[0].y, v[2].z - v[0].z};
    const double b[3] = {v[3].x - v[1].x, v[3].y - v[1].y, v[3].z - v[1].z};
    const double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                         a[0] * b[1] - a[1] * b[0]};
    const double length = std::hypot(n[0], n[1], n[2]) * (n[2] < 0 ? -1 : 1);
    return 0.7 + 0.32 * std::max(0., (-0.4 * n[0] - 0.5 * n[1] + 0.77 * n[2]) / length);
  }

  void particles(const Scatter &layer)
  {
    const Palette colors = palette(layer.values, layer.color);
    for (std::size_t i = 0; i < layer.radii.size(); ++i) {
      const Vertex centre = layout_.project(&layer.positions[3 * i], place(layer.values, i));
      const double radius =
          std::max(layer.radii[i] * layout_.project.pixels_per_metre(), smallest_particle);
      if (picture_.dimension == 2)
        raster_.cell(centre, radius, reach * radius, colors);
      else
        raster_.sphere(centre, radius, colors);
    }
  }

  /// Mesh lines, each once.
  void edges(const Quads &layer)
  {
    std::vector<std::array<std::int64_t, 2>> pairs;
    for (std::size_t q = 0; q + 3 < layer.corners.size(); q += 4)
      for (int k = 0; k < 4; ++k) {
        const std::int64_t a = layer.corners[q + k], b = layer.corners[q + (k + 1) % 4];
        pairs.push_back({std::min(a, b), std::max(a, b)});
      }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    VisibleLines lines;
    for (const auto &[a, b] : pairs)
      add(lines, &layer.points[3 * a], &layer.points[3 * b]);
    drawing_.lines(lines.in_front, {layer.edge_color, 1, 0.45});
  }

  void segments(const Segments &layer)
  {
    VisibleLines lines;
    for (std::size_t i = 0; i + 5 < layer.points.size(); i += 6)
      add(lines, &layer.points[i], &layer.points[i + 3]);
    drawing_.lines(lines.hidden, {layer.color, layer.width, 0.35, layer.dashed});
    drawing_.lines(lines.in_front, {layer.color, layer.width, 1, layer.dashed});
  }

  struct VisibleLines
  {
    std::vector<std::vector<Spot>> in_front, hidden;
  };

  /// Cuts a line where it goes behind something (3D).
  void add(VisibleLines &lines, const double *from, const double *to) const
  {
    const Vertex a = layout_.project(from), b = layout_.project(to);
    const auto at = [&](double s) {
      return Spot{layout_.left + a.x + s * (b.x - a.x), layout_.top + a.y + s * (b.y - a.y)};
    };
    if (picture_.dimension == 2) {
      lines.in_front.push_back({at(0), at(1)});
      return;
    }
    constexpr double piece = 2, in_front_by = 1; // pixels
    const int n = std::max(1, int(std::hypot(b.x - a.x, b.y - a.y) / piece));
    std::vector<std::vector<Spot>> *last = nullptr;
    for (int k = 0; k < n; ++k) {
      const double s = (k + 0.5) / n;
      const bool hidden = raster_.hides(a.x + s * (b.x - a.x), a.y + s * (b.y - a.y),
                                        a.z + s * (b.z - a.z) + in_front_by);
      auto &list = hidden ? lines.hidden : lines.in_front;
      if (&list == last)
        list.back().back() = at((k + 1.) / n);
      else
        list.push_back({at(double(k) / n), at((k + 1.) / n)});
      last = &list;
    }
  }

  void draw(const Arrow &arrow)
  {
    const Vertex p = layout_.project(arrow.place.data());
    const Spot d = layout_.project.direction(arrow.direction.data());
    const Spot at = {layout_.left + p.x, layout_.top + p.y};
    const double sign = arrow.ends_there ? -1 : 1;
    const Spot other = {at[0] + sign * arrow.length * d[0], at[1] + sign * arrow.length * d[1]};
    drawing_.arrow(arrow.ends_there ? other : at, arrow.ends_there ? at : other,
                   {arrow.color, 2.5});
  }

  /// A round length: a bar of about a fifth of the picture in 2D, the axes in 3D.
  void scale()
  {
    const double per_metre = layout_.project.pixels_per_metre();
    const double wanted =
        picture_.dimension == 2 ? std::max(0.2 * layout_.project.width(), 40.) : 0.4 * axes_height;
    const double length = nice_ticks(0, wanted / per_metre, 1)[1], pixels = length * per_metre;
    const Prefix prefix = si_prefix(length);
    const std::string text = fmt::format("{:g} {}m", length / prefix.factor, prefix.symbol);
    double y = layout_.footer() + 26;
    if (picture_.dimension == 2) {
      drawing_.rectangle(layout_.left, y - 8, layout_.left + pixels, y - 4, ink);
      drawing_.text({layout_.left + pixels + 12, y}, text, text_font);
    } else {
      y += axes_height;
      axes({margin + 0.6 * axes_height, y - 0.5 * axes_height}, pixels);
      drawing_.text({margin + 1.9 * axes_height, y - 0.5 * axes_height}, "axes: " + text,
                    text_font);
    }
    for (const auto &note : picture_.notes)
      drawing_.text({margin, y += line_height}, note, text_font);
  }

  void axes(const Spot &origin, double pixels)
  {
    static constexpr double unit[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static constexpr const char *names[] = {"x", "y", "z"};
    for (int c = 0; c < 3; ++c) {
      const Spot d = layout_.project.direction(unit[c]);
      const Spot end = {origin[0] + pixels * d[0], origin[1] + pixels * d[1]};
      drawing_.arrow(origin, end, {ink, 1.5});
      const double beyond = 11 / std::max(std::hypot(d[0], d[1]), 0.1);
      drawing_.text({end[0] + beyond * d[0], end[1] + beyond * d[1] + 0.36 * text_size}, names[c],
                    {0.9 * text_size, ink, Drawing::Align::centre});
    }
  }

  const Picture &picture_;
  ValueRange range_;
  Layout layout_;
  Drawing drawing_;
  DepthRaster raster_;
};
} // namespace

ValueRange value_range(const std::vector<Picture> &pictures)
{
  std::vector<double> values;
  const auto collect = [&](const std::vector<double> &more) {
    std::copy_if(more.begin(), more.end(), std::back_inserter(values),
                 [](double v) { return std::isfinite(v); });
  };
  for (const auto &picture : pictures) {
    for (const auto &layer : picture.quads)
      collect(layer.values);
    for (const auto &layer : picture.scatters)
      collect(layer.values);
  }
  if (values.empty())
    return {0, 1};
  const auto quantile = [&](double q) {
    const auto at = values.begin() + std::ptrdiff_t(q * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
  };
  double lower = quantile(0.01), upper = quantile(0.99);
  if (lower == upper) { // all but a few are equal: these few are what the picture is about
    lower = quantile(0);
    upper = quantile(1);
  }
  // What differs by less is the noise of a solver: it has one colour.
  const double least = std::max(1e-6 * std::max(std::abs(lower), std::abs(upper)), 1e-300);
  if (upper - lower >= least)
    return {lower, upper};
  const double middle = lower + (upper - lower) / 2;
  return {middle - least / 2, middle + least / 2};
}

std::string draw_picture(const Picture &picture, ImageFormat format)
{
  return Painter(picture, format).paint();
}

void write_picture(const std::string &path, const Picture &picture)
{
  core::write_file(path, draw_picture(picture));
}
} // namespace ligament::program
