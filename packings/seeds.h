// Points with radii from which irregular packings grow their cells.
#pragma once

#include "packings/specimen_shape.h"

#include <cstdint>
#include <string>

namespace ligament::packings
{
/// The cell of a seed is its Laguerre cell for the weight radius^2, its Voronoi cell where all
/// radii are equal (docs/theory.md, "Random packings").
template <int dim>
struct Seeds
{
  std::vector<Vector<dim>> centre; // m
  std::vector<double> radius;      // m
  std::vector<std::int64_t> id;    // not negative; names that no two seeds share
  std::vector<int> material;       // number of each seed's material; empty: all 0

  int size() const { return int(centre.size()); }
  void add(const Vector<dim> &x, double r, std::int64_t name)
  {
    centre.push_back(x), radius.push_back(r), id.push_back(name);
  }
};

/// Seeds drawn in [lower, upper], in m: one in every cube (square) of the volume that belongs to
/// the spacing, anywhere in it with equal probability; those in the material are kept. Radii lie
/// between one and `size_ratio` times the smallest, their logarithms with equal probability; the
/// mean of radius^dim is (d/2)^dim. Every seed follows from `seed` and its cube alone, so that a
/// part of the specimen gets the seeds that the whole specimen has there. Sorted by id, which is
/// the Z-order of the cubes.
template <int dim>
Seeds<dim> draw_seeds(const SpecimenShape<dim> &shape, double spacing, int seed, double size_ratio,
                      const Vector<dim> &lower, const Vector<dim> &upper);

/// Without materials.
template <int dim>
Seeds<dim> sorted_by_id(Seeds<dim> seeds);

/// Mean volume of a cell of a random packing (m^dim): sqrt(3)/2 d^2 or d^3/sqrt(2), that of the
/// densest lattice.
template <int dim>
double mean_cell_volume(double spacing);

/// Side of a square (cube) of that volume, in m.
template <int dim>
double mean_distance(double spacing);

/// "x, y[, z]" for messages.
template <int dim>
std::string place_text(const Vector<dim> &x);
} // namespace ligament::packings
