// Packings on a lattice: cells, faces and initial cracks of a box specimen or of a zone in it.
#pragma once

#include "core/ranks.h"
#include "packings/packing_part.h"
#include "packings/specimen.h"

#include <string>

namespace ligament::packings
{
enum class LatticeKind
{
  square,       // 2D
  hexagonal,    // 2D
  simple_cubic, // 3D
  fcc           // 3D
};

/// Reads "square", "hexagonal", "simple_cubic" or "fcc"; throws core::InputError on others.
LatticeKind lattice_kind(const std::string &name);

/// The lattice, in lattice axes at orientation 0, turned about the centre of the specimen:
///   square, simple_cubic: rows along x, y, z;
///   hexagonal: close-packed rows along x, stacked along y at (d/2, sqrt(3)/2 d);
///   fcc: close-packed rows [110] along x and [-110] along y, cube axis [001] along z, layers at
///        (d/2, d/2, d/sqrt(2)).
/// It is anchored to the specimen alone, so that a zone and the whole specimen share particles. The
/// centre of the specimen is a point of inversion symmetry between particles: at half of
/// (d, d[, d]) from one (square, simple cubic), at (d/4, sqrt(3)/4 d) (hexagonal) or
/// (d/4, d/4, d/sqrt(8)) (fcc). A crack through the centre along the rows (layers) thus runs midway
/// between two of them and cuts bonds, not particles.
template <int dim>
struct LatticeParameters : SpecimenParameters<dim>
{
  LatticeKind kind = dim == 2 ? LatticeKind::hexagonal : LatticeKind::fcc;
  Spin<dim> orientation = Spin<dim>::Zero(); // rad; 2D angle, 3D rotation vector
  /// Layers (2D: rows) of up to so many particles lie as the lattice has them; larger ones another
  /// way where that pays (RowLayout). 0: the smallest layers.
  long small_layer = 2000;
};

/// Packs the zone of the specimen.
///
/// Particles are the lattice points in the material, except those nearer than d/4 to its surface;
/// their cells are the Voronoi cells of all particles of the specimen, cut by its surface. So
/// (D2a) sum S n = 0 and (D2b) sum S a (x) n = V I hold to round-off for every cell with all its
/// neighbours. Faces smaller than 1e-12 of a lattice face are left out. Holes are polygons of equal
/// area with sides of about d/2. Voids are taken from cells and faces as sets, corners included.
///
/// Sides of the zone strictly inside the specimen are coupled: particles whose cell reaches across
/// are left out, and the cells at the edge keep their volume but have neither Face nor BoundaryFace
/// there.
///
/// Particles are numbered along rows, rows along layers (RowLayout), so that neighbours of a run of
/// particles lie at constant index offsets. Faces are sorted by (i, j), i < j; on lattice faces
/// that is also the order of the directions. Faces between two whole lattice cells have a
/// direction, and q = d/2 and lever = q n exactly.
///
/// A face is cracked when the segment between the centres crosses a crack, its rim included.
/// Centres within 1e-9 d of the plane of the crack count as lying on its positive side: left of the
/// segment (2D), where the points turn counter-clockwise (3D).
///
/// Periodic: the lattice goes on beyond the joined sides, see periodic_sides.h.
///
/// Throws core::InputError for impossible parameters, holes in 3D, an empty zone, and material
/// beside a void so thin that it holds no particles of its own (a wall of 1.5 d is never
/// refused).
template <int dim>
Packing<dim> make_lattice_packing(const LatticeParameters<dim> &parameters);

/// What part_of() keeps of it for one of several ranks, which all call it: each packs only the rows
/// that it needs. Shares go by the weights of blocks (particles::make_partition). Of a zone without
/// joined sides.
template <int dim>
PackingPart<dim>
make_lattice_part(const LatticeParameters<dim> &parameters, const core::Ranks &ranks, int rings,
                  const Groups<dim> &groups = {}, const std::vector<std::int64_t> &weights = {});

/// What grouped_part() keeps of it, made from so many windows of rows one after the other, lest the
/// whole be in memory. Of a zone without joined sides.
template <int dim>
Packing<dim> make_grouped_lattice(const LatticeParameters<dim> &parameters, int n_windows,
                                  const Groups<dim> &groups, int rings);
} // namespace ligament::packings
