// The laws of dem/laws on doubles, for one bond and the state of its two particles.
#pragma once

#include "dem/bond.h"
#include "dem/laws/bending.h"
#include "dem/laws/elastic_bond.h"

namespace ligament::dem
{
template <int dim>
using BondLaw = HWY_NAMESPACE::ElasticBond<double, Vector<dim>>;

/// Of `share` of the energy of a bond within one material.
template <int dim>
BondLaw<dim> law_of(const Bond<dim> &bond, double share)
{
  const double area_r = bond.area / bond.distance;
  return {share * 2 * bond.shear_i * area_r, area_r};
}
template <int dim>
BondLaw<dim> law_of(const Bond<dim> &bond)
{
  return law_of(bond, bond.weight);
}

/// Torque of bending and twist on i, minus that on j (N m, space axes): minus the exact gradient of
/// bending_energy.
inline Spin<2> bending_torque(const Bond<2> &bond, const particles::Particles<2> &p)
{
  const HWY_NAMESPACE::PlaneBending<double> law{bond.bending};
  return Spin<2>(law.add_torque(p.rotation[0][bond.j] - p.rotation[0][bond.i], 0));
}

/// In J.
inline double bending_energy(const Bond<2> &bond, const particles::Particles<2> &p)
{
  const HWY_NAMESPACE::PlaneBending<double> law{bond.bending};
  const double turn = p.rotation[0][bond.j] - p.rotation[0][bond.i];
  return law.add_twice_energy(turn * turn, 0) / 2;
}

inline Spin<3> bending_torque(const Bond<3> &bond, const particles::Particles<3> &p)
{
  const auto i = Turn<3>::of(p, bond.i), j = Turn<3>::of(p, bond.j);
  const HWY_NAMESPACE::SpaceBending<double> law{bond.bending, bond.twist - bond.bending};
  const Vector<3> v = HWY_NAMESPACE::relative_turn(i.w, i.v, j.w, j.v);
  const Vector<3> half =
      law.add_half_couple(bond.normal, i.w * j.w + i.v.dot(j.v), v, Vector<3>(Vector<3>::Zero()));
  const Vector<3> body = 2 * half;
  return body + i.change(body);
}

inline double bending_energy(const Bond<3> &bond, const particles::Particles<3> &p)
{
  const auto i = Turn<3>::of(p, bond.i), j = Turn<3>::of(p, bond.j);
  const HWY_NAMESPACE::SpaceBending<double> law{bond.bending, bond.twist - bond.bending};
  const Vector<3> v = HWY_NAMESPACE::relative_turn(i.w, i.v, j.w, j.v);
  const double vn = bond.normal.dot(v);
  return 2 * law.add_half_energy(v.squaredNorm(), vn * vn, 0);
}
} // namespace ligament::dem
