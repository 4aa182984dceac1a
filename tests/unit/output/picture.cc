// Pictures: the right colour at the right place.
#include "src/output/picture.h"

#include "core/check.h"
#include "core/files.h"
#include "src/output/canvas.h"
#include "src/output/colormap.h"
#include "src/output/stroke_font.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>

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
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    EXPECT_TRUE(png_image_begin_read_from_memory(&image, file.data(), file.size()));
    image.format = PNG_FORMAT_RGB;
    width = int(image.width);
    height = int(image.height);
    pixels.resize(std::size_t(width) * height);
    EXPECT_TRUE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr));
  }
  Color at(int x, int y) const { return pixels[std::size_t(y) * width + x]; }
  int count(Color c) const
  {
    int n = 0;
    for (const Color &p : pixels)
      n += p.r == c.r && p.g == c.g && p.b == c.b;
    return n;
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

TEST(Canvas, ShapesCoverTheirArea)
{
  const Color red = {200, 0, 0}, white = {255, 255, 255};
  Canvas canvas(200, 100, false);
  canvas.disc({50, 50, 0, 0}, 30, flat_palette(red));
  canvas.triangle({{{110, 10, 0, 0}, {190, 10, 0, 0}, {190, 90, 0, 0}}}, flat_palette(red));
  const Image image(canvas.png());
  ASSERT_EQ(image.width, 200);
  ASSERT_EQ(image.height, 100);
  EXPECT_TRUE(equal(image.at(50, 50), red));
  EXPECT_TRUE(equal(image.at(50, 15), white));
  EXPECT_TRUE(equal(image.at(180, 20), red));
  EXPECT_TRUE(equal(image.at(120, 80), white));
  // Only the pixels on the outline are neither red nor white.
  const double area = M_PI * 30 * 30 + 0.5 * 80 * 80;
  const double outline = 2 * M_PI * 30 + 80 * (2 + std::sqrt(2.));
  EXPECT_NEAR(image.count(red), area, outline);
}

TEST(Canvas, NearerThingsHideFartherOnes)
{
  const Color red = {200, 0, 0}, blue = {0, 0, 200};
  for (const double z : {-5., 5.}) {
    Canvas canvas(40, 40, true);
    canvas.triangle({{{0, 0, 0, 0}, {80, 0, 0, 0}, {0, 80, 0, 0}}}, flat_palette(red));
    canvas.triangle({{{0, 0, z, 0}, {80, 0, z, 0}, {0, 80, z, 0}}}, flat_palette(blue));
    EXPECT_TRUE(equal(Image(canvas.png()).at(10, 10), z > 0 ? blue : red));
  }
}

// Two particles of different values and a line: the ends of the colour scale, the line on top.
TEST(Picture, ParticlesCarryTheirColours)
{
  Picture picture;
  picture.width = 400;
  Scatter scatter;
  scatter.positions = {0, 0, 0, 10, 0, 0};
  scatter.values = {-1, 1};
  scatter.radius = 3;
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
  const Image image(core::read_file("particles.png"));
  const double half =
      M_PI * std::pow(3 * (400 - 200) / 16., 2) / 2; // pixels of half a disc, at least
  EXPECT_GT(image.count(colormap(0)), half);
  EXPECT_GT(image.count(colormap(1)), half);
  EXPECT_GT(image.count({255, 0, 0}), 50);
  EXPECT_THROW(write_picture("/dev/full", picture), core::EnvironmentError);
}

TEST(Picture, FieldsOfBothModelsInOneFrame)
{
  ParticleFields particles;
  particles.reference = {0, 0, 0, 1, 0, 0};
  particles.fields = {{"displacement", "m", Field::Kind::vector, {0, 1e-3, 0, 0, 0, 0}},
                      {"stress", "Pa", Field::Kind::tensor, {9, 3, 0, 0, 0, 0, 9, 5, 0, 0, 0, 0}},
                      {"global_id", "1", Field::Kind::scalar, {7, 9}}};
  CellFields cells;
  cells.reference = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  cells.connectivity = {0, 1, 2, 3};
  cells.cell_fields = {{"stress", "Pa", Field::Kind::tensor, {0, 4, 0, 0, 0, 0}}};
  const BrokenBond bond{7, 9, 0, {0.5, 0, 0}, {1, 0, 0}, 0.2, 0};
  FieldView view;
  view.component = 1;
  view.magnify = 100;
  const Picture p = picture_of(particles, cells, {bond}, 2, 0.5, view);
  EXPECT_EQ(p.value_label, "stress yy");
  EXPECT_EQ(p.scatters.at(0).values, (std::vector<double>{3, 5}));
  EXPECT_DOUBLE_EQ(p.scatters[0].positions[1], 100 * 1e-3);
  EXPECT_EQ(p.quads.at(0).values, (std::vector<double>(4, 4.)));
  // The face moves with the mean of its particles and is as long as it is.
  const auto &ends = p.segments.at(0).points;
  EXPECT_NEAR((ends[1] + ends[4]) / 2, 0.5 * 100 * 1e-3, 1e-15);
  EXPECT_NEAR(std::abs(ends[4] - ends[1]), 0.2, 1e-15);

  view.component = -1; // von Mises of (0, 4, 0): 4
  EXPECT_DOUBLE_EQ(picture_of(particles, cells, {}, 2, 0.5, view).quads[0].values[0], 4);
}

// Two hexahedra side by side have 10 outer faces; with one cut away, 6.
TEST(Picture, OnlyOuterFacesAreDrawnIn3D)
{
  CellFields cells;
  cells.dimension = 3;
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 3; ++x)
        cells.reference.insert(cells.reference.end(), {double(x), double(y), double(z)});
  cells.connectivity = {0, 1, 4, 3, 6, 7, 10, 9, 1, 2, 5, 4, 7, 8, 11, 10};
  FieldView view;
  EXPECT_EQ(picture_of({}, cells, {}, 3, 1, view).quads[0].corners.size(), 4 * 10u);
  view.cut = {{1, 0, 0, 1, 0, 0}};
  EXPECT_EQ(picture_of({}, cells, {}, 3, 1, view).quads[0].corners.size(), 4 * 6u);
  write_picture("cells.png", picture_of({}, cells, {}, 3, 1, view));
}

TEST(StrokeFont, EveryPrintableCharacterOfTheProgramHasStrokes)
{
  for (const char c : std::string("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789"
                                  ".,:;-+=/()[]%^_*'\"<>|!?#&"))
  {
    const auto text = stroke_text(std::string(1, c));
    EXPECT_FALSE(text.strokes.empty()) << c;
    EXPECT_GT(text.width, 0) << c;
    for (const auto &stroke : text.strokes)
      for (const auto &[x, y] : stroke) {
        EXPECT_GE(x, 0) << c;
        EXPECT_LE(x, text.width) << c;
        EXPECT_GE(y, -0.34) << c; // descenders reach two of six steps down
        EXPECT_LE(y, 1) << c;
      }
  }
  EXPECT_FALSE(stroke_text("µ").strokes.empty());
  EXPECT_DOUBLE_EQ(stroke_text("ab").width, stroke_text("a").width + stroke_text("b").width);
}
} // namespace
