// Sides that are joined: a packing that repeats itself is cut out of a wider one, whose further
// particles are images of its own.
#pragma once

#include "packings/lattice_packing.h"
#include "packings/seeds.h"

#include <functional>

namespace ligament::packings
{
/// Box whose content repeats itself along the axes with a period above 0 (m).
template <int dim>
struct PeriodicBox
{
  PeriodicBox() = default;
  /// Axes whose sides the zone doesn't reach are not periodic for it. Throws core::InputError where
  /// it reaches one of two joined sides, for solids, for periods below six spacings, and for cracks
  /// at joined sides.
  explicit PeriodicBox(const SpecimenParameters<dim> &specimen);

  bool is_any() const { return period.maxCoeff() > 0; }
  /// How many periods along each axis a point lies away from the box; within the tolerance (m) of a
  /// side it counts to the next image.
  std::array<int, dim> image(const Vector<dim> &x, double tolerance) const;
  Vector<dim> offset(const std::array<int, dim> &image) const; // m
  /// Into the box.
  Vector<dim> wrapped(const Vector<dim> &x) const { return x - offset(image(x, 0)); }
  /// The seeds, then their images up to `margin` (m) outside. Ids: the k-th image of seed i has
  /// k times the number of seeds, plus i.
  Seeds<dim> with_images(const Seeds<dim> &seeds, double margin) const;
  /// visit(image) of all other boxes that a margin (m) around this one meets.
  void for_each_image(double margin,
                      const std::function<void(const std::array<int, dim> &)> &visit) const;

  Vector<dim> lower = Vector<dim>::Zero(), period = Vector<dim>::Zero();
};

/// Adds the period of the lattice along each periodic axis, the multiple of its own that lies next
/// to the width of the specimen. Throws core::InputError where that is not the width, to 1e-4 of a
/// spacing, with the widths that are.
template <int dim>
void fit_period(const LatticeParameters<dim> &lattice, PeriodicBox<dim> &box);

/// A specimen that goes on beyond periodic sides, with images of holes and notches; packed as far
/// as cells of the box and their neighbours reach.
template <int dim>
SpecimenParameters<dim> widened(const SpecimenParameters<dim> &specimen,
                                const PeriodicBox<dim> &box, double largest_size);
/// m, how far beyond the box it goes on, for particles of up to `largest_size`.
double margin_of(double largest_size);

/// Name of a particle's own and how many periods away it lies.
template <int dim>
struct ImageOf
{
  std::int64_t id;
  std::array<int, dim> image;
};

/// Keeps the particles of the box alone. Neighbours beyond a joined side become images, whose faces
/// have no lattice direction. Faces are sorted by (i, j), i < j.
template <int dim>
Packing<dim> folded(const Packing<dim> &wide, const PeriodicBox<dim> &box,
                    const std::function<ImageOf<dim>(int)> &image_of);
} // namespace ligament::packings
