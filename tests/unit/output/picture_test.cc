// Pictures: the right colour at the right place.
#include "src/drawing/picture.h"

#include "core/check.h"
#include "core/files.h"
#include "src/drawing/colormap.h"
#include "src/drawing/depth_raster.h"
#include "src/drawing/field_view.h"
#include "tests/unit/output/xml.h"

#include <cairo/cairo.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

using namespace ligament;
using namespace ligament::program;

namespace
{
struct Image
{
  int width, height;
  std::vector<Color> pixels;

  explicit Image(const std::string &file)
  {
    Source source{file, 0};
    cairo_surface_t *image = cairo_image_surface_create_from_png_stream(read, &source);
    EXPECT_EQ(cairo_surface_status(image), CAIRO_STATUS_SUCCESS);
    width = cairo_image_surface_get_width(image);
    height = cairo_image_surface_get_height(image);
    const unsigned char *rows = cairo_image_surface_get_data(image);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const unsigned char *p = rows + y * cairo_image_surface_get_stride(image) + 4 * x;
        pixels.push_back({p[2], p[1], p[0]});
      }
    cairo_surface_destroy(image);
  }
  Color at(int x, int y) const { return pixels[std::size_t(y) * width + x]; }
  int count(Color c) const
  {
    int n = 0;
    for (const Color &p : pixels)
      n += p.r == c.r && p.g == c.g && p.b == c.b;
    return n;
  }
  /// First and last column with the colour; empty range without one.
  std::array<int, 2> columns(Color c) const
  {
    std::array<int, 2> range = {width, -1};
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        if (const Color p = at(x, y); p.r == c.r && p.g == c.g && p.b == c.b)
          range = {std::min(range[0], x), std::max(range[1], x)};
    return range;
  }

private:
  struct Source
  {
    const std::string &file;
    std::size_t at;
  };
  static cairo_status_t read(void *source, unsigned char *data, unsigned int size)
  {
    auto &from = *static_cast<Source *>(source);
    if (from.at + size > from.file.size())
      return CAIRO_STATUS_READ_ERROR;
    std::memcpy(data, &from.file[from.at], size);
    from.at += size;
    return CAIRO_STATUS_SUCCESS;
  }
};

bool equal(Color a, Color b)
{
  return a.r == b.r && a.g == b.g && a.b == b.b;
}

/// Relative luminance (sRGB).
double luminance(Color c)
{
  const auto linear = [](double v) {
    v /= 255;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b);
}

TEST(Colormap, GrowsLighterAllTheWay)
{
  for (int i = 0; i < 255; ++i)
    EXPECT_GT(luminance(colormap((i + 1) / 255.)), luminance(colormap(i / 255.)) - 1e-3) << i;
  EXPECT_GT(luminance(colormap(1)), 10 * luminance(colormap(0)));
  EXPECT_TRUE(equal(colormap(-5), colormap(0)));
  EXPECT_TRUE(equal(colormap(7), colormap(1)));
}

/// What a raster shows on white.
Image shown(const DepthRaster &raster)
{
  Drawing drawing(raster.width(), raster.height(), ImageFormat::png);
  drawing.image(0, 0, raster.width(), raster.height(), raster.pixels());
  return Image(drawing.file());
}

TEST(DepthRaster, ShapesCoverTheirArea)
{
  const Color red = {200, 0, 0};
  DepthRaster raster(200, 100);
  raster.cell({50, 50, 0, 0}, 100, 30, flat_palette(red)); // too flat to be shaded
  raster.triangle({{{110, 10, 0, 0}, {190, 10, 0, 0}, {190, 90, 0, 0}}}, flat_palette(red));
  const Image image = shown(raster);
  ASSERT_EQ(image.width, 200);
  ASSERT_EQ(image.height, 100);
  EXPECT_TRUE(equal(image.at(50, 15), white));
  EXPECT_TRUE(equal(image.at(180, 20), red));
  EXPECT_TRUE(equal(image.at(120, 80), white));
  // Only the pixels on the outline are neither coloured nor white.
  const double area = M_PI * 30 * 30 + 0.5 * 80 * 80;
  const double outline = 2 * M_PI * 30 + 80 * (2 + std::sqrt(2.));
  EXPECT_NEAR(200 * 100 - image.count(white), area, outline);
}

