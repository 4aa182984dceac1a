#include "packings/power_diagram.h"

#include "core/check.h"
#include "packings/rank_share.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <queue>

namespace ligament::packings
{
namespace
{
constexpr int reach = 12; // bins
}

template <int dim>
PowerDiagram<dim>::PowerDiagram(const Seeds<dim> &seeds, double bin) : seeds_(seeds), bin_(bin)
{
  if (seeds.size() == 0)
    return;
  Vector<dim> upper = lower_ = seeds.centre[0];
  for (int i = 0; i < seeds.size(); ++i) {
    lower_ = lower_.cwiseMin(seeds.centre[i]);
    upper = upper.cwiseMax(seeds.centre[i]);
    largest_radius_ = std::max(largest_radius_, seeds.radius[i]);
  }
  // Bins lie on one grid whatever the seeds, so that cells are cut in the same order to the same
  // last bit in a part of the specimen and in the whole.
  for (int a = 0; a < dim; ++a) {
    lower_[a] = bin * std::floor(lower_[a] / bin);
    n_bins_[a] = int((upper[a] - lower_[a]) / bin) + 1;
  }
  const auto place = [&](int i) {
    const Index k = bin_of(seeds.centre[i]);
    std::int64_t bin_number = k[dim - 1];
    for (int a = dim - 2; a >= 0; --a)
      bin_number = bin_number * n_bins_[a] + k[a];
    return bin_number;
  };
  first_.assign(n_bins_.template cast<std::int64_t>().prod() + 1, 0);
  for (int i = 0; i < seeds.size(); ++i)
    ++first_[place(i) + 1];
  for (std::size_t b = 1; b < first_.size(); ++b)
    first_[b] += first_[b - 1];
  seed_in_bin_.resize(seeds.size());
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for (int i = 0; i < seeds.size(); ++i)
    seed_in_bin_[next[place(i)]++] = i;

  const int width = 2 * reach + 1;
  for (int n = 0; n < (dim == 2 ? 1 : width) * width * width; ++n) {
    Index k;
    double square = 0;
    for (int a = 0, rest = n; a < dim; ++a, rest /= width) {
      k[a] = rest % width - reach;
      const int gap = std::max(std::abs(k[a]) - 1, 0);
      square += gap * gap;
    }
    if (square < (reach - 1) * (reach - 1))
      steps_.push_back({std::sqrt(square), k});
  }
  std::stable_sort(steps_.begin(), steps_.end(),
                   [](const Step &a, const Step &b) { return a.distance < b.distance; });
}

template <int dim>
auto PowerDiagram<dim>::bin_of(const Vector<dim> &x) const -> Index
{
  Index k;
  for (int a = 0; a < dim; ++a)
    k[a] = std::clamp(int((x[a] - lower_[a]) / bin_), 0, n_bins_[a] - 1);
  return k;
}

template <int dim>
template <typename GoOn, typename Visit>
void PowerDiagram<dim>::for_each_near(int i, GoOn &&go_on, Visit &&visit) const
{
  const Vector<dim> &x = seeds_.centre[i];
  const Index home = bin_of(x);
  for (const Step &step : steps_) {
    if (!go_on(step.distance * bin_))
      return;
    const Index k = home + step.offset;
    double square = 0; // from x to the bin
    for (int a = 0; a < dim; ++a) {
      const double s = x[a] - lower_[a] - bin_ * k[a];
      const double gap = std::max({-s, s - bin_, 0.});
      square += gap * gap;
    }
    if ((k.array() < 0).any() || (k.array() >= n_bins_.array()).any() || !go_on(std::sqrt(square)))
      continue;
    std::int64_t bin_number = k[dim - 1];
    for (int a = dim - 2; a >= 0; --a)
      bin_number = bin_number * n_bins_[a] + k[a];
    for (int n = first_[bin_number]; n < first_[bin_number + 1]; ++n)
      if (const int j = seed_in_bin_[n]; j != i) {
        const Vector<dim> r = seeds_.centre[j] - x;
        visit(j, r, r.norm());
      }
  }
}

template <int dim>
void PowerDiagram<dim>::cut(VoronoiCell<dim> &cell, int i) const
{
  const double own = seeds_.radius[i] * seeds_.radius[i];
  const auto to_face = [&](double r, double radius) {
    return r / 2 + (own - radius * radius) / (2 * r);
  };
  // Farther seeds have farther faces: the largest radius is at least the own one.
  const auto go_on = [&](double r) {
    return r == 0 || to_face(r, largest_radius_) < cell.max_radius();
  };
  for_each_near(i, go_on, [&](int j, const Vector<dim> &r, double distance) {
    core::require(distance > 0,
                  fmt::format("particles {} and {} lie at the same place", i + 1, j + 1));
    const double q = to_face(distance, seeds_.radius[j]);
    if (q < cell.max_radius()) {
      const Vector<dim> normal = r / distance;
      if (cell.is_cut_by(normal, q))
        cell.clip(normal, q, j);
    }
  });
}

// The weight of j may exceed that of i by D^2 - 2 D q at most, or the face between them comes
// nearer than q to i. Seeds in the order of their weights, smallest first, bound the weights of the
// others: the shortest-path algorithm of E. W. Dijkstra (1959), with one answer whatever the order
// of equals. It begins with those that bound others by the weight that they have: the rest say
// nothing before theirs is made smaller.
template <int dim>
int heal_radii(Seeds<dim> &seeds, double bin, const core::Ranks &ranks)
{
  const auto [least, most] = std::minmax_element(seeds.radius.begin(), seeds.radius.end());
  if (seeds.size() == 0 || *least == *most)
    return 0;
  const PowerDiagram<dim> diagram(seeds, bin);
  const std::vector<double> radius = seeds.radius;
  const double largest = *most * *most;
  std::vector<double> weight;
  for (const double r : radius)
    weight.push_back(r * r);
  // Of the weights of others by one of weight w.
  const auto bound = [&](int i, double w, double r) {
    return w + std::max(0., r * r - 2 * r * std::min(radius[i] / 2, r / 4));
  };
  // Round-off of a seed that was healed before must not count as a change.
  const auto exceeds = [&](int j, double most_of_j) { return weight[j] > most_of_j * (1 + 1e-14); };
  std::vector<int> begin;
  const auto [first, last] = share_of(weight.size(), ranks);
  for (int i = int(first); i < int(last); ++i) {
    bool bounds_one = false;
    diagram.for_each_near(
        i, [&](double r) { return !bounds_one && bound(i, weight[i], r) < largest; },
        [&](int j, const Vector<dim> &, double r) {
          bounds_one = bounds_one || exceeds(j, bound(i, weight[i], r));
        });
    if (bounds_one)
      begin.push_back(i);
  }
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (const int i : ranks.gather_all(begin))
    queue.push({weight[i], i});
  std::vector<char> is_smaller(seeds.size(), 0);
  while (!queue.empty()) {
    const auto [w, i] = queue.top();
    queue.pop();
    if (w > weight[i])
      continue;
    diagram.for_each_near(
        i, [&, w = w, i = i](double r) { return bound(i, w, r) < largest; },
        [&, w = w, i = i](int j, const Vector<dim> &, double r) {
          if (const double most_of_j = bound(i, w, r); exceeds(j, most_of_j)) {
            weight[j] = most_of_j;
            is_smaller[j] = 1;
            queue.push({most_of_j, j});
          }
        });
  }
  for (int i = 0; i < seeds.size(); ++i)
    if (is_smaller[i])
      seeds.radius[i] = std::sqrt(weight[i]);
  return int(std::count(is_smaller.begin(), is_smaller.end(), 1));
}

template class PowerDiagram<2>;
template class PowerDiagram<3>;
template int heal_radii(Seeds<2> &, double, const core::Ranks &);
template int heal_radii(Seeds<3> &, double, const core::Ranks &);
} // namespace ligament::packings
