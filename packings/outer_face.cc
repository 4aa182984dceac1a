#include "packings/outer_face.h"

#include <algorithm>

namespace ligament::packings
{
template <int dim>
core::FaceCorners<dim> OuterFace<dim>::corners() const
{
  core::FaceCorners<dim> corners;
  if constexpr (dim == 2) {
    const Vector<2> half = of.area / thickness_ / 2 * Vector<2>(-of.normal[1], of.normal[0]);
    corners = {centre_ + of.lever - half, centre_ + of.lever + half};
  } else
    for (const Vector<dim> &corner : of.corners)
      corners.push_back(centre_ + corner);
  return corners;
}

template <int dim>
auto OuterFace<dim>::inside(const std::vector<core::Part<dim>> &parts) const
    -> std::optional<Inside>
{
  const Inside all{of.area, of.lever};
  if (std::all_of(parts.begin(), parts.end(), [](const auto &p) { return p.is_whole(); }))
    return all;
  core::FaceCorners<dim> left = corners();
  if (left.empty()) {
    const Vector<dim> centroid = centre_ + of.lever;
    const bool holds = std::all_of(parts.begin(), parts.end(), [&](const core::Part<dim> &part) {
      return part.holds(centroid, 1e-9 * of.q);
    });
    return holds ? std::optional<Inside>(all) : std::nullopt;
  }
  for (const auto &part : parts)
    left = part.clip(std::move(left));
  // What round-off leaves along an edge is nothing.
  const double area = core::face_area<dim>(left) * thickness_;
  if (area <= 1e-12 * of.area)
    return {};
  return Inside{area, core::face_centroid<dim>(left) - centre_};
}

template struct OuterFace<2>;
template struct OuterFace<3>;
} // namespace ligament::packings