TEST(DepthRaster, NearerThingsHideFartherOnes)
{
  const Color red = {200, 0, 0}, blue = {0, 0, 200};
  for (const double z : {-5., 5.}) {
    DepthRaster raster(40, 40);
    raster.triangle({{{0, 0, 0, 0}, {80, 0, 0, 0}, {0, 80, 0, 0}}}, flat_palette(red));
    raster.triangle({{{0, 0, z, 0}, {80, 0, z, 0}, {0, 80, z, 0}}}, flat_palette(blue));
    EXPECT_TRUE(equal(shown(raster).at(10, 10), z > 0 ? blue : red));
    EXPECT_EQ(raster.hides(10, 10, 2), z > 0);
    EXPECT_FALSE(raster.hides(1000, 10, -100));
  }
}

// The border between two cells of a Laguerre diagram lies at the distance
// (D^2 + r1^2 - r2^2)/(2 D) from the first centre.
TEST(DepthRaster, ParticlesOfAPlaneFillTheirCells)
{
  const double r1 = 40, r2 = 20, distance = 50;
  const Color red = {200, 0, 0}, blue = {0, 0, 200};
  DepthRaster raster(160, 100);
  raster.cell({50, 50, 0, 0}, r1, 60, flat_palette(red));
  raster.cell({50 + distance, 50, 0, 0}, r2, 60, flat_palette(blue));
  const double border = 50 + (distance * distance + r1 * r1 - r2 * r2) / (2 * distance);
  const Image image = shown(raster);
  for (int x = 30; x < 120; ++x)
    if (std::abs(x + 0.5 - border) > 1) {
      const Color c = image.at(x, 50);
      EXPECT_EQ(c.r > c.b, x + 0.5 < border) << x;
    }
}

// Two particles of different values and a line: the ends of the colour scale, the line on top.
TEST(Picture, ParticlesCarryTheirColours)
{
  Picture picture;
  picture.width = 400;
  Scatter scatter;
  scatter.positions = {0, 0, 0, 10, 0, 0};
  scatter.radii = {3, 3};
  scatter.values = {-1, 1};
  picture.scatters = {scatter};
  picture.range = {-1, 1};
  Segments crack;
  crack.points = {5, -3, 0, 5, 3, 0};
  crack.color = {255, 0, 0};
  crack.width = 4;
  picture.segments = {crack};
  picture.value_label = "velocity";
  picture.value_unit = "m/s";
  write_picture("particles.png", picture);
  const std::string file = core::read_file("particles.png");
  EXPECT_EQ(file, draw_picture(picture)); // the same drawing, the same bytes
  const Image image(file);
  const auto low = image.columns(colormap(0)), line = image.columns({255, 0, 0});
  EXPECT_GT(image.count(colormap(0)), 50);
  EXPECT_GT(image.count({255, 0, 0}), 50);
  EXPECT_LT(low[0], line[0]);
  EXPECT_GT(image.count(colormap(1)), 50);
  EXPECT_THROW(write_picture("/dev/full", picture), core::EnvironmentError);

  const std::string drawing = draw_picture(picture, ImageFormat::svg);
  EXPECT_NO_THROW(tests::parse_xml(drawing));
  EXPECT_NE(drawing.find(">velocity (m/s)<"), std::string::npos);
}

// A field that is zero nearly everywhere shows what is not.
TEST(Picture, RareValuesHaveColours)
{
  Picture picture;
  Scatter scatter;
  scatter.values.assign(1000, 0.);
  scatter.values[500] = 0.8;
  picture.scatters = {scatter};
  EXPECT_EQ(value_range({picture})[0], 0);
  EXPECT_EQ(value_range({picture})[1], 0.8);
  for (int k = 0; k < 1000; ++k)
    picture.scatters[0].values[k] = k == 0 ? 1e6 : k; // a few hot ones don't
  EXPECT_LT(value_range({picture})[1], 1000);
}

// The same everywhere but for what a solver leaves: in the middle of the colours.
TEST(Picture, NoiseHasOneColour)
{
  Picture picture;
  Scatter scatter;
  for (int k = 0; k < 1000; ++k)
    scatter.values.push_back(-7e5 * (1 + 1e-9 * (k % 7)));
  picture.scatters = {scatter};
  const auto [lower, upper] = value_range({picture});
  for (const double value : scatter.values)
    EXPECT_NEAR((value - lower) / (upper - lower), 0.5, 0.01);
}

