// The geometry that a packing hands to the force: cells, faces between them, outer faces.
#pragma once

#include "packings/specimen_shape.h"
#include "particles/particles.h"

#include <optional>

namespace ligament::packings
{
/// Plane face between the cells of particles i and j (docs/theory.md, section 1.1).
template <int dim>
struct Face
{
  int i, j;
  Vector<dim> normal;  // unit, from i to j
  double area;         // m^2 (2D: length times thickness)
  double q_i, q_j;     // m, distances from the centres to the face plane; q_i + q_j = r
  Vector<dim> lever_i; // m, from centre i to the point of the face where traction acts
  Vector<dim> lever_j; // m, from centre j; unclipped faces: lever_i = q_i n, lever_j = -q_j n
  /// Index of the lattice direction (see Packing::directions) when the face is a whole one of the
  /// lattice and both its cells are whole; -1 when anything about it is irregular.
  int direction;
  /// An initial crack runs through this face: it touches but carries no tension.
  bool cracked;
  int cut = -1; // number of that crack in Packing::cuts; -1: the face has its own normal
  /// The neighbour is the image of j so many periods away; its centre and levers are the image's.
  std::array<int, dim> image = {};
};

/// Part of a cell's surface on the surface of the specimen.
template <int dim>
struct BoundaryFace
{
  int i;
  Vector<dim> normal; // unit, outward
  double area;        // m^2
  double q;           // m, distance from the centre to the face plane
  Vector<dim> lever;  // m, from the centre to the centroid of the face
  int boundary;       // side of the box, or inner_surface<dim>
  /// m, from the centre, in turn: of 3D faces on a side that no void cuts.
  std::vector<Vector<dim>> corners = {};
};

/// A half of the neighbours of a lattice particle; the other half are the opposite directions.
template <int dim>
struct LatticeDirection
{
  Vector<dim> normal; // unit
  double distance;    // m, between the centres
  double area;        // m^2
};

/// Sizes of a whole packing, of which what is at hand may be a part.
struct WholeSizes
{
  double face_area = 0; // m^2, see mean_face_area()
  double diameter = 0;  // m, the largest one
};

template <int dim>
struct Packing
{
  double spacing = 0;   // m, d: distance of nearest neighbours; random: of the lattice as dense
  double thickness = 1; // m, 2D only
  Vector<dim> period = Vector<dim>::Zero(); // m, after which it repeats itself; 0: it doesn't
  Components<dim> centre;
  std::vector<double> volume; // m^3, of the cell clipped by the specimen
  /// m, distance at which particles of this size touch; empty: d for all.
  std::vector<double> diameter;
  std::vector<int> material; // number of each particle's material; empty: all 0
  std::vector<Face<dim>> faces;
  std::vector<BoundaryFace<dim>> boundary_faces;
  std::vector<LatticeDirection<dim>> directions; // empty for random packings
  std::vector<CrackPlane<dim>> cuts;             // initial cracks
  /// Name of a particle that does not depend on which part of the specimen is packed.
  std::vector<std::int64_t> global_id;
  /// Gap-free runs along the close-packed direction: run r holds particles
  /// row_begin[r] .. row_begin[r + 1] - 1. Empty for random packings.
  std::vector<int> row_begin;
  /// Of the packing that this is a part of; none: it is the whole.
  std::optional<WholeSizes> whole;

  int size() const { return int(volume.size()); }
};

/// Mean face of the whole cells of a lattice, of all cells where there is none, in m^2; and the
/// largest diameter at which particles touch, in m. Of the whole packing.
template <int dim>
double mean_face_area(const Packing<dim> &packing);
template <int dim>
double largest_diameter(const Packing<dim> &packing);

/// Marks the faces whose centres' segment crosses one of the cracks, and keeps these.
template <int dim>
void cut_faces(Packing<dim> &packing, const std::vector<CrackPlane<dim>> &cracks);

/// Particles at rest with the cells of the packing: mass = density V, inertia m d^2/8 (2D, disc) or
/// m d^2/10 (3D, sphere) with the particle's own mass. Density in kg/m^3, or one for each material.
/// Throws core::InputError unless it is positive.
template <int dim>
void fill_particles(const Packing<dim> &packing, const std::vector<double> &densities,
                    particles::Particles<dim> &particles);
template <int dim>
void fill_particles(const Packing<dim> &packing, double density,
                    particles::Particles<dim> &particles)
{
  fill_particles(packing, std::vector<double>{density}, particles);
}
} // namespace ligament::packings
