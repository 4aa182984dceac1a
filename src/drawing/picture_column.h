// The column beside a picture: colour bar with ticks and unit, legend.
#pragma once

#include "src/drawing/picture.h"
#include "src/output/format.h"

namespace ligament::program
{
class PictureColumn
{
public:
  /// Letters of all texts of a picture but its title.
  static constexpr double text_size = 17, line_height = 25; // pixels
  static constexpr double gap = 30;                         // to the picture

  PictureColumn(const Picture &picture, const ValueRange &range);

  /// Pixels, the gap included; 0 when there is nothing to show.
  double width() const { return width_ > 0 ? width_ + gap : 0; }
  /// Pixels, for a body of this height.
  double height(double body) const;

  /// The upper left corner is at (x, y).
  void draw(Drawing &drawing, double x, double y, double body) const;

private:
  void bar(Drawing &drawing, double x, double top, double length) const;
  /// Whether values lie below and above the range.
  std::array<bool, 2> outside() const;

  const Picture &picture_;
  ValueRange range_;
  Prefix prefix_;
  std::string title_;
  bool has_bar_;
  double width_ = 0;
};
} // namespace ligament::program
