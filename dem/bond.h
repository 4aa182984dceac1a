// One bonded face: its reference geometry, its stiffness, and the relative motion of its particles.
#pragma once

#include "dem/turn.h"

namespace ligament::dem
{
/// How the image of a particle differs from it, so many periods away along each axis.
template <int dim>
struct PeriodicImage
{
  std::array<int, dim> periods = {};
  Vector<dim> offset = Vector<dim>::Zero(); // m, of its reference
  Vector<dim> jump = Vector<dim>::Zero();   // m, of its displacement, at present
  const PeriodicImage *opposite = nullptr;
};

template <int dim>
struct Bond
{
  int i, j;
  Vector<dim> normal;                        // unit, i -> j, reference
  Vector<dim> lever_i, lever_j;              // m, centre to face point, reference
  double area, distance;                     // S in m^2, r0 in m
  double bending, twist;                     // k_b, k_t in N m, weight included
  double weight = 1;                         // share of the pair's energy that counts
  double shear_i = 0, shear_j = 0;           // G of both sides, Pa
  bool joins_materials = false;              // of different elastic constants
  const PeriodicImage<dim> *image = nullptr; // its side j is this image of j; null: j itself
};

/// Relative motion of a bonded face.
template <int dim>
struct BondMotion
{
  Vector<dim> a_i, a_j; // m, present levers
  Vector<dim> du;       // m, Du of theory.md eq. (D8b)
  Vector<dim> elastic;  // m, Du without what strains of the particles take
  /// What these are of either lever: R e A, m.
  Vector<dim> stretch_i = Vector<dim>::Zero(), stretch_j = Vector<dim>::Zero();

  BondMotion(const Bond<dim> &bond, const Turn<dim> &turn_i, const Turn<dim> &turn_j,
             const Vector<dim> &u_i, const Vector<dim> &u_j)
  {
    const Vector<dim> change_i = turn_i.change(bond.lever_i),
                      change_j = turn_j.change(bond.lever_j);
    a_i = bond.lever_i + change_i;
    a_j = bond.lever_j + change_j;
    du = (u_j - u_i) + (change_j - change_i);
    if (bond.image)
      du += bond.image->jump;
    elastic = du;
  }

  /// Both levers take part of the motion.
  void stretch(const Vector<dim> &by_i, const Vector<dim> &by_j)
  {
    stretch_i = by_i;
    stretch_j = by_j;
    elastic = du - stretch_i + stretch_j;
  }
};

/// Unit normal of the face at present: the mean of the two sides' turned normals.
template <int dim>
Vector<dim> present_normal(const Bond<dim> &bond, const Turn<dim> &turn_i, const Turn<dim> &turn_j)
{
  return (2 * bond.normal + turn_i.change(bond.normal) + turn_j.change(bond.normal)).normalized();
}
} // namespace ligament::dem
