// A strip between smooth grips that are drawn apart slowly while a crack runs along it: the energy
// that a length of it holds is known, and so is K_I wherever the tip or the front is.
#pragma once

#include "dem/fracture_law.h"
#include "dem/material.h"
#include "packings/packing.h"
#include "packings/specimen.h"

namespace ligament::dem
{
/// In spacings d. The tip of the crack is at x = 0, its plane near y = 0; in 3D the strip lies
/// between two smooth walls.
struct CrackStrip
{
  double height = 20, behind = 15, ahead = 14;
  double depth = 4; // 3D
  double run = 2;   // projected length that breaks before K_I is read

  /// A strip of spacing 1 m with its crack; a shorter one as high without.
  template <int dim>
  void lay_out(packings::SpecimenParameters<dim> &parameters, const Vector<2> &tip) const;
  template <int dim>
  void lay_out_whole(packings::SpecimenParameters<dim> &parameters) const;

  /// c = strength sqrt(d)/K_I when the front has run, theory.md eq. (D13c); `cracked` and `whole`
  /// are packings of the two. Throws core::EnvironmentError when nothing runs.
  template <int dim>
  double factor(packings::Packing<dim> cracked, packings::Packing<dim> whole,
                const DemMaterial &material, FractureLaw::Criterion criterion) const;
};
} // namespace ligament::dem
