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

SectionedAxis::SectionedAxis(double lower, double upper, double inner_lower, double inner_upper,
                             double base_size, int levels)
{
  // A face of the box that touches the specimen's side up to round-off doesn't cut it.
  const double margin = 1e-9 * (upper - lower);
  std::vector<double> ends{lower};
  for (const double cut : {inner_lower, inner_upper})
    if (inner_lower < inner_upper && cut > lower + margin && cut < upper - margin)
      ends.push_back(cut);
  ends.push_back(upper);
  for (std::size_t s = 0; s + 1 < ends.size(); ++s) {
    const double length = ends[s + 1] - ends[s], middle = ends[s] + length / 2;
    const bool inner = middle > inner_lower && middle < inner_upper;
    const Index n = std::max<Index>(1, std::llround(length / base_size)) << levels;
    sections_.push_back({ends[s], ends[s + 1], n_, n, inner});
    if (inner) {
      inner_begin_ = n_;
      inner_end_ = n_ + n;
    }
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

SectionedAxis::Index SectionedAxis::distance(Index i, Index n) const
{
  return std::max({Index(0), inner_begin_ - (i + n), i - inner_end_});
}
} // namespace ligament::fem
