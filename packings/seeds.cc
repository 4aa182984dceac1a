#include "packings/seeds.h"

#include "core/check.h"
#include "core/counter_random.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ligament::packings
{
namespace
{
using core::random_number;

/// Bits of one component of the number of a cube; names stay below 2^53, so that they pass through
/// tables of doubles unharmed.
template <int dim>
constexpr int n_bits = dim == 2 ? 26 : 17;

/// Interleaves the bits of the components: neighbours in space become neighbours in order.
template <int dim>
std::int64_t z_order(const Eigen::Matrix<std::int64_t, dim, 1> &k)
{
  constexpr int bits = n_bits<dim>;
  std::int64_t code = 0;
  for (int b = 0; b < bits; ++b)
    for (int a = 0; a < dim; ++a)
      code |= ((k[a] + (std::int64_t(1) << (bits - 1))) >> b & 1) << (dim * b + a);
  return code;
}
} // namespace

template <int dim>
double mean_cell_volume(double spacing)
{
  return dim == 2 ? std::sqrt(3.) / 2 * spacing * spacing
                  : spacing * spacing * spacing / std::sqrt(2.);
}

template <int dim>
Seeds<dim> sorted_by_id(Seeds<dim> seeds)
{
  if (std::is_sorted(seeds.id.begin(), seeds.id.end()))
    return seeds;
  std::vector<int> order(seeds.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return seeds.id[a] < seeds.id[b]; });
  Seeds<dim> sorted;
  for (const int i : order)
    sorted.add(seeds.centre[i], seeds.radius[i], seeds.id[i]);
  return sorted;
}

template <int dim>
double mean_distance(double spacing)
{
  return std::pow(mean_cell_volume<dim>(spacing), 1. / dim);
}

template <int dim>
std::string place_text(const Vector<dim> &x)
{
  std::string text = fmt::format("{:.6g}", x[0]);
  for (int a = 1; a < dim; ++a)
    text += fmt::format(", {:.6g}", x[a]);
  return text;
}

template <int dim>
Seeds<dim> draw_seeds(const SpecimenShape<dim> &shape, double spacing, int seed, double size_ratio,
                      const Vector<dim> &lower, const Vector<dim> &upper)
{
  using Index = Eigen::Matrix<std::int64_t, dim, 1>;
  const double side = mean_distance<dim>(spacing);
  const double log_ratio = std::log(size_ratio);
  // Mean of (r / r_min)^dim for r / r_min = size_ratio^u, u uniform in [0, 1].
  const double mean = log_ratio > 0 ? (std::pow(size_ratio, dim) - 1) / (dim * log_ratio) : 1.;
  const double smallest = spacing / 2 / std::pow(mean, 1. / dim);

  const Vector<dim> origin = (shape.lower + shape.upper) / 2;
  Index first, last;
  for (int a = 0; a < dim; ++a) {
    const double begin = (std::max(lower[a], shape.lower[a]) - origin[a]) / side,
                 end = (std::min(upper[a], shape.upper[a]) - origin[a]) / side;
    core::require(std::max(-begin, end) < (1 << (n_bits<dim> - 1)) - 1,
                  "the specimen has too many particles in one direction: make the spacing larger");
    first[a] = std::int64_t(std::floor(begin));
    last[a] = std::int64_t(std::floor(end));
  }
  Seeds<dim> seeds;
  std::vector<std::pair<std::int64_t, Vector<dim>>> drawn;
  for (Index k = first; k[dim - 1] <= last[dim - 1];) {
    const std::int64_t name = z_order<dim>(k);
    Vector<dim> x = origin;
    for (int a = 0; a < dim; ++a)
      x[a] += side * (double(k[a]) + random_number(seed, name, a));
    if (shape.distance(x) > 0)
      drawn.push_back({name, x});
    for (int a = 0; a < dim; ++a) {
      if (++k[a] <= last[a] || a == dim - 1)
        break;
      k[a] = first[a];
    }
  }
  std::sort(drawn.begin(), drawn.end(),
            [](const auto &a, const auto &b) { return a.first < b.first; });
  for (const auto &[name, x] : drawn)
    seeds.add(x, smallest * std::pow(size_ratio, random_number(seed, name, dim)), name);
  return seeds;
}

template double mean_cell_volume<2>(double);
template double mean_cell_volume<3>(double);
template Seeds<2> sorted_by_id(Seeds<2>);
template Seeds<3> sorted_by_id(Seeds<3>);
template double mean_distance<2>(double);
template double mean_distance<3>(double);
template std::string place_text<2>(const Vector<2> &);
template std::string place_text<3>(const Vector<3> &);
template Seeds<2> draw_seeds(const SpecimenShape<2> &, double, int, double, const Vector<2> &,
                             const Vector<2> &);
template Seeds<3> draw_seeds(const SpecimenShape<3> &, double, int, double, const Vector<3> &,
                             const Vector<3> &);
} // namespace ligament::packings
