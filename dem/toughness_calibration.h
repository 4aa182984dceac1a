// The factor c between toughness and strength: the first intact face ahead of a crack carries
// sigma = c K_I / sqrt(d), found by a static solve in the near field of a crack tip.
#pragma once

#include "dem/material.h"
#include "particles/lattice_packing.h"
#include "particles/random_packing.h"

namespace ligament::dem
{
/// Where a crack points to: its direction of growth and the normal of its plane, unit vectors.
template <int dim>
struct CrackAxes
{
  Vector<dim> growth = Vector<dim>::Unit(0);
  Vector<dim> normal = Vector<dim>::Unit(1);
};

/// c for mode I on a lattice at this orientation (LatticeParameters); strength = c K_Ic / sqrt(d)
/// then lets a crack start at K_Ic whatever d. A patch of radius 30 d (3D: a slab of radius 8 d
/// in plane strain) carries the displacements of linear elastic fracture mechanics outside, with
/// the origin midway between the last cut and the first intact face; inside it is solved.
///
/// Where a row lies in the crack plane all tips are alike. Otherwise tips differ (hexagonal, 30
/// degrees off a row: 0.60 to 0.87) and c is the largest of a few at different places of the
/// lattice: a straight crack then never starts below K_Ic, but it can start up to 45 % above it.
template <int dim>
double calibrate_toughness(particles::LatticeKind kind, const Spin<dim> &orientation,
                           const DemMaterial &material, const CrackAxes<dim> &crack = {});

/// The same at one place: the crack plane shifted by `shift` (units of d, growth and normal axes)
/// against the centre of inversion of the lattice, within `radius` (units of d).
template <int dim>
double crack_tip_factor(particles::LatticeKind kind, const Spin<dim> &orientation,
                        const DemMaterial &material, const CrackAxes<dim> &crack,
                        const Vector<2> &shift, double radius);

/// c for mode I on a random packing: the mean over 16 (3D: 4) crack tips, each in a sample of its
/// own with the same relaxation and size ratio. Tips differ by some 10 %: a crack starts where it
/// finds a weak one, and c says what a mean one carries. Within 8 d (3D: 5 d in a slab of 4 d).
template <int dim>
double calibrate_toughness(const particles::RandomParameters<dim> &packing,
                           const DemMaterial &material);

/// One tip, in the sample of this seed, within `radius` (units of d).
template <int dim>
double crack_tip_factor(const particles::RandomParameters<dim> &packing, int seed,
                        const DemMaterial &material, double radius);
} // namespace ligament::dem
