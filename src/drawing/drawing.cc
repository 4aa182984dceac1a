#include "src/drawing/drawing.h"

#include "core/check.h"
#include "src/output/format.h"

#include <cairo/cairo-svg.h>
#include <cairo/cairo.h>
#include <fmt/core.h>

#include <cmath>
#include <cstring>

namespace ligament::program
{
namespace
{
/// Fontconfig takes the nearest font that it has; with none at all Cairo draws its own strokes.
constexpr const char *font_family = "DejaVu Sans";

cairo_status_t append(void *target, const unsigned char *data, unsigned int size)
{
  static_cast<std::string *>(target)->append(reinterpret_cast<const char *>(data), size);
  return CAIRO_STATUS_SUCCESS;
}

void check(cairo_status_t status)
{
  core::require<core::EnvironmentError>(status == CAIRO_STATUS_SUCCESS,
                                        std::string("Cairo: ") + cairo_status_to_string(status));
}

cairo_surface_t *make_surface(int width, int height, ImageFormat format, std::string &svg)
{
  if (format == ImageFormat::png)
    return cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
  cairo_surface_t *surface = cairo_svg_surface_create_for_stream(append, &svg, width, height);
  cairo_svg_surface_set_document_unit(surface, CAIRO_SVG_UNIT_PX);
  return surface;
}

/// Unhinted, so that widths are the same at every size and in both formats.
void set_font(cairo_t *cairo, const Drawing::Font &font)
{
  cairo_select_font_face(cairo, font_family, CAIRO_FONT_SLANT_NORMAL,
                         font.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo, font.size);
  cairo_font_options_t *options = cairo_font_options_create();
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_set_font_options(cairo, options);
  cairo_font_options_destroy(options);
}

/// Share of the width by which the text starts left of its spot.
double start(Drawing::Align align)
{
  return align == Drawing::Align::left ? 0 : align == Drawing::Align::centre ? 0.5 : 1;
}

std::string svg_text(const Spot &at, const std::string &text, const Drawing::Font &font)
{
  static constexpr const char *anchors[] = {"", " text-anchor=\"middle\"", " text-anchor=\"end\""};
  std::string place = fmt::format("x=\"{:.2f}\" y=\"{:.2f}\"", at[0], at[1]);
  if (font.upright)
    place = fmt::format("transform=\"translate({:.2f} {:.2f}) rotate(-90)\"", at[0], at[1]);
  const Color c = font.color;
  return fmt::format("<text {}{}{}{} font-size=\"{:g}\" fill=\"#{:02x}{:02x}{:02x}\">{}</text>\n",
                     place, anchors[int(font.align)], font.bold ? " font-weight=\"bold\"" : "",
                     font.halo ? " stroke=\"#fff\" stroke-width=\"3\" paint-order=\"stroke\"" : "",
                     font.size, c.r, c.g, c.b, escape_xml(text));
}

/// What names a surface by a running number would make equal drawings differ.
void remove_all(std::string &text, const std::string &opening, char closing)
{
  for (std::size_t at; (at = text.find(opening)) != std::string::npos;)
    text.erase(at, text.find(closing, at + opening.size()) + 1 - at);
}
} // namespace

Drawing::Drawing(int width, int height, ImageFormat format)
    : format_(format),
      surface_(make_surface(width, height, format, svg_), cairo_surface_destroy),
      cairo_(cairo_create(surface_.get()), cairo_destroy)
{
  check(cairo_status(cairo_.get()));
  rectangle(0, 0, width, height, white);
}

void Drawing::set_color(Color color, double opacity)
{
  cairo_set_source_rgba(cairo_.get(), color.r / 255., color.g / 255., color.b / 255., opacity);
}

// An eighth of a pixel is below what anybody sees and takes fewer digits.
Spot Drawing::snapped(const Spot &at) const
{
  if (format_ == ImageFormat::png)
    return at;
  return {std::round(8 * at[0]) / 8, std::round(8 * at[1]) / 8};
}

void Drawing::stroke(const Pen &pen)
{
  static constexpr double dashes[] = {7, 4};
  cairo_set_dash(cairo_.get(), dashes, pen.dashed ? 2 : 0, 0);
  cairo_set_line_width(cairo_.get(), pen.width);
  cairo_set_line_join(cairo_.get(), CAIRO_LINE_JOIN_ROUND);
  set_color(pen.color, pen.opacity);
  cairo_stroke(cairo_.get());
}

void Drawing::add_path(const std::vector<Spot> &line)
{
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Spot at = snapped(line[i]);
    (i == 0 ? cairo_move_to : cairo_line_to)(cairo_.get(), at[0], at[1]);
  }
}

// Cairo's time for a path grows faster than its length: the 300 000 outlines of a body that fell to
// pieces took most of a picture as one. In parts, one over the other, they are as dark only where
// opaque.
void Drawing::lines(const std::vector<std::vector<Spot>> &lines, const Pen &pen)
{
  constexpr std::size_t at_once = 256;
  cairo_t *cairo = cairo_.get();
  cairo_new_path(cairo);
  if (format_ == ImageFormat::svg || lines.size() <= at_once) {
    for (const auto &line : lines)
      add_path(line);
    stroke(pen);
    return;
  }
  cairo_push_group(cairo);
  Pen opaque = pen;
  opaque.opacity = 1;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    add_path(lines[i]);
    if ((i + 1) % at_once == 0 || i + 1 == lines.size())
      stroke(opaque);
  }
  cairo_pop_group_to_source(cairo);
  cairo_paint_with_alpha(cairo, pen.opacity);
}

