// How much of an outer face of a cell lies in parts of the specimen's side.
#pragma once

#include "core/part.h"
#include "packings/packing.h"

#include <optional>

namespace ligament::packings
{
template <int dim>
struct OuterFace
{
  struct Inside
  {
    double area;       // m^2
    Vector<dim> lever; // m, from the particle's centre to the centroid
  };

  OuterFace(const BoundaryFace<dim> &face, const Packing<dim> &packing)
      : of(face), centre_(get(packing.centre, face.i)), thickness_(dim == 2 ? packing.thickness : 1)
  {
  }

  /// What lies in all of the parts; nothing where no area does. Exact but where a void cuts a 3D
  /// face: that one counts as a whole where its centroid does.
  std::optional<Inside> inside(const std::vector<core::Part<dim>> &parts) const;

  const BoundaryFace<dim> &of;

private:
  core::FaceCorners<dim> corners() const;

  Vector<dim> centre_;
  double thickness_;
};
} // namespace ligament::packings
