#include "packings/specimen_shape.h"

#include "core/check.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ligament::packings
{
template <int dim>
Void<dim> Void<dim>::disc(const DiscHole<dim> &hole, double side)
{
  Void result;
  result.centre_ = hole.centre;
  result.radius_ = hole.radius;
  if constexpr (dim == 2) {
    const int n = 4 * std::max(3, int(std::ceil(M_PI / 2 * hole.radius / side)));
    // Area n a^2 tan(pi/n) of the polygon with apothem a = area of the disc.
    const double apothem = hole.radius * std::sqrt(M_PI / (n * std::tan(M_PI / n)));
    for (int k = 0; k < n; ++k) {
      const double angle = 2 * M_PI * (k + 0.5) / n;
      const Vector<dim> normal(std::cos(angle), std::sin(angle));
      result.sides.push_back({normal, normal.dot(hole.centre) + apothem});
    }
  }
  return result;
}

template <int dim>
Void<dim> Void<dim>::box(const BoxNotch<dim> &notch)
{
  Void result;
  result.centre_ = (notch.lower + notch.upper) / 2;
  result.half_size_ = (notch.upper - notch.lower) / 2;
  for (int a = 0; a < dim; ++a) {
    result.sides.push_back({-Vector<dim>::Unit(a), -notch.lower[a]});
    result.sides.push_back({Vector<dim>::Unit(a), notch.upper[a]});
  }
  return result;
}

template <int dim>
double Void<dim>::distance(const Vector<dim> &x) const
{
  const Vector<dim> beyond = (x - centre_).cwiseAbs() - half_size_;
  return beyond.cwiseMax(0).norm() + std::min(0., beyond.maxCoeff()) - radius_;
}

template <int dim>
bool Void<dim>::contains(const Vector<dim> &x, double tolerance) const
{
  for (const HalfSpace<dim> &side : sides)
    if (side.normal.dot(x) > side.offset - tolerance)
      return false;
  return true;
}

template <int dim>
bool Void<dim>::hides(const Vector<dim> &a, const Vector<dim> &b, double depth) const
{
  double begin = 0, end = 1; // of the part a + s (b - a) inside all sides
  for (const HalfSpace<dim> &side : sides) {
    const double excess_a = side.normal.dot(a) - side.offset + depth;
    const double excess_b = side.normal.dot(b) - side.offset + depth;
    if (excess_a > 0 && excess_b > 0)
      return false;
    if (excess_a > 0)
      begin = std::max(begin, excess_a / (excess_a - excess_b));
    else if (excess_b > 0)
      end = std::min(end, excess_a / (excess_a - excess_b));
  }
  return begin < end;
}

template <int dim>
VoidGrid<dim>::VoidGrid(const std::vector<Void<dim>> &voids, const Vector<dim> &lower,
                        const Vector<dim> &upper, double reach)
    : all_(voids.size()), lower_(lower), reach_(reach)
{
  std::iota(all_.begin(), all_.end(), 0);
  bin_ = std::max(2 * reach, (upper - lower).maxCoeff() / (dim == 2 ? 500 : 60));
  std::size_t n = 1;
  for (int a = 0; a < dim; ++a)
    n *= n_bins_[a] = std::max(1, int(std::ceil((upper[a] - lower[a]) / bin_)));
  if (voids.size() < 8)
    return; // a look at all of them is as fast
  near_.resize(n);
  for (const int v : all_) {
    // Bins at the border hold what lies beyond it.
    std::array<int, dim> first, last;
    for (int a = 0; a < dim; ++a) {
      const double at = voids[v].centre()[a] - lower[a], half = voids[v].half_size()[a] + reach;
      first[a] = int(std::clamp(std::floor((at - half) / bin_), 0., n_bins_[a] - 1.));
      last[a] = int(std::clamp(std::floor((at + half) / bin_), 0., n_bins_[a] - 1.));
    }
    for (std::array<int, dim> k = first;;) {
      std::size_t bin = 0;
      for (int a = dim - 1; a >= 0; --a)
        bin = bin * n_bins_[a] + k[a];
      near_[bin].push_back(v);
      int a = 0;
      while (a < dim && k[a] == last[a])
        k[a] = first[a], ++a;
      if (a == dim)
        break;
      ++k[a];
    }
  }
}

template <int dim>
const std::vector<int> &VoidGrid<dim>::within(const Vector<dim> &x, double distance) const
{
  if (near_.empty() || distance > reach_)
    return all_;
  std::size_t bin = 0;
  for (int a = dim - 1; a >= 0; --a)
    bin = bin * n_bins_[a] +
          std::size_t(std::clamp(std::floor((x[a] - lower_[a]) / bin_), 0., n_bins_[a] - 1.));
  return near_[bin];
}

template <int dim>
CrackPlane<dim>::CrackPlane(const CrackPoints<dim> &points, double tolerance)
    : tolerance_(tolerance)
{
  const std::size_t n = points.size();
  if constexpr (dim == 2) {
    core::require(n == 2 && (points[1] - points[0]).norm() > tolerance,
                  "a crack in 2D is a segment between two different points");
    const Vector<2> tangent = (points[1] - points[0]).normalized();
    plane_.normal = {-tangent[1], tangent[0]};
    rim_ = {{-tangent, -tangent.dot(points[0])}, {tangent, tangent.dot(points[1])}};
  } else {
    const std::string shape = "a crack in 3D is a convex plane polygon of three or more points";
    core::require(n >= 3, shape);
    Vector<3> area = Vector<3>::Zero();
    for (std::size_t k = 2; k < n; ++k)
      area += (points[k - 1] - points[0]).cross(points[k] - points[0]) / 2;
    core::require(area.norm() > tolerance * tolerance, shape);
    plane_.normal = area.normalized();
    for (std::size_t k = 0; k < n; ++k) {
      const Vector<3> edge = points[(k + 1) % n] - points[k];
      core::require(edge.norm() > tolerance, shape);
      const Vector<3> outward = edge.cross(plane_.normal).normalized();
      rim_.push_back({outward, outward.dot(points[k])});
    }
    const double slack = 1e-6 * std::sqrt(area.norm());
    for (const Vector<3> &x : points) {
      core::require(std::abs(plane_.normal.dot(x - points[0])) < slack, shape);
      for (const HalfSpace<3> &edge : rim_)
        core::require(edge.normal.dot(x) < edge.offset + slack, shape);
    }
  }
  plane_.offset = plane_.normal.dot(points[0]);
}

template <int dim>
bool CrackPlane<dim>::is_crossed_by(const Vector<dim> &a, const Vector<dim> &b) const
{
  const double height_a = height(a), height_b = height(b);
  if ((height_a > -tolerance_) == (height_b > -tolerance_))
    return false;
  return is_beside(a + height_a / (height_a - height_b) * (b - a));
}

template <int dim>
bool CrackPlane<dim>::is_beside(const Vector<dim> &x) const
{
  return std::all_of(rim_.begin(), rim_.end(), [&](const HalfSpace<dim> &edge) {
    return edge.normal.dot(x) <= edge.offset + tolerance_;
  });
}

template <int dim>
int first_crossed(const std::vector<CrackPlane<dim>> &cracks, const Vector<dim> &a,
                  const Vector<dim> &b)
{
  const auto crossed = std::find_if(cracks.begin(), cracks.end(),
                                    [&](const auto &crack) { return crack.is_crossed_by(a, b); });
  return crossed == cracks.end() ? -1 : int(crossed - cracks.begin());
}

template <int dim>
SpecimenShape<dim>::SpecimenShape(const SpecimenParameters<dim> &p)
    : lower(p.lower), upper(p.upper), spacing(p.spacing), solid(p.solid)
{
  const double d = spacing;
  core::require(d > 0 && std::isfinite(d), "the spacing of a packing must be positive");
  core::require(p.thickness > 0, "the thickness of a packing must be positive");
  for (int a = 0; a < dim; ++a)
    core::require(
        upper[a] - lower[a] >= 2 * d,
        "the specimen is thinner than two particles: make it larger or the spacing smaller");
  core::require(dim == 2 || p.holes.empty(), "holes are not supported in 3D: use notches");
  for (const DiscHole<dim> &hole : p.holes) {
    core::require(hole.radius >= d, "the radius of a hole is smaller than the spacing: make the "
                                    "spacing smaller or leave out the hole");
    voids.push_back(Void<dim>::disc(hole, d / 2));
  }
  for (BoxNotch<dim> notch : p.notches) {
    for (int a = 0; a < dim; ++a) {
      core::require(notch.upper[a] - notch.lower[a] >= d * (1 - 1e-9),
                    "a notch is narrower than the spacing: widen it, make the spacing smaller or "
                    "make it a crack");
      // Open ends reach well out, lest the mouth lies on the surface but for round-off.
      if (notch.lower[a] <= lower[a] + 1e-9 * d)
        notch.lower[a] = std::min(notch.lower[a], lower[a] - 10 * d);
      if (notch.upper[a] >= upper[a] - 1e-9 * d)
        notch.upper[a] = std::max(notch.upper[a], upper[a] + 10 * d);
    }
    voids.push_back(Void<dim>::box(notch));
  }
  int n_sides = 0;
  for (const Void<dim> &v : voids) {
    n_sides_before.push_back(n_sides);
    n_sides += int(v.sides.size());
  }
  grid = VoidGrid<dim>(voids, lower, upper, 4 * d);
  for (const CrackPoints<dim> &points : p.cracks)
    cracks.emplace_back(points, 1e-9 * d);
  if (solid)
    pieces = std::make_shared<SolidPieces<dim>>(*solid, first_facet, 4 * d);
}

template <int dim>
double SpecimenShape<dim>::distance(const Vector<dim> &x) const
{
  double nearest = solid ? solid->distance(x, 4 * spacing)
                         : std::min((x - lower).minCoeff(), (upper - x).minCoeff());
  for (const int v : grid.within(x, 4 * spacing))
    nearest = std::min(nearest, voids[v].distance(x));
  return nearest;
}

template <int dim>
bool SpecimenShape<dim>::leaves_solid(const Vector<dim> &a, const Vector<dim> &b,
                                      double depth) const
{
  // The distance changes by at most the way between two places.
  const double length = (b - a).norm();
  for (double at = 0; solid && at < length;) {
    const double inside = solid->distance(a + at / length * (b - a), 4 * spacing);
    if (inside < -depth)
      return true;
    at += std::max(0.02 * spacing, inside + depth);
  }
  return false;
}

template class Void<2>;
template class Void<3>;
template class VoidGrid<2>;
template class VoidGrid<3>;
template class CrackPlane<2>;
template class CrackPlane<3>;
template int first_crossed(const std::vector<CrackPlane<2>> &, const Vector<2> &,
                           const Vector<2> &);
template int first_crossed(const std::vector<CrackPlane<3>> &, const Vector<3> &,
                           const Vector<3> &);
template struct SpecimenShape<2>;
template struct SpecimenShape<3>;
} // namespace ligament::packings
