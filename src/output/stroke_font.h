// Letters as strokes for pictures: no font file, any size.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace ligament::program
{
using Polyline = std::vector<std::array<double, 2>>;

/// A line of text with capitals of height 1 on the base line y = 0, starting at x = 0.
struct StrokedText
{
  std::vector<Polyline> strokes;
  double width;
};

/// Printable ASCII and µ (in UTF-8); other characters appear as blanks.
StrokedText stroke_text(const std::string &text);
} // namespace ligament::program
