// One direction of the far-field mesh: base cells that fit the sections beside and inside the
// left-out box, and the whole numbers in which refinement counts distances.
#pragma once

#include <cstdint>
#include <vector>

namespace ligament::fem
{
/// The interval of the specimen, cut where the inner box begins and ends inside it. Each section
/// carries whole base cells of 2^levels finest cells; an index counts finest cells from the lower
/// end. All decisions about refinement are made in indices: they are exact.
class SectionedAxis
{
public:
  using Index = std::int64_t;

  /// Lengths in m; no inner box: inner_lower >= inner_upper. A section gets the number of base
  /// cells whose size comes nearest to base_size, at least one.
  SectionedAxis(double lower, double upper, double inner_lower, double inner_upper,
                double base_size, int levels);

  struct Section
  {
    double lower, upper; // m
    Index begin, n;      // finest cells
    bool inner;          // inside the left-out box, as far as this direction is concerned
  };

  Index n() const { return n_; }
  const std::vector<Section> &sections() const { return sections_; }
  bool meets_inner_box() const { return inner_begin_ >= 0; }
  /// Is there anything beside the inner box in this direction?
  bool leaves_room() const { return inner_end_ - inner_begin_ < n_; }

  /// Coordinate in m; the ends of the sections are met to the last bit.
  double position(Index i) const;
  /// Index of the nearest finest-cell border to a coordinate in m.
  Index index(double x) const;
  /// Size of the finest cell that begins at i, in m: equal to the last bit within a section.
  double finest_size(Index i) const;

  bool in_inner_box(Index i, Index n) const { return i >= inner_begin_ && i + n <= inner_end_; }
  /// Distance of the interval [i, i + n] from the inner box, 0 where they meet.
  Index distance(Index i, Index n) const;

private:
  Index n_ = 0, inner_begin_ = -1, inner_end_ = -1;
  std::vector<Section> sections_;
};
} // namespace ligament::fem
