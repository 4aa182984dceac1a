#include "fem/sectioned_axis.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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

std::vector<double> growing_sizes(int n, double size, double factor,
                                  const SectionedAxis::Growth &growth)
{
  std::vector<double> sizes(n, size);
  for (int i = growth.fine; i < n; ++i)
    sizes[i] = std::min(sizes[i - 1] * factor, growth.largest);
  return sizes;
}

/// Sizes from one end on that fill the length; none where equal cells fill it as well.
std::vector<double> fitted_sizes(double length, double size, const SectionedAxis::Growth &growth)
{
  const auto reach = [&](int n, double factor) {
    const auto sizes = growing_sizes(n, size, factor, growth);
    return std::accumulate(sizes.begin(), sizes.end(), 0.);
  };
  int n = 1;
  while (reach(n, growth.factor) < length)
    ++n;
  double low = 1, high = growth.factor;
  if (reach(n, low) >= length)
    return {};
  for (int i = 0; i < 60; ++i) { // halving until round-off
    const double middle = (low + high) / 2;
    (reach(n, middle) < length ? low : high) = middle;
  }
  return growing_sizes(n, size, high, growth);
}

void make_grow(SectionedAxis::Section &section, double base_size,
               const SectionedAxis::Growth &growth, bool from_lower, bool from_upper)
{
  const double length = section.upper - section.lower;
  const bool both = from_lower && from_upper;
  auto sizes = fitted_sizes(both ? length / 2 : length, base_size, growth);
  if (sizes.empty())
    return;
  const std::vector<double> mirrored(sizes.rbegin(), sizes.rend());
  if (both)
    sizes.insert(sizes.end(), mirrored.begin(), mirrored.end());
  section.sizes = from_lower ? sizes : mirrored;
  section.n = SectionedAxis::Index(section.sizes.size());
  double x = section.lower;
  for (std::size_t i = 0; i + 1 < section.sizes.size(); ++i)
    section.borders.push_back(x += section.sizes[i]);
}
} // namespace

SectionedAxis::SectionedAxis(double lower, double upper, std::vector<double> cuts, double base_size,
                             int levels, const Growth &growth)
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
    Section section = {ends[s], ends[s + 1], n_, n, {}, {}};
    const bool covered =
        std::any_of(growth.covered.begin(), growth.covered.end(), [&](const auto &part) {
          return part.first < ends[s] + margin && part.second > ends[s + 1] - margin;
        });
    if (growth.factor > 1 && !covered)
      make_grow(section, base_size, growth, s > 0, s + 2 < ends.size());
    n_ += section.n;
    sections_.push_back(std::move(section));
  }
}

double SectionedAxis::position(Index i) const
{
  const Section &s = find_section(sections_, [&](const Section &c) { return i <= c.begin + c.n; });
  if (i == s.begin + s.n)
    return s.upper;
  if (!s.borders.empty())
    return i == s.begin ? s.lower : s.borders[i - s.begin - 1];
  return s.lower + (s.upper - s.lower) * double(i - s.begin) / double(s.n);
}

SectionedAxis::Index SectionedAxis::index(double x) const
{
  const Section &s = find_section(sections_, [&](const Section &c) { return x <= c.upper; });
  if (!s.borders.empty()) {
    const auto above = std::lower_bound(s.borders.begin(), s.borders.end(), x);
    const Index i = above - s.borders.begin(); // borders[i - 1] < x <= borders[i]
    const double low = position(s.begin + i), high = position(s.begin + i + 1);
    return s.begin + i + (x - low < high - x ? 0 : 1);
  }
  return s.begin + std::llround((x - s.lower) / (s.upper - s.lower) * double(s.n));
}

double SectionedAxis::finest_size(Index i) const
{
  const Section &s = find_section(sections_, [&](const Section &c) { return i < c.begin + c.n; });
  return s.sizes.empty() ? (s.upper - s.lower) / double(s.n) : s.sizes[i - s.begin];
}

} // namespace ligament::fem
