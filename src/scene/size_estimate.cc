#include "src/scene/size_estimate.h"

#include "src/scene/body_shape.h"
#include "src/scene/geometry.h"

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
constexpr int n_points = 200000;

/// The k-th of points that fill the specimen evenly: each coordinate is a multiple of a power of
/// the number that makes the sequence least regular, x^(dim+1) = x + 1 (M. Roberts).
Point spread_point(const Scene &scene, int k)
{
  const double root = scene.dimension == 2 ? 1.32471795724474603 : 1.22074408460575947;
  Point x = {0, 0, 0};
  double step = 1;
  for (int c = 0; c < scene.dimension; ++c) {
    step /= root;
    const double share = std::fmod(0.5 + step * (k + 1), 1.);
    x[c] = scene.specimen.lower(c) + share * scene.specimen.size[c];
  }
  return x;
}

/// Edge of the cell at this distance, in m, from the inner end of the overlap; see fem::make_mesh.
double cell_size_at(const Scene &scene, double distance)
{
  const FarField &far = *scene.far_field;
  const double h = far.cell_size, largest = h * std::pow(2., far.levels);
  double end = h * fine_cells(scene), size = h;
  if (far.growth > 1)
    return distance < end ? h : std::min(largest, h + (distance - end) * (far.growth - 1));
  while (size < largest && distance >= end) {
    size *= 2;
    end += far.cells_per_level * size;
  }
  return size;
}
} // namespace

SizeEstimate estimate_size(const Scene &scene, double cell_volume)
{
  using Extent = DiscreteZone::Extent;
  const int dim = scene.dimension;
  const bool all = scene.zone.extent == Extent::all, none = scene.zone.extent == Extent::none;
  const double overlap =
      all || none ? 0 : scene.coupling.overlap_cells * scene.far_field->cell_size;
  const auto zone = zone_shape<3>(scene);
  double point_area = 1. / n_points; // m^2 or m^3
  for (int c = 0; c < dim; ++c)
    point_area *= scene.specimen.size[c];
  const double particles_per_point =
      none ? 0 : point_area * (dim == 2 ? scene.specimen.thickness : 1) / cell_volume;
  const BodyTest body(scene.specimen, dim);
  SizeEstimate size;
  for (int k = 0; k < n_points; ++k) {
    const Point x = spread_point(scene, k);
    const double inside = all    ? infinity
                          : none ? -infinity
                                 : zone.distance(Vector<3>(x[0], x[1], x[2]));
    const bool is_material = body.contains(x);
    const double in_material = is_material ? particles_per_point : 0;
    size.equivalent_particles += in_material;
    if (inside >= 0)
      size.particles += in_material;
    if (inside >= 0 && inside < overlap)
      size.overlap_particles += in_material;
    if (!all && inside < overlap && is_material)
      size.cells += point_area / std::pow(cell_size_at(scene, overlap - inside), dim);
  }
  return size;
}
} // namespace ligament::program
