#include "fem/sectioned_axis.h"

#include <algorithm>
#include <cmath>

namespace ligament::fem
{
namespace
{
/// The first section for which the condition holds; the last one for points beyond the end.
template <typename Condition>
const SectionedAxis::Section &find_section(const std::vector<SectionedAxis::Section> &sections,
                                           Condition condition)
{
  const auto s = std::find_if(sections.begin(), sections.end(), condition);
  return s == sections.end() ? sections.back() : *s;
}
} // namespace

SectionedAxis::SectionedAxis(double lower, double upper, std::vector<double> cuts, double base_size,
                             int levels)
{
  // A face of a box that touches the specimen's side, or another box's face, up to round-off
  // doesn't cut.
  const double margin = 1e-9 * (upper - lower);
  std::sort(cuts.begin(), cuts.end());
  std::vector<double> ends{lower};
  for (const double cut : cuts)
    if (cut > ends.back() + margin && cut < upper - margin)
      ends.push_back(cut);
  ends.push_back(upper);
  for (std::size_t s = 0; s + 1 < ends.size(); ++s) {
    const double length = ends[s + 1] - ends[s];
    const Index n = std::max<Index>(1, std::llround(length / base_size)) << levels;
    sections_.push_back({ends[s], ends[s + 1], n_, n});
    n_ += n;
  }
}

double SectionedAxis::position(Index i) const
{
  const Section &s = find_section(sections_, [&](const Section &c) { return i <= c.begin + c.n; });
  if (i == s.begin + s.n)
    return s.upper;
  return s.lower + (s.upper - s.lower) * double(i - s.begin) / double(s.n);
}

SectionedAxis::Index SectionedAxis::index(double x) const
{
  const Section &s = find_section(sections_, [&](const Section &c) { return x <= c.upper; });
  return s.begin + std::llround((x - s.lower) / (s.upper - s.lower) * double(s.n));
}

double SectionedAxis::finest_size(Index i) const
{
  const Section &s = find_section(sections_, [&](const Section &c) { return i < c.begin + c.n; });
  return (s.upper - s.lower) / double(s.n);
}

} // namespace ligament::fem
