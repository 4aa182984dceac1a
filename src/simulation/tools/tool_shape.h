// Shapes of rigid tools: how deep a point lies inside one, and which way is out.
#pragma once

#include "core/types.h"

#include <array>
#include <variant>
#include <vector>

namespace ligament::program
{
/// Of a point against the surface of a tool.
template <int dim>
struct Touch
{
  double depth;       // m, to the nearest surface; negative outside, where it may be too near to 0
  Vector<dim> normal; // unit, out of the tool
};

/// A disc (2D) or a ball.
template <int dim>
struct BallTool
{
  double radius; // m

  Touch<dim> touch(const Vector<dim> &y) const;
};

/// 3D: the points within the radius of an axis, between two ends.
template <int dim>
struct CylinderTool
{
  double radius;    // m
  Vector<dim> axis; // unit
  double half_length;

  Touch<dim> touch(const Vector<dim> &y) const;
};

/// What lies behind some planes: a plate or a wedge.
template <int dim>
struct ConvexTool
{
  struct Plane
  {
    Vector<dim> normal; // unit, outward
    double offset;      // m, of the plane along it
  };
  std::vector<Plane> planes;
  std::vector<std::array<Vector<dim>, 2>> edges; // for pictures

  Touch<dim> touch(const Vector<dim> &y) const;
};

template <int dim>
class ToolShape
{
public:
  template <typename Form>
  ToolShape(Form form) : form_(std::move(form))
  {
  }

  /// Of a point in the tool's frame.
  Touch<dim> touch(const Vector<dim> &y) const
  {
    return std::visit([&](const auto &form) { return form.touch(y); }, form_);
  }
  /// Lines that show it in a picture; infinite extents end at `reach` m.
  std::vector<std::array<Vector<dim>, 2>> edges(double reach) const;

private:
  std::variant<BallTool<dim>, CylinderTool<dim>, ConvexTool<dim>> form_;
};

/// A prism over a convex polygon (corners in the order of the trigonometric sense, m), turned by
/// the rotation; 3D: extruded along its third axis by `length` in all, which may be infinite.
template <int dim>
ConvexTool<dim> make_prism(const std::vector<Vector<2>> &corners, double length,
                           const Eigen::Matrix<double, dim, dim> &rotation);
} // namespace ligament::program
