// One bonded face: its reference geometry, its stiffness, and how it answers to the motion of its
// two particles.
#pragma once

#include "dem/turn.h"

namespace ligament::dem
{
template <int dim>
struct Bond
{
  int i, j;
  Vector<dim> normal;              // unit, i -> j, reference
  Vector<dim> lever_i, lever_j;    // m, centre to face point, reference
  double area, distance;           // S in m^2, r0 in m
  double bending, twist;           // k_b, k_t in N m, weight included
  double weight = 1;               // share of the pair's energy that counts
  double shear_i = 0, shear_j = 0; // G of both sides, Pa
  bool joins_materials = false;    // of different elastic constants
};

/// Relative motion of a bonded face.
template <int dim>
struct BondMotion
{
  Vector<dim> a_i, a_j; // m, present levers
  Vector<dim> du;       // m, Du of theory.md eq. (D8b)
  Vector<dim> elastic;  // m, Du without its plastic part

  BondMotion(const Bond<dim> &bond, const Turn<dim> &turn_i, const Turn<dim> &turn_j,
             const Vector<dim> &u_i, const Vector<dim> &u_j)
  {
    const Vector<dim> change_i = turn_i.change(bond.lever_i),
                      change_j = turn_j.change(bond.lever_j);
    a_i = bond.lever_i + change_i;
    a_j = bond.lever_j + change_j;
    du = (u_j - u_i) + (change_j - change_i);
    elastic = du;
  }
};

/// Unit normal of the face at present: the mean of the two sides' turned normals.
template <int dim>
Vector<dim> present_normal(const Bond<dim> &bond, const Turn<dim> &turn_i, const Turn<dim> &turn_j)
{
  return (2 * bond.normal + turn_i.change(bond.normal) + turn_j.change(bond.normal)).normalized();
}

/// Torque of bending and twist on i, minus that on j (N m, space axes), theory.md eq. (D4): minus
/// the exact gradient of bending_energy.
inline Spin<2> bending_torque(const Bond<2> &bond, const particles::Particles<2> &p)
{
  return Spin<2>(bond.bending * (p.rotation[0][bond.j] - p.rotation[0][bond.i]));
}

inline double bending_energy(const Bond<2> &bond, const particles::Particles<2> &p)
{
  const double angle = p.rotation[0][bond.j] - p.rotation[0][bond.i];
  return 0.5 * bond.bending * angle * angle;
}

/// conj(q_i) q_j: the rotation of j as i sees it.
inline Turn<3> relative_turn(const Turn<3> &i, const Turn<3> &j)
{
  return {i.w * j.w + i.v.dot(j.v), i.w * j.v - j.w * i.v - i.v.cross(j.v)};
}

inline Spin<3> bending_torque(const Bond<3> &bond, const particles::Particles<3> &p)
{
  const Turn<3> turn_i = Turn<3>::of(p, bond.i),
                rel = relative_turn(turn_i, Turn<3>::of(p, bond.j));
  const Vector<3> kv =
      bond.bending * rel.v + (bond.twist - bond.bending) * bond.normal.dot(rel.v) * bond.normal;
  const Vector<3> body = 2 * (rel.w * kv + rel.v.cross(kv));
  return body + turn_i.change(body);
}

inline double bending_energy(const Bond<3> &bond, const particles::Particles<3> &p)
{
  const Turn<3> rel = relative_turn(Turn<3>::of(p, bond.i), Turn<3>::of(p, bond.j));
  const double vn = bond.normal.dot(rel.v);
  return 2 * (bond.bending * rel.v.squaredNorm() + (bond.twist - bond.bending) * vn * vn);
}
} // namespace ligament::dem
