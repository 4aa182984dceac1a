// Colours of values: dark violet over green to light yellow, even in perceived lightness.
#pragma once

#include "src/drawing/color.h"

namespace ligament::program
{
/// t in [0, 1]; outside is clamped. Lightness grows linearly and hue turns in the OKLab space
/// (B. Ottosson, 2020), so that equal steps of t look equally large and survive in grey.
Color colormap(double t);

Palette colormap_palette();
Palette flat_palette(Color color);
} // namespace ligament::program