void Drawing::outline_path(const std::vector<Spot> &corners)
{
  cairo_new_path(cairo_.get());
  for (const Spot &corner : corners) {
    const Spot at = snapped(corner);
    cairo_line_to(cairo_.get(), at[0], at[1]);
  }
  cairo_close_path(cairo_.get());
}

void Drawing::outline(const std::vector<Spot> &corners, const Pen &pen)
{
  outline_path(corners);
  stroke(pen);
}

void Drawing::polygon(const std::vector<Spot> &corners, Color color)
{
  outline_path(corners);
  set_color(color, 1);
  cairo_fill(cairo_.get());
}

void Drawing::rectangle(double x0, double y0, double x1, double y1, Color color)
{
  polygon({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, color);
}

void Drawing::disc(const Spot &centre, double radius, Color color)
{
  cairo_new_path(cairo_.get());
  cairo_arc(cairo_.get(), centre[0], centre[1], radius, 0, 2 * M_PI);
  set_color(color, 1);
  cairo_fill(cairo_.get());
}

void Drawing::ring(const Spot &centre, double radius, const Pen &pen)
{
  cairo_new_path(cairo_.get());
  cairo_arc(cairo_.get(), centre[0], centre[1], radius, 0, 2 * M_PI);
  cairo_close_path(cairo_.get());
  stroke(pen);
}

void Drawing::arrow(const Spot &from, const Spot &to, const Pen &pen)
{
  const double x = to[0] - from[0], y = to[1] - from[1], length = std::hypot(x, y);
  if (!(length > 0))
    return;
  const double head = std::min(5 * pen.width, 0.6 * length), half = 0.36 * head;
  const Spot along = {x / length, y / length};
  const Spot neck = {to[0] - head * along[0], to[1] - head * along[1]};
  line(from, neck, pen);
  polygon({to,
           {neck[0] - half * along[1], neck[1] + half * along[0]},
           {neck[0] + half * along[1], neck[1] - half * along[0]}},
          pen.color);
}

void Drawing::image(double x, double y, int width, int height,
                    const std::vector<std::uint32_t> &argb)
{
  core::require(argb.size() == std::size_t(width) * height, "an image needs all its pixels");
  cairo_surface_t *image = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height);
  check(cairo_surface_status(image));
  unsigned char *rows = cairo_image_surface_get_data(image);
  const int stride = cairo_image_surface_get_stride(image);
  for (int row = 0; row < height; ++row)
    std::memcpy(rows + std::size_t(row) * stride, &argb[std::size_t(row) * width],
                sizeof(argb[0]) * width);
  cairo_surface_mark_dirty(image);
  cairo_set_source_surface(cairo_.get(), image, x, y);
  cairo_paint(cairo_.get());
  cairo_surface_destroy(image);
}

void Drawing::text(const Spot &at, const std::string &text, const Font &font)
{
  if (format_ == ImageFormat::svg) {
    svg_texts_ += svg_text(at, text, font);
    return;
  }
  cairo_t *cairo = cairo_.get();
  cairo_save(cairo);
  set_font(cairo, font);
  cairo_translate(cairo, at[0], at[1]);
  if (font.upright)
    cairo_rotate(cairo, -M_PI / 2);
  cairo_move_to(cairo, -start(font.align) * text_width(text, font), 0);
  if (font.halo) {
    cairo_text_path(cairo, text.c_str());
    stroke({white, 3});
    cairo_move_to(cairo, -start(font.align) * text_width(text, font), 0);
  }
  set_color(font.color, 1);
  cairo_show_text(cairo, text.c_str());
  cairo_restore(cairo);
}

double Drawing::text_width(const std::string &text, const Font &font)
{
  cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1);
  cairo_t *cairo = cairo_create(surface);
  set_font(cairo, font);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo, text.c_str(), &extents);
  check(cairo_status(cairo));
  cairo_destroy(cairo);
  cairo_surface_destroy(surface);
  return extents.x_advance;
}

std::string Drawing::file()
{
  check(cairo_status(cairo_.get()));
  std::string png;
  if (format_ == ImageFormat::png) {
    check(cairo_surface_write_to_png_stream(surface_.get(), append, &png));
    return png;
  }
  cairo_.reset();
  cairo_surface_finish(surface_.get());
  check(cairo_surface_status(surface_.get()));
  remove_all(svg_, " id=\"surface", '"');
  svg_.erase(0, svg_.find("<svg"));
  svg_.insert(svg_.rfind("</svg>"),
              fmt::format("<g font-family=\"{}, Verdana, sans-serif\">\n{}</g>\n", font_family,
                          svg_texts_));
  return svg_;
}
} // namespace ligament::program
