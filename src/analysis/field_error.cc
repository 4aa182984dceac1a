#include "src/analysis/field_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <vector>

namespace ligament::program
{
namespace
{
using Bin = std::array<std::int64_t, 3>;

struct BinHash
{
  std::size_t operator()(const Bin &b) const
  {
    return std::size_t(b[0] * 73856093 ^ b[1] * 19349663 ^ b[2] * 83492791);
  }
};

/// Index in `b` of the particle at the same place as particle i of `a`, or -1.
class Matcher
{
public:
  explicit Matcher(const Snapshot &b) : b_(b), size_(0.5 * b.spacing)
  {
    for (std::size_t i = 0; i < b.size(); ++i)
      bins_[bin(&b.reference[i * b.dimension], {})].push_back(i);
  }

  std::int64_t find(const double *x) const
  {
    const double tolerance = 1e-3 * b_.spacing;
    // The eight corners of the box of the tolerance name all bins that it touches.
    for (int corner = 0; corner < 1 << b_.dimension; ++corner) {
      std::array<double, 3> shift = {};
      for (int c = 0; c < b_.dimension; ++c)
        shift[c] = corner >> c & 1 ? tolerance : -tolerance;
      const auto found = bins_.find(bin(x, shift));
      if (found == bins_.end())
        continue;
      for (const std::size_t i : found->second) {
        double largest = 0;
        for (int c = 0; c < b_.dimension; ++c)
          largest = std::max(largest, std::abs(b_.reference[i * b_.dimension + c] - x[c]));
        if (largest <= tolerance)
          return std::int64_t(i);
      }
    }
    return -1;
  }

private:
  Bin bin(const double *x, const std::array<double, 3> &shift) const
  {
    Bin result = {};
    for (int c = 0; c < b_.dimension; ++c)
      result[c] = std::int64_t(std::floor((x[c] + shift[c]) / size_));
    return result;
  }

  const Snapshot &b_;
  double size_;
  std::unordered_map<Bin, std::vector<std::size_t>, BinHash> bins_;
};

struct Norms
{
  double difference2 = 0, value2 = 0, difference_max = 0, value_max = 0;

  void add(const double *a, const double *b, int dimension)
  {
    double d2 = 0, v2 = 0;
    for (int c = 0; c < dimension; ++c) {
      d2 += (a[c] - b[c]) * (a[c] - b[c]);
      v2 += b[c] * b[c];
    }
    difference2 += d2;
    value2 += v2;
    difference_max = std::max(difference_max, std::sqrt(d2));
    value_max = std::max(value_max, std::sqrt(v2));
  }
  std::optional<double> mean() const
  {
    return value2 > 0 ? std::optional(std::sqrt(difference2 / value2)) : std::nullopt;
  }
  std::optional<double> largest() const
  {
    return value_max > 0 ? std::optional(difference_max / value_max) : std::nullopt;
  }
};
} // namespace

FieldError field_error(const Snapshot &run, const Snapshot &reference)
{
  FieldError error;
  if (run.dimension != reference.dimension || !(reference.spacing > 0))
    return error;
  const Matcher matcher(reference);
  const int dim = run.dimension;
  Norms displacement, velocity;
  for (std::size_t i = 0; i < run.size(); ++i) {
    const std::int64_t j = matcher.find(&run.reference[i * dim]);
    if (j < 0)
      continue;
    ++error.matched;
    displacement.add(&run.displacement[i * dim], &reference.displacement[j * dim], dim);
    velocity.add(&run.velocity[i * dim], &reference.velocity[j * dim], dim);
  }
  error.displacement = displacement.mean();
  error.displacement_max = displacement.largest();
  error.velocity = velocity.mean();
  error.velocity_max = velocity.largest();
  return error;
}
} // namespace ligament::program
