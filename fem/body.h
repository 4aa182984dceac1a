// What the mesh is made of.
#pragma once

#include "core/types.h"

namespace ligament::fem
{
/// Body of the mesh: stiffness equal to that of the discrete law, of any symmetry.
template <int dim>
struct Body
{
  Stiffness<dim> stiffness; // Pa
  double density;           // kg/m^3
  double thickness = 1;     // m, 2D
  /// Pa, Voigt: of the reference, from which displacements count. Adds 1/2 (H stress) : H to the
  /// energy per volume of a displacement gradient H (theory.md eq. (C23)).
  Strain<dim> stress = Strain<dim>::Zero();
};

/// Component by component the speed in m/s at which a motion along it leaves through a plane
/// across the axis: the diagonal of the root of the acoustic tensor over the density. A plane wave
/// along the axis meets its own impedance where the axis is one of the material's, too.
template <int dim>
Vector<dim> normal_wave_speeds(const Body<dim> &body, int axis);
} // namespace ligament::fem
