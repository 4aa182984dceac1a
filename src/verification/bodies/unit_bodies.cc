#include "src/verification/bodies/unit_bodies.h"

namespace ligament::program
{
Scene unit_scene(int dimension, const Point &size, double poissons_ratio)
{
  Scene scene;
  scene.title = "verification";
  scene.dimension = dimension;
  scene.specimen.size = size;
  scene.material.youngs_modulus = 1;
  scene.material.poissons_ratio = poissons_ratio;
  scene.material.density = 1;
  scene.zone.extent = DiscreteZone::Extent::all;
  scene.zone.packing = dimension == 2 ? PackingKind::hexagonal : PackingKind::fcc;
  scene.zone.spacing = 1;
  scene.time.duration = 1;
  scene.coupling.fine_damper = 0;
  scene.coupling.gap_filter = 0;
  return scene;
}

void add_far_field(Scene &scene, const Point &zone_size, double cell_size)
{
  scene.zone.extent = DiscreteZone::Extent::box;
  for (int c = 0; c < scene.dimension; ++c) {
    scene.zone.upper[c] = zone_size[c] > 0 ? zone_size[c] / 2 : scene.specimen.size[c];
    scene.zone.lower[c] = -scene.zone.upper[c];
  }
  scene.far_field.emplace();
  scene.far_field->cell_size = cell_size;
}

template <int dim>
void add_tractions(Scene &scene, const std::vector<int> &sides, const Strain<dim> &stress)
{
  // Places of xx, yy, zz, yz, xz, xy in a symmetric matrix.
  const int voigt_2d[2][2] = {{0, 2}, {2, 1}}, voigt_3d[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
  for (const int side : sides) {
    LoadParameters load;
    load.boundary = side;
    load.kind = LoadKind::traction;
    load.ramp = 1;
    for (int c = 0; c < dim; ++c) {
      const int k = dim == 2 ? voigt_2d[side / 2][c] : voigt_3d[side / 2][c];
      load.value[c] = (side % 2 ? 1 : -1) * stress[k];
    }
    load.traction = load.value;
    scene.loads.push_back(load);
  }
}

template void add_tractions<2>(Scene &, const std::vector<int> &, const Strain<2> &);
template void add_tractions<3>(Scene &, const std::vector<int> &, const Strain<3> &);
} // namespace ligament::program
