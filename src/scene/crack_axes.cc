#include "src/scene/crack_axes.h"

#include <Eigen/Geometry>

#include <cmath>
#include <optional>

namespace ligament::program
{
namespace
{
template <int dim>
Vector<dim> vector_of(const Point &p)
{
  return Eigen::Map<const Vector<dim>>(p.data());
}

/// Whether a point lies within the box around the body, not at its border.
bool is_within(const Specimen &s, const Vector<3> &x, int dim)
{
  for (int c = 0; c < dim; ++c)
    if (!s.is_periodic(c)) {
      const double border = 1e-6 * s.size[c];
      if (x[c] < s.lower(c) + border || x[c] > s.upper(c) - border)
        return false;
    }
  return true;
}

template <int dim>
Vector<dim> in_one_sense(Vector<dim> v)
{
  v.normalize();
  double sense = 0;
  for (int c = 0; c < dim; ++c) {
    if (std::abs(v[c]) < 1e-12)
      v[c] = 0;
    if (sense == 0 && v[c] != 0)
      sense = v[c] < 0 ? -1 : 1;
  }
  return (sense * v).array() + 0.; // no -0
}

CrackAxes<2> along(const Vector<2> &growth)
{
  const Vector<2> along = in_one_sense<2>(growth);
  return {along, in_one_sense<2>({-along[1], along[0]})};
}

template <int dim>
std::optional<CrackAxes<dim>> axes_of(const Specimen &s, const Crack &crack);

/// The last end of a line if that lies in the body, or else its first one.
template <>
std::optional<CrackAxes<2>> axes_of<2>(const Specimen &s, const Crack &crack)
{
  const std::size_t n = crack.points.size();
  const auto point = [&](std::size_t k) { return Vector<3>(crack.points[k].data()); };
  if (is_within(s, point(n - 1), 2))
    return along((point(n - 1) - point(n - 2)).head<2>());
  if (is_within(s, point(0), 2))
    return along((point(0) - point(1)).head<2>());
  return {};
}

/// Of a polygon the longest edge in the body is its front.
template <>
std::optional<CrackAxes<3>> axes_of<3>(const Specimen &s, const Crack &crack)
{
  const std::size_t n = crack.points.size();
  Vector<3> normal = Vector<3>::Zero(), centre = Vector<3>::Zero(), front = Vector<3>::Zero(),
            place = Vector<3>::Zero();
  for (std::size_t k = 0; k < n; ++k) {
    const Vector<3> a(crack.points[k].data()), b(crack.points[(k + 1) % n].data());
    normal += (a - Vector<3>(crack.points[0].data())).cross(b - a);
    centre += a / double(n);
    if ((b - a).norm() > (1 + 1e-9) * front.norm() && is_within(s, (a + b) / 2, 3))
      front = b - a, place = (a + b) / 2;
  }
  if (front.norm() == 0 || normal.norm() == 0)
    return {};
  Vector<3> growth = front.cross(normal);
  if (growth.dot(place - centre) < 0)
    growth = -growth;
  return CrackAxes<3>{in_one_sense<3>(growth), in_one_sense<3>(normal)};
}

/// In the plane of x and y: bodies with slots are extruded along z.
template <int dim>
CrackAxes<dim> axes_of(const Slot &slot)
{
  const auto plane = along(vector_of<2>(slot.to) - vector_of<2>(slot.from));
  CrackAxes<dim> axes{Vector<dim>::Zero(), Vector<dim>::Zero()};
  axes.growth.template head<2>() = plane.growth;
  axes.normal.template head<2>() = plane.normal;
  return axes;
}

/// A box grows along its longest edge that ends in the body, and opens along its shortest one.
template <int dim>
std::optional<CrackAxes<dim>> axes_of(const Specimen &s, const Notch &notch)
{
  int growth = -1, normal = 0;
  const auto width = [&](int c) { return notch.upper[c] - notch.lower[c]; };
  for (int c = 0; c < dim; ++c) {
    const bool ends = notch.lower[c] > s.lower(c) || notch.upper[c] < s.upper(c);
    if (ends && (growth < 0 || width(c) > width(growth)))
      growth = c;
    if (width(c) < width(normal))
      normal = c;
  }
  if (growth < 0 || growth == normal)
    return {};
  return CrackAxes<dim>{Vector<dim>::Unit(growth), Vector<dim>::Unit(normal)};
}
} // namespace

template <int dim>
CrackAxes<dim> crack_axes(const Specimen &s)
{
  for (const Crack &crack : s.cracks)
    if (const auto axes = axes_of<dim>(s, crack))
      return *axes;
  if (!s.slots.empty())
    return axes_of<dim>(s.slots.front());
  for (const Notch &notch : s.notches)
    if (const auto axes = axes_of<dim>(s, notch))
      return *axes;
  return {};
}

template CrackAxes<2> crack_axes(const Specimen &);
template CrackAxes<3> crack_axes(const Specimen &);
} // namespace ligament::program