/// Two particles, a cell and the face between the particles, which have moved apart.
BodyState two_particles()
{
  BodyState state;
  state.particles.reference = {0, 0, 0, 1, 0, 0};
  state.particles.fields = {make_field("displacement", {-1e-3, 0, 0, 2e-3, 0, 0}),
                            make_field("stress", {9, 3, 0, 0, 0, 0, 9, 5, 0, 0, 0, 0}),
                            make_field("radius", {0.5, 0.4}), make_field("global_id", {7, 9})};
  state.cells.reference = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  state.cells.connectivity = {0, 1, 2, 3};
  state.cells.cell_fields = {make_field("stress", {0, 4, 0, 0, 0, 0})};
  state.bonds = {{7, 9, 0, {0.5, 0, 0}, {1, 0, 0}, 0.2, 0}};
  return state;
}

TEST(FieldView, FieldsOfBothModelsInOneFrame)
{
  const BodyState state = two_particles();
  FieldView view;
  view.magnify = 100;
  const Picture p = picture_of(state, 2, view);
  EXPECT_EQ(p.value_label, "stress yy");
  EXPECT_EQ(p.value_unit, "Pa");
  EXPECT_EQ(p.scatters.at(0).values, (std::vector<double>{3, 5}));
  EXPECT_EQ(p.scatters[0].radii, (std::vector<double>{0.5, 0.4}));
  EXPECT_DOUBLE_EQ(p.scatters[0].positions[0], -100 * 1e-3);
  EXPECT_EQ(p.quads.at(0).values, (std::vector<double>(4, 4.)));
  EXPECT_EQ(p.notes, (std::vector<std::string>{"displacements × 100"}));
}

// An open crack is drawn along the flanks, not in the gap between them.
TEST(FieldView, BothFlanksOfABrokenFaceMoveWithTheirParticles)
{
  FieldView view;
  view.magnify = 100;
  const Picture p = picture_of(two_particles(), 2, view);
  const auto &ends = p.segments.at(0).points;
  ASSERT_EQ(ends.size(), 2 * 2 * 3u);
  for (const auto &[line, x] : {std::pair(0, 0.5 - 100 * 1e-3), std::pair(6, 0.5 + 100 * 2e-3)}) {
    EXPECT_NEAR(ends[line], x, 1e-15);
    EXPECT_NEAR(ends[line + 3], x, 1e-15);
    EXPECT_NEAR(std::abs(ends[line + 4] - ends[line + 1]), 0.2, 1e-15);
  }
}

