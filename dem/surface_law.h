// The laws of loaded outer faces: of a side whose motion is prescribed, and under a given traction.
#pragma once

#include "dem/bond_law.h"
#include "dem/loaded_faces.h"

namespace ligament::dem
{
/// theory.md eq. (D9b): a bond of length q to the wall, which sees the particle's pressure along
/// the prescribed part of the normal.
template <int dim>
BondLaw<dim> law_of(const WallFace<dim> &wall)
{
  return {2 * wall.shear_modulus * wall.area / wall.q, wall.area};
}
template <int dim>
Vector<dim> pressed_along(const WallFace<dim> &wall)
{
  return wall.prescribed.cwiseProduct(wall.normal);
}

/// A traction t (Pa) at the present lever a; what it adds to V theta is S a . t / 2G.
template <int dim>
struct TractionLaw
{
  double area, twice_shear; // m^2, Pa

  Vector<dim> force(const Vector<dim> &t) const { return area * t; }
  /// m^3
  double dilatation(const Vector<dim> &t, const Vector<dim> &a) const
  {
    return area * a.dot(t) / twice_shear;
  }
  /// Under the pressure p of the particle: theta depends on the lever that turns with it.
  Spin<dim> torque(const Vector<dim> &t, const Vector<dim> &a, double p) const
  {
    return (1 - p / twice_shear) * cross(a, force(t));
  }
  /// Of the volume's energy with respect to the traction, in m^3.
  Vector<dim> gradient(const Vector<dim> &a, double p) const { return p * area / twice_shear * a; }
};
template <int dim>
TractionLaw<dim> law_of(const TractionFace<dim> &face)
{
  return {face.area, 2 * face.shear_modulus};
}
} // namespace ligament::dem
