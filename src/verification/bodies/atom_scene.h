// Small coupled bodies of atoms for verification, with lengths in spacings of their crystal.
#pragma once

#include "src/scene/atoms.h"

#include <string>

namespace ligament::program
{
struct AtomBody
{
  std::string name;
  AtomPotential potential;
  std::string species; // zhou
  PackingKind packing;
  double angle = 0; // rad, 2D
  Point along_x = {0, 0, 0}, along_y = {0, 0, 0};
};

/// Lennard-Jones and the plane crystal are argon's size; `zone` and `margin` (of the mesh beyond
/// it), overlap and cells in spacings. In 3D the body repeats itself along y and z after about
/// three cells. Undamped.
inline Scene atom_scene(const AtomBody &b, double zone, double margin, double cell,
                        int overlap_cells)
{
  Scene scene;
  scene.title = "verification";
  scene.dimension = b.packing == PackingKind::hexagonal ? 2 : 3;
  scene.specimen.size = {1, 1, 1};
  scene.specimen.thickness = 3e-10;
  scene.zone.packing = b.packing;
  scene.zone.orientation[0] = scene.dimension == 2 ? b.angle : 0;
  scene.time.duration = 1e-12;
  scene.coupling.fine_damper = scene.coupling.gap_filter = 0;
  scene.coupling.overlap_cells = overlap_cells;
  scene.coupling.transition_cells = 2;
  AtomsParameters &a = scene.atoms.emplace();
  a.potential = b.potential;
  a.species = b.species;
  a.energy = 1.6e-21;
  a.distance = 3.4e-10;
  a.mass = 6.6e-26;
  a.decay = 1.5e10;
  a.along_x = b.along_x;
  a.along_y = b.along_y;
  resolve_atoms(scene, nullptr);
  const double d = scene.zone.spacing;
  scene.far_field.emplace();
  scene.far_field->cell_size = cell * d;
  for (int c = 0; c < scene.dimension; ++c) {
    scene.specimen.size[c] = (zone + 2 * margin) * d;
    scene.zone.upper[c] = zone / 2 * d;
    scene.zone.lower[c] = -zone / 2 * d;
  }
  if (scene.dimension == 3) {
    scene.specimen.periodic = {{Axis::y}, {Axis::z}};
    for (const int c : {1, 2})
      scene.specimen.size[c] = 3.2 * cell * d;
    resolve_atoms(scene, nullptr); // whole periods
    for (const int c : {1, 2}) {
      scene.zone.upper[c] = scene.specimen.size[c];
      scene.zone.lower[c] = -scene.zone.upper[c];
    }
  }
  return scene;
}
} // namespace ligament::program