// Pictures of a run can be compared: one factor, written on all of them, and one range.
TEST(FieldView, StatesOfARunShareMagnificationAndRange)
{
  BodyState peak = two_particles(), end = two_particles();
  for (double &u : end.particles.fields[0].values)
    u *= 10;
  end.particles.fields[1].values = {0, -7, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  const auto pictures = pictures_of({&peak, &end}, 2, FieldView());
  ASSERT_EQ(pictures.size(), 2u);
  EXPECT_EQ(pictures[0].notes, pictures[1].notes);
  EXPECT_EQ(pictures[0].notes.size(), 1u);
  EXPECT_EQ(*pictures[0].range, *pictures[1].range);
  EXPECT_EQ((*pictures[0].range)[0], -7);
  const double factor = good_magnification({&peak, &end});
  EXPECT_DOUBLE_EQ(pictures[0].scatters[0].positions[0], -1e-3 * factor);
  EXPECT_DOUBLE_EQ(pictures[1].scatters[0].positions[0], -1e-2 * factor);
  // 6 % of the diagonal over the largest displacement of the end, rounded down to 1, 2, 5.
  EXPECT_LE(factor, 0.06 * std::sqrt(2.) / 2e-2);
  EXPECT_GT(factor, 0.06 * std::sqrt(2.) / 2e-2 / 2.5 - 1e-12);
}

TEST(ShownField, EveryWordLeadsToAFieldAndNoOther)
{
  for (const int dimension : {2, 3})
    for (const std::string &word : shown_field_words(dimension)) {
      const ShownField shown = shown_field(word, dimension);
      EXPECT_NO_THROW(make_field(shown.field, {})) << word;
      EXPECT_EQ(shown.component < 0 ? shown.field : shown.field + "_",
                word.substr(0, shown.field.size() + (shown.component >= 0)));
    }
  EXPECT_EQ(shown_field("stress_xz", 3).component, 5);
  EXPECT_EQ(shown_field("velocity", 2).component, -1);
  EXPECT_EQ(shown_field("equivalent_stress", 2).unit(), "Pa");
  EXPECT_THROW(shown_field("stress_xz", 2), core::InputError);
  try {
    shown_field("stres_yy", 2);
    FAIL();
  } catch (const core::InputError &error) {
    EXPECT_NE(std::string(error.what()).find("stress_yy"), std::string::npos) << error.what();
  }
}

TEST(EquivalentStress, OfTensionAndShear)
{
  EXPECT_DOUBLE_EQ(equivalent_stress(std::vector<double>{0, 4, 0, 0, 0, 0}.data()), 4);
  EXPECT_DOUBLE_EQ(equivalent_stress(std::vector<double>{0, 0, 0, 2, 0, 0}.data()),
                   2 * std::sqrt(3.));
  EXPECT_DOUBLE_EQ(equivalent_stress(std::vector<double>{5, 5, 5, 0, 0, 0}.data()), 0);
}

// Two hexahedra side by side have 10 outer faces; with one cut away, 6.
TEST(FieldView, OnlyOuterFacesAreDrawnIn3D)
{
  BodyState state;
  CellFields &cells = state.cells;
  cells.dimension = 3;
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 3; ++x)
        cells.reference.insert(cells.reference.end(), {double(x), double(y), double(z)});
  cells.connectivity = {0, 1, 4, 3, 6, 7, 10, 9, 1, 2, 5, 4, 7, 8, 11, 10};
  FieldView view;
  EXPECT_EQ(picture_of(state, 3, view).quads[0].corners.size(), 4 * 10u);
  view.cut = {{1, 0, 0, 1, 0, 0}};
  EXPECT_EQ(picture_of(state, 3, view).quads[0].corners.size(), 4 * 6u);
  write_picture("cells.png", picture_of(state, 3, view));
}

// The texts of this program, Greek letters and superscripts included, have letters and no boxes:
// a font is there.
// Many lines are drawn in parts; where they lie over each other they are as dark as one.
TEST(Drawing, ManyLinesAreAsDarkAsOne)
{
  const std::vector<Spot> line = {{10, 20}, {90, 20}};
  for (const double opacity : {1., 0.35}) {
    const Drawing::Pen pen = {{225, 25, 60}, 4, opacity};
    const auto image_of = [&](std::size_t n) {
      Drawing drawing(100, 40, ImageFormat::png);
      std::vector<std::vector<Spot>> lines(n, line);
      lines.push_back({{10, 30}, {90, 30}}); // the last part is drawn, too
      drawing.lines(lines, pen);
      return Image(drawing.file());
    };
    const Image one = image_of(1);
    EXPECT_FALSE(equal(one.at(50, 20), {255, 255, 255}));
    for (const std::size_t n : {255, 256, 2000}) {
      const Image many = image_of(n);
      for (int x = 15; x < 85; ++x)
        for (const int y : {19, 20, 30})
          EXPECT_NEAR(many.at(x, y).g, one.at(x, y).g, 1) << opacity << " " << n;
    }
  }
}

TEST(Drawing, TextsHaveWidths)
{
  const Drawing::Font font = {12};
  EXPECT_GT(Drawing::text_width("stress (MPa), µ × 10⁻³", font), 80);
  EXPECT_NEAR(Drawing::text_width("ab", font),
              Drawing::text_width("a", font) + Drawing::text_width("b", font), 0.1);
  EXPECT_NEAR(Drawing::text_width("abc", {24}), 2 * Drawing::text_width("abc", font), 0.2);
}

// A quarter turn about (2, 1), then a way along x.
TEST(FieldView, ToolsAreShownAsTheyHaveTurned)
{
  BodyState state;
  state.tools = {{{2, 1, 0, 4, 1, 0}, {0.5, 0, 0}, {0, -1, 0, 3, 1, 0, 0, -1, 0, 0, 1, 0}}};
  FieldView view;
  view.magnify = 1;
  const Picture picture = picture_of(state, 2, view);
  ASSERT_EQ(picture.segments.size(), 1u);
  EXPECT_EQ(picture.segments[0].points, (std::vector<double>{2.5, 1, 0, 2.5, 3, 0}));
}
} // namespace
