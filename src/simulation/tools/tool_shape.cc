#include "src/simulation/tools/tool_shape.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace ligament::program
{
namespace
{
constexpr int n_circle = 256; // sides of a circle in a picture

/// The point itself where it has no direction: any way is out.
template <int dim>
Vector<dim> direction(const Vector<dim> &y, double length)
{
  return length > 0 ? Vector<dim>(y / length) : Vector<dim>(Vector<dim>::Unit(dim - 1));
}

template <int dim>
void add_circle(const Vector<dim> &centre, const Vector<dim> &a, const Vector<dim> &b,
                std::vector<std::array<Vector<dim>, 2>> &edges)
{
  const auto at = [&](int k) {
    const double angle = 2 * M_PI * k / n_circle;
    return Vector<dim>(centre + std::cos(angle) * a + std::sin(angle) * b);
  };
  for (int k = 0; k < n_circle; ++k)
    edges.push_back({at(k), at(k + 1)});
}

template <int dim>
void add_edges(const BallTool<dim> &ball, double, std::vector<std::array<Vector<dim>, 2>> &edges)
{
  for (int c = 0; c < dim; ++c)
    for (int d = c + 1; d < dim; ++d)
      add_circle<dim>(Vector<dim>::Zero(), ball.radius * Vector<dim>::Unit(c),
                      ball.radius * Vector<dim>::Unit(d), edges);
}

template <int dim>
void add_edges(const CylinderTool<dim> &cylinder, double reach,
               std::vector<std::array<Vector<dim>, 2>> &edges)
{
  if constexpr (dim == 3) {
    const Vector<dim> a = cylinder.axis.unitOrthogonal(), b = cylinder.axis.cross(a);
    const Vector<dim> half = std::min(cylinder.half_length, reach) * cylinder.axis;
    for (const double end : {-1., 1.})
      add_circle<dim>(end * half, cylinder.radius * a, cylinder.radius * b, edges);
    for (const Vector<dim> &side : {a, b})
      for (const double sign : {-1., 1.}) {
        const Vector<dim> x = sign * cylinder.radius * side;
        edges.push_back({x - half, x + half});
      }
  }
}

/// Ends far away come nearer along the edge.
template <int dim>
void add_edges(const ConvexTool<dim> &convex, double reach,
               std::vector<std::array<Vector<dim>, 2>> &edges)
{
  for (auto edge : convex.edges) {
    for (Vector<dim> &end : edge)
      for (int c = 0; c < dim; ++c)
        end[c] = std::max(-reach, std::min(end[c], reach));
    edges.push_back(edge);
  }
}
} // namespace

template <int dim>
Touch<dim> BallTool<dim>::touch(const Vector<dim> &y) const
{
  const double length = y.norm();
  return {radius - length, direction<dim>(y, length)};
}

template <int dim>
Touch<dim> CylinderTool<dim>::touch(const Vector<dim> &y) const
{
  const double along = y.dot(axis);
  const Vector<dim> across = y - along * axis;
  const double length = across.norm();
  const Touch<dim> mantle = {radius - length, direction<dim>(across, length)};
  const double depth = half_length - std::abs(along);
  return mantle.depth <= depth ? mantle : Touch<dim>{depth, along < 0 ? -axis : axis};
}

template <int dim>
Touch<dim> ConvexTool<dim>::touch(const Vector<dim> &y) const
{
  const Plane *nearest = nullptr;
  double depth = std::numeric_limits<double>::infinity();
  for (const Plane &plane : planes) {
    const double behind = plane.offset - plane.normal.dot(y);
    if (behind < depth) {
      depth = behind;
      nearest = &plane;
    }
  }
  return {depth, nearest->normal};
}

template <int dim>
std::vector<std::array<Vector<dim>, 2>> ToolShape<dim>::edges(double reach) const
{
  std::vector<std::array<Vector<dim>, 2>> edges;
  std::visit([&](const auto &form) { add_edges<dim>(form, reach, edges); }, form_);
  return edges;
}

template <int dim>
ConvexTool<dim> make_prism(const std::vector<Vector<2>> &corners, double length,
                           const Eigen::Matrix<double, dim, dim> &rotation)
{
  ConvexTool<dim> prism;
  // Far beyond any body, and still a number.
  const double half = std::isfinite(length) ? length / 2 : 1e6;
  const auto place = [&](const Vector<2> &x, double along) {
    Vector<dim> y = Vector<dim>::Zero();
    y.template head<2>() = x;
    if (dim == 3)
      y[dim - 1] = along;
    return Vector<dim>(rotation * y);
  };
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vector<2> &a = corners[k], &b = corners[(k + 1) % corners.size()];
    const Vector<2> normal = Vector<2>(b[1] - a[1], a[0] - b[0]).normalized();
    prism.planes.push_back({place(normal, 0), normal.dot(a)});
    if (dim == 2)
      prism.edges.push_back({place(a, 0), place(b, 0)});
    else {
      for (const double end : {-half, half})
        prism.edges.push_back({place(a, end), place(b, end)});
      prism.edges.push_back({place(a, -half), place(a, half)});
    }
  }
  if constexpr (dim == 3)
    if (std::isfinite(length))
      for (const double sign : {-1., 1.})
        prism.planes.push_back({sign * rotation.col(2), half});
  return prism;
}

template struct BallTool<2>;
template struct BallTool<3>;
template struct CylinderTool<2>;
template struct CylinderTool<3>;
template struct ConvexTool<2>;
template struct ConvexTool<3>;
template class ToolShape<2>;
template class ToolShape<3>;
template ConvexTool<2> make_prism(const std::vector<Vector<2>> &, double,
                                  const Eigen::Matrix<double, 2, 2> &);
template ConvexTool<3> make_prism(const std::vector<Vector<2>> &, double,
                                  const Eigen::Matrix<double, 3, 3> &);
} // namespace ligament::program
