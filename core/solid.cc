#include "core/solid.h"

#include "core/check.h"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace ligament::core
{
namespace
{
template <int dim>
std::string place(const Vector<dim> &x)
{
  return dim == 2 ? fmt::format("({:.6g}, {:.6g}) m", x[0], x[1])
                  : fmt::format("({:.6g}, {:.6g}, {:.6g}) m", x[0], x[1], x[dim - 1]);
}

/// Twice the area of a plane polygon times its normal.
Vector<3> area_vector(const std::vector<Vector<3>> &vertices,
                      const std::vector<std::array<int, 2>> &edges)
{
  Vector<3> sum = Vector<3>::Zero();
  const Vector<3> &origin = vertices[edges[0][0]];
  for (const auto &[a, b] : edges)
    sum += (vertices[a] - origin).cross(vertices[b] - origin);
  return sum;
}

/// Whether the point (u, v) is left of the edge in the half-open sense, so that of polygons that
/// share edges just one has a point.
bool crosses(double u, double v, double u_a, double v_a, double u_b, double v_b)
{
  if ((v_a > v) == (v_b > v))
    return false;
  if (v_a > v_b) // the same arithmetic whichever facet asks
    std::swap(u_a, u_b), std::swap(v_a, v_b);
  return u < u_a + (v - v_a) / (v_b - v_a) * (u_b - u_a);
}

Vector<3> foot_on_segment(const Vector<3> &a, const Vector<3> &b, const Vector<3> &x)
{
  const Vector<3> along = b - a;
  return a + std::clamp(along.dot(x - a) / along.squaredNorm(), 0., 1.) * along;
}
} // namespace

template <int dim>
Solid<dim>::Solid(std::vector<Vector<dim>> vertices, std::vector<Facet> facets)
    : vertices_(std::move(vertices)), facets_(std::move(facets))
{
  require(!facets_.empty(), "a body without surface");
  lower_ = upper_ = vertices_[facets_[0].edges[0][0]];
  for (const Facet &facet : facets_) {
    Vector<dim> least = vertices_[facet.edges[0][0]], most = least;
    for (const Edge &edge : facet.edges)
      for (const int v : edge) {
        least = least.cwiseMin(vertices_[v]);
        most = most.cwiseMax(vertices_[v]);
      }
    facet_lower_.push_back(least);
    facet_upper_.push_back(most);
    lower_ = lower_.cwiseMin(least);
    upper_ = upper_.cwiseMax(most);
    Vector<dim> n;
    if constexpr (dim == 2) {
      const Vector<2> along = vertices_[facet.edges[0][1]] - vertices_[facet.edges[0][0]];
      n = {along[1], -along[0]};
    } else
      n = area_vector(vertices_, facet.edges);
    require(n.norm() > 0, "a facet of the surface has no extent, at " + place<dim>(least));
    normal_.push_back(n.normalized());
  }
  check_closed();
  sort_into_bins();
}

template <int dim>
void Solid<dim>::check_closed() const
{
  if constexpr (dim == 2) {
    std::vector<int> balance(vertices_.size(), 0);
    for (const Facet &facet : facets_) {
      --balance[facet.edges[0][0]];
      ++balance[facet.edges[0][1]];
    }
    for (std::size_t v = 0; v < balance.size(); ++v)
      require(balance[v] == 0, "the outline is not closed at " + place<dim>(vertices_[v]));
  } else {
    std::map<std::pair<int, int>, int> edges; // from the lower to the higher number
    for (const Facet &facet : facets_)
      for (const auto &[a, b] : facet.edges)
        edges[std::minmax(a, b)] += a < b ? 1 : -1;
    for (const auto &[edge, balance] : edges)
      require(balance == 0,
              fmt::format("the surface has a gap, or facets that face the wrong way, between {} "
                          "and {}",
                          place<dim>(vertices_[edge.first]), place<dim>(vertices_[edge.second])));
  }
}

template <int dim>
void Solid<dim>::sort_into_bins()
{
  const Vector<dim> size = upper_ - lower_;
  double mean = 0;
  for (std::size_t f = 0; f < facets_.size(); ++f)
    mean += (facet_upper_[f] - facet_lower_[f]).norm() / double(facets_.size());
  bin_ = std::max(2 * mean, size.maxCoeff() / (dim == 2 ? 512 : 128));
  std::size_t n = 1;
  for (int a = 0; a < dim; ++a) {
    n_bins_[a] = std::max(1, int(std::ceil(size[a] / bin_)));
    n *= n_bins_[a];
  }
  in_bin_.resize(n);
  in_column_.resize(n / n_bins_[0]);
  for (int f = 0; f < int(facets_.size()); ++f) {
    const Index first = bin_of(facet_lower_[f]), last = bin_of(facet_upper_[f]);
    const bool has_extent = (facet_upper_[f] - facet_lower_[f]).tail(dim - 1).norm() > 0;
    for (int z = dim == 3 ? first[dim - 1] : 0; z <= (dim == 3 ? last[dim - 1] : 0); ++z)
      for (int y = first[1]; y <= last[1]; ++y) {
        const std::size_t column = std::size_t(z) * n_bins_[1] + y;
        if (has_extent)
          in_column_[column].push_back(f);
        for (int x = first[0]; x <= last[0]; ++x)
          in_bin_[column * n_bins_[0] + x].push_back(f);
      }
  }
}

template <int dim>
auto Solid<dim>::bin_of(const Vector<dim> &x) const -> Index
{
  Index k;
  for (int a = 0; a < dim; ++a)
    k[a] = int(std::clamp(std::floor((x[a] - lower_[a]) / bin_), 0., n_bins_[a] - 1.));
  return k;
}

template <int dim>
std::vector<int> Solid<dim>::near(const Vector<dim> &lower, const Vector<dim> &upper) const
{
  std::vector<int> found;
  if (((upper - lower_).array() < 0).any() || ((upper_ - lower).array() < 0).any())
    return found;
  const Index first = bin_of(lower), last = bin_of(upper);
  for (int z = dim == 3 ? first[dim - 1] : 0; z <= (dim == 3 ? last[dim - 1] : 0); ++z)
    for (int y = first[1]; y <= last[1]; ++y)
      for (int x = first[0]; x <= last[0]; ++x)
        for (const int f : in_bin_[(std::size_t(z) * n_bins_[1] + y) * n_bins_[0] + x])
          if (((facet_lower_[f] - upper).array() <= 0).all() &&
              ((lower - facet_upper_[f]).array() <= 0).all())
            found.push_back(f);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

template <int dim>
bool Solid<dim>::contains(const Vector<dim> &x) const
{
  if (((x - lower_).array() < 0).any() || ((upper_ - x).array() < 0).any())
    return false;
  const Index k = bin_of(x);
  const std::size_t column = dim == 2 ? k[1] : std::size_t(k[dim - 1]) * n_bins_[1] + k[1];
  bool inside = false; // a ray along x leaves the body as often as it enters it, and once more
  for (const int f : in_column_[column]) {
    const std::vector<Edge> &edges = facets_[f].edges;
    if constexpr (dim == 2) {
      const Vector<2> &a = vertices_[edges[0][0]], &b = vertices_[edges[0][1]];
      inside ^= crosses(x[0], x[1], a[0], a[1], b[0], b[1]);
    } else {
      if (normal_[f][0] == 0)
        continue;
      bool in_shadow = false;
      for (const auto &[from, to] : edges) {
        const Vector<3> &a = vertices_[from], &b = vertices_[to];
        in_shadow ^= crosses(x[1], x[2], a[1], a[2], b[1], b[2]);
      }
      const Vector<3> &a = vertices_[edges[0][0]];
      const double at =
          a[0] - (normal_[f][1] * (x[1] - a[1]) + normal_[f][2] * (x[2] - a[2])) / normal_[f][0];
      inside ^= in_shadow && x[0] < at;
    }
  }
  return inside;
}

template <int dim>
Vector<dim> Solid<dim>::foot_on(int facet, const Vector<dim> &x) const
{
  const std::vector<Edge> &edges = facets_[facet].edges;
  if constexpr (dim == 2) {
    const Vector<2> &a = vertices_[edges[0][0]], along = vertices_[edges[0][1]] - a;
    return a + std::clamp(along.dot(x - a) / along.squaredNorm(), 0., 1.) * along;
  } else {
    const Vector<3> &n = normal_[facet];
    const Vector<3> foot = x - n.dot(x - vertices_[edges[0][0]]) * n;
    // Inside a polygon of any shape where a ray in its plane crosses its edge an odd number of
    // times.
    int drop;
    n.cwiseAbs().maxCoeff(&drop);
    const int u = (drop + 1) % 3, v = (drop + 2) % 3;
    bool inside = false;
    Vector<3> nearest = foot;
    double least = 1e300;
    for (const auto &[from, to] : edges) {
      const Vector<3> &a = vertices_[from], &b = vertices_[to];
      inside ^= crosses(foot[u], foot[v], a[u], a[v], b[u], b[v]);
      const Vector<3> on_edge = foot_on_segment(a, b, x);
      if (const double d = (on_edge - x).squaredNorm(); d < least) {
        least = d;
        nearest = on_edge;
      }
    }
    return inside ? foot : nearest;
  }
}

template <int dim>
auto Solid<dim>::nearest(const Vector<dim> &x, double limit) const -> Foot
{
  for (double reach = std::min(bin_, limit);; reach = std::min(2 * reach, limit)) {
    Foot best{-1, Vector<dim>::Zero(), limit};
    const Vector<dim> all = Vector<dim>::Constant(reach);
    for (const int f : near(x - all, x + all)) {
      const Vector<dim> foot = foot_on(f, x);
      const double d = (foot - x).norm();
      if (d < best.distance || (best.facet < 0 && d <= limit))
        best = {f, foot, d};
    }
    if (reach >= limit || (best.facet >= 0 && best.distance <= reach))
      return best;
  }
}

template <int dim>
double Solid<dim>::distance(const Vector<dim> &x, double limit) const
{
  return (contains(x) ? 1 : -1) * nearest(x, limit).distance;
}

template <int dim>
double Solid<dim>::volume() const
{
  double sum = 0;
  const Vector<dim> middle = (lower_ + upper_) / 2;
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const std::vector<Edge> &edges = facets_[f].edges;
    const Vector<dim> a = vertices_[edges[0][0]] - middle;
    if constexpr (dim == 2) {
      const Vector<2> b = vertices_[edges[0][1]] - middle;
      sum += (a[0] * b[1] - a[1] * b[0]) / 2;
    } else
      sum += a.dot(area_vector(vertices_, edges)) / 6;
  }
  return sum;
}

template class Solid<2>;
template class Solid<3>;
} // namespace ligament::core
