// One direction of the far-field mesh: base cells that fit the sections beside and inside the
// left-out boxes, and the whole numbers in which refinement counts distances.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace ligament::fem
{
/// The interval of the specimen, cut where inner boxes begin and end inside it. Each section
/// carries whole base cells of 2^levels finest cells; an index counts finest cells from the lower
/// end. All decisions about refinement are made in indices: they are exact.
class SectionedAxis
{
public:
  using Index = std::int64_t;

  /// From the ends of a section that are cuts on: `fine` cells of the base size, then each `factor`
  /// times larger than the one before. Sections that a part covers stay uniform. Without levels.
  struct Growth
  {
    double factor = 1;
    int fine = 1;
    double largest = 0;                             // m, of a cell
    std::vector<std::pair<double, double>> covered; // m
  };

  /// Lengths in m; cuts on or beyond the ends are none. A section gets the number of base cells
  /// whose size comes nearest to base_size, at least one. Growing sections get as many cells as the
  /// factor asks for, and a factor that is smaller by what fits them in.
  SectionedAxis(double lower, double upper, std::vector<double> cuts, double base_size, int levels,
                const Growth &growth);

  struct Section
  {
    double lower, upper;                // m
    Index begin, n;                     // finest cells
    std::vector<double> sizes, borders; // m, of growing cells; borders without the section's ends
  };

  Index n() const { return n_; }
  const std::vector<Section> &sections() const { return sections_; }

  /// Coordinate in m; the ends of the sections are met to the last bit.
  double position(Index i) const;
  /// Index of the nearest finest-cell border to a coordinate in m.
  Index index(double x) const;
  /// Size of the finest cell that begins at i, in m: equal to the last bit within a section.
  double finest_size(Index i) const;

private:
  Index n_ = 0;
  std::vector<Section> sections_;
};
} // namespace ligament::fem
