#include "core/outline.h"

#include "core/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace ligament::core
{
namespace
{
double cross(const Vector<2> &a, const Vector<2> &b)
{
  return a[0] * b[1] - a[1] * b[0];
}

/// Radius on which the inner corners of an arc of n sides lie, so that the polygon from the centre
/// has the arc's area: r r' sin(phi) + (n - 2)/2 r'^2 sin(phi) = r^2 n phi/2; whole circles have
/// inner corners alone.
double inner_radius(double radius, double angle, int n, bool is_circle)
{
  const double phi = angle / n, s = std::sin(phi);
  if (is_circle)
    return radius * std::sqrt(phi / s);
  if (n == 1)
    return radius;
  if (n == 2)
    return radius * phi / s;
  const double a = (n - 2) / 2. * s, b = s, c = -n * phi / 2;
  return radius * (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

constexpr double most_sides = 2e5; // of an arc; none that belongs to a body needs as many

void add_arc(const Vector<2> &from, const OutlineEdge &edge, double side, bool is_circle,
             Polygon &polygon)
{
  const Vector<2> a = from - *edge.centre, b = edge.to - *edge.centre;
  const double radius = a.norm();
  require(radius > 0 && std::abs(b.norm() / radius - 1) < 1e-6,
          fmt::format("the arc to ({:.6g}, {:.6g}) m has the radius {:.6g} m at its beginning and "
                      "{:.6g} m at its end",
                      edge.to[0], edge.to[1], radius, b.norm()));
  double angle = is_circle ? 2 * M_PI : std::atan2(cross(a, b), a.dot(b));
  if (edge.clockwise)
    angle = is_circle ? -angle : angle >= 0 ? angle - 2 * M_PI : angle;
  else if (angle <= 0)
    angle += 2 * M_PI;
  // A circle keeps both its axes of symmetry.
  const double sides = std::max(std::abs(angle) * radius / side, std::abs(angle) / (M_PI / 4));
  require(sides <= most_sides,
          fmt::format("the arc to ({:.6g}, {:.6g}) m has the radius {:.6g} m: more than {:.0f} "
                      "sides of {:.6g} m, which fit the body",
                      edge.to[0], edge.to[1], radius, most_sides, side));
  const int n = is_circle ? 4 * int(std::ceil(sides / 4)) : int(std::ceil(sides - 1e-9));
  const double inner = inner_radius(radius, std::abs(angle), n, is_circle);
  const double start = std::atan2(a[1], a[0]);
  for (int k = 0; k < n; ++k) {
    const double at = start + angle * (k + (is_circle ? 0.5 : 0)) / n;
    const Vector<2> out(std::cos(at), std::sin(at));
    polygon.push_back(
        {k == 0 && !is_circle ? from : Vector<2>(*edge.centre + inner * out), edge.boundary});
  }
}

bool meet(const Vector<2> &a, const Vector<2> &b, const Vector<2> &c, const Vector<2> &d)
{
  const double abc = cross(b - a, c - a), abd = cross(b - a, d - a), cda = cross(d - c, a - c),
               cdb = cross(d - c, b - c);
  if (((abc > 0) != (abd > 0)) && ((cda > 0) != (cdb > 0)))
    return true;
  const auto lies_on = [](const Vector<2> &x, const Vector<2> &p, const Vector<2> &q) {
    return cross(q - p, x - p) == 0 && (x - p).dot(x - q) <= 0;
  };
  return lies_on(c, a, b) || lies_on(d, a, b) || lies_on(a, c, d) || lies_on(b, c, d);
}
} // namespace

Outline circle(const Vector<2> &centre, double radius, int boundary)
{
  return {{centre + Vector<2>(radius, 0), centre, false, boundary}};
}

Outline rectangle(const Vector<2> &lower, const Vector<2> &upper,
                  const std::array<int, 4> &boundaries)
{
  const auto &[left, right, bottom, top] = boundaries;
  return {{lower, {}, false, left},
          {{upper[0], lower[1]}, {}, false, bottom},
          {upper, {}, false, right},
          {{lower[0], upper[1]}, {}, false, top}};
}

Polygon polygon(const Outline &outline, double side)
{
  Polygon polygon;
  const bool is_circle = outline.size() == 1;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vector<2> &from = outline[k == 0 ? outline.size() - 1 : k - 1].to;
    if (outline[k].centre)
      add_arc(from, outline[k], side, is_circle, polygon);
    else
      polygon.push_back({from, outline[k].boundary});
  }
  return polygon;
}

double signed_area(const Polygon &polygon)
{
  double sum = 0;
  const Vector<2> &origin = polygon[0].place;
  for (std::size_t k = 2; k < polygon.size(); ++k)
    sum += cross(polygon[k - 1].place - origin, polygon[k].place - origin) / 2;
  return sum;
}

// Sides sorted by where they begin along x: only those that lie side by side are compared.
std::optional<Vector<2>> crossing(const std::vector<Polygon> &polygons)
{
  struct Side
  {
    Vector<2> a, b;
    std::size_t polygon, number, n;
    double begin() const { return std::min(a[0], b[0]); }
    double end() const { return std::max(a[0], b[0]); }
  };
  std::vector<Side> sides;
  for (std::size_t p = 0; p < polygons.size(); ++p)
    for (std::size_t k = 0, n = polygons[p].size(); k < n; ++k)
      sides.push_back({polygons[p][k].place, polygons[p][(k + 1) % n].place, p, k, n});
  std::sort(sides.begin(), sides.end(),
            [](const Side &s, const Side &t) { return s.begin() < t.begin(); });
  for (std::size_t i = 0; i < sides.size(); ++i)
    for (std::size_t j = i + 1; j < sides.size() && sides[j].begin() <= sides[i].end(); ++j) {
      const Side &s = sides[i], &t = sides[j];
      if (s.polygon == t.polygon) {
        // Neighbours share a corner, and must not run back over each other.
        const bool follows = (s.number + 1) % s.n == t.number;
        if (follows || (t.number + 1) % s.n == s.number) {
          const Side &first = follows ? s : t, &second = follows ? t : s;
          const Vector<2> u = first.a - first.b, v = second.b - second.a;
          if (s.n > 2 && cross(u, v) == 0 && u.dot(v) > 0)
            return first.b;
          continue;
        }
      }
      if (meet(s.a, s.b, t.a, t.b))
        return (std::max(s.begin(), t.begin()) == s.a[0] ? s.a : s.b);
    }
  return {};
}

Solid<2> make_solid(const std::vector<Polygon> &polygons)
{
  std::vector<Vector<2>> vertices;
  std::vector<Solid<2>::Facet> facets;
  for (const Polygon &polygon : polygons) {
    const int first = int(vertices.size()), n = int(polygon.size());
    for (int k = 0; k < n; ++k) {
      vertices.push_back(polygon[k].place);
      facets.push_back({{{first + k, first + (k + 1) % n}}, polygon[k].boundary});
    }
  }
  return {std::move(vertices), std::move(facets)};
}

Solid<3> extrude(const std::vector<Polygon> &polygons, double lower, double upper,
                 const std::array<int, 2> &ends)
{
  std::vector<Vector<3>> vertices; // lower and upper in turn
  std::vector<Solid<3>::Facet> facets(2);
  facets[0].boundary = ends[0];
  facets[1].boundary = ends[1];
  for (const Polygon &polygon : polygons) {
    const int first = int(vertices.size()), n = int(polygon.size());
    for (int k = 0; k < n; ++k) {
      const Vector<2> &x = polygon[k].place;
      vertices.emplace_back(x[0], x[1], lower);
      vertices.emplace_back(x[0], x[1], upper);
      const int a = first + 2 * k, b = first + 2 * ((k + 1) % n);
      facets[1].edges.push_back({a + 1, b + 1});
      facets.push_back({{{a, b}, {b, b + 1}, {b + 1, a + 1}, {a + 1, a}}, polygon[k].boundary});
    }
    for (int k = n - 1; k >= 0; --k) // the other way round, each edge behind the one before
      facets[0].edges.push_back({first + 2 * ((k + 1) % n), first + 2 * k});
  }
  return {std::move(vertices), std::move(facets)};
}

// An octahedron whose sides are halved until they are short enough, pushed out to the sphere.
Solid<3> make_ball(const Vector<3> &centre, double radius, double side, int boundary)
{
  using Triangle = std::array<int, 3>;
  std::vector<Vector<3>> vertices;
  for (int a = 0; a < 3; ++a)
    for (const int sign : {1, -1})
      vertices.push_back(sign * Vector<3>::Unit(a));
  std::vector<Triangle> triangles;
  for (int octant = 0; octant < 8; ++octant) {
    const int x = octant & 1, y = 2 + (octant >> 1 & 1), z = 4 + (octant >> 2 & 1);
    const bool is_odd = ((octant ^ octant >> 1 ^ octant >> 2) & 1) != 0;
    triangles.push_back(is_odd ? Triangle{x, z, y} : Triangle{x, y, z});
  }
  for (double length = M_PI / 2 * radius; length > side && triangles.size() < 1e6; length /= 2) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [m, is_new] = middles.insert({std::minmax(a, b), int(vertices.size())});
      if (is_new)
        vertices.push_back((vertices[a] + vertices[b]).normalized());
      return m->second;
    };
    std::vector<Triangle> finer;
    for (const auto &[a, b, c] : triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  std::vector<Solid<3>::Facet> facets;
  for (const auto &[a, b, c] : triangles)
    facets.push_back({{{a, b}, {b, c}, {c, a}}, boundary});
  const double scale = std::cbrt(4 * M_PI / 3 / Solid<3>(vertices, facets).volume()) * radius;
  for (Vector<3> &x : vertices)
    x = centre + scale * x;
  return {std::move(vertices), std::move(facets)};
}
} // namespace ligament::core
