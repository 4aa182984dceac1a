// The factor c between toughness and strength: where a crack runs, its faces carry
// sigma = c K_I / sqrt(d) when they break, found by static solves in the near field of its tip.
#pragma once

#include "dem/fracture_law.h"
#include "dem/material.h"
#include "packings/lattice_packing.h"
#include "packings/random_packing.h"

namespace ligament::dem
{
/// Where a crack points to: its direction of growth and the normal of its plane, unit vectors.
template <int dim>
struct CrackAxes
{
  Vector<dim> growth = Vector<dim>::Unit(0);
  Vector<dim> normal = Vector<dim>::Unit(1);
};

/// The body around a crack tip. It carries the displacements of linear elastic fracture mechanics
/// outside the radius, with the origin midway between the last cut and the first intact face;
/// inside it is solved.
struct CrackPatch
{
  /// Of the crack plane and of the tip's place in it (growth and normal axes), in d, against the
  /// centre of the packing: a centre of inversion of a lattice.
  Vector<2> shift = {0.1, 0};
  double radius = 15;  // d
  double depth = 4;    // d, 3D: a slab in plane strain between smooth walls
  double t_stress = 0; // stress along the crack beside the singular field, in K_I/sqrt(d)
};

/// Raised whenever calibrate_toughness answers otherwise: what was kept before is found anew.
inline constexpr int toughness_method = 5;

/// c for mode I on a lattice at this orientation (LatticeParameters); strength = c K_Ic / sqrt(d)
/// then lets a crack run at K_Ic whatever d (theory.md section 1.6).
///
/// The crack runs 6 d, face after face, with the stress along it that a crack of 2a = 80 d has
/// under tension. A face that is harder than those before it breaks in their wave: c is the least
/// of the largest factors in stretches of 1.5 d. In 3D a front runs 2 d along a strip, eq. (D13c).
/// Off the rows the mean of four cracks at different places of the lattice, as the mirror image has
/// them.
template <int dim>
double calibrate_toughness(packings::LatticeKind kind, const Spin<dim> &orientation,
                           const DemMaterial &material, FractureLaw::Criterion criterion,
                           const CrackAxes<dim> &crack = {});

/// The same on a random packing: the mean over cracks in samples of their own, 8 to 32 of them
/// until it is known to half a per cent (3D: 4), each with the same relaxation and size ratio. The
/// packing's own seed is not read.
template <int dim>
double calibrate_toughness(const packings::RandomParameters<dim> &packing,
                           const DemMaterial &material, FractureLaw::Criterion criterion);

/// The factor of the first face alone.
template <int dim>
double crack_tip_factor(packings::LatticeKind kind, const Spin<dim> &orientation,
                        const DemMaterial &material, FractureLaw::Criterion criterion,
                        const CrackAxes<dim> &crack, const CrackPatch &patch);
/// In the sample of this seed.
template <int dim>
double crack_tip_factor(const packings::RandomParameters<dim> &packing, int seed,
                        const DemMaterial &material, FractureLaw::Criterion criterion,
                        const CrackPatch &patch);
} // namespace ligament::dem
