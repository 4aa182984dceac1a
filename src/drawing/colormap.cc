#include "src/drawing/colormap.h"

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
constexpr double pi = 3.14159265358979323846;

/// Linear light to the sRGB byte (IEC 61966-2-1).
std::uint8_t srgb(double c)
{
  c = std::clamp(c, 0., 1.);
  const double encoded = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
  return std::uint8_t(std::lround(255 * encoded));
}

/// Lightness, chroma and hue (degrees) of OKLab.
Color oklch(double lightness, double chroma, double hue)
{
  const double a = chroma * std::cos(hue * pi / 180), b = chroma * std::sin(hue * pi / 180);
  const double l = std::pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
  const double m = std::pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
  const double s = std::pow(lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
  return {srgb(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          srgb(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          srgb(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}
} // namespace

Color colormap(double t)
{
  t = std::clamp(t, 0., 1.);
  const double chroma = 0.10 + 0.07 * t;
  return oklch(0.28 + 0.64 * t, chroma, 310 - 205 * t);
}

Palette colormap_palette()
{
  Palette palette;
  for (std::size_t i = 0; i < palette.size(); ++i)
    palette[i] = colormap(double(i) / double(palette.size() - 1));
  return palette;
}

Palette flat_palette(Color color)
{
  Palette palette;
  palette.fill(color);
  return palette;
}
} // namespace ligament::program
