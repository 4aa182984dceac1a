// The bond between two materials, theory.md section 1.9: its two sides are in series.
#pragma once

#include "dem/bond.h"

namespace ligament::dem
{
/// The face divides Du = d_i + d_j so that both sides have one traction, eq. (D18).
template <int dim>
struct SeriesBond
{
  double area;                // S, m^2
  double q_i, q_j;            // m, levers along the normal
  double c_i, c_j;            // q / 2G, m/Pa
  Vector<dim> unit_i, unit_j; // levers over q, out of the particles that they belong to
  BondMotion<dim> motion;

  SeriesBond(const Bond<dim> &b, const BondMotion<dim> &m) : area(b.area), motion(m)
  {
    q_i = b.lever_i.dot(b.normal);
    q_j = -b.lever_j.dot(b.normal);
    c_i = q_i / (2 * b.shear_i);
    c_j = q_j / (2 * b.shear_j);
    unit_i = m.a_i / q_i;
    unit_j = -m.a_j / q_j;
  }

  /// In Pa, under the pressures lambda theta of both.
  Vector<dim> traction(double p_i, double p_j) const
  {
    return (motion.elastic + c_i * p_i * unit_i + c_j * p_j * unit_j) / (c_i + c_j);
  }
  Vector<dim> d_i(const Vector<dim> &t, double p_i) const { return c_i * (t - p_i * unit_i); }
  Vector<dim> d_j(const Vector<dim> &t, double p_j) const { return c_j * (t - p_j * unit_j); }
  /// With what the strains of the particles take: Du = whole_i + whole_j.
  Vector<dim> whole_i(const Vector<dim> &t, double p_i) const
  {
    return d_i(t, p_i) + motion.stretch_i;
  }
  Vector<dim> whole_j(const Vector<dim> &t, double p_j) const
  {
    return d_j(t, p_j) - motion.stretch_j;
  }

  /// Parts of V theta of i and j, eq. (D19), in m^3.
  double dilatation_i(const Vector<dim> &t, double p_i) const
  {
    return area * unit_i.dot(d_i(t, p_i));
  }
  double dilatation_j(const Vector<dim> &t, double p_j) const
  {
    return area * unit_j.dot(d_j(t, p_j));
  }

  /// Torques of the traction on i and j, N m, bending aside: theta depends on the levers that turn
  /// with the particles.
  Spin<dim> torque_i(const Vector<dim> &t, double p_i) const
  {
    return cross(Vector<dim>(motion.a_i + motion.stretch_i), area * t) - area * p_i * cross(unit_i, d_i(t, p_i));
  }
  Spin<dim> torque_j(const Vector<dim> &t, double p_j) const
  {
    return -cross(Vector<dim>(motion.a_j + motion.stretch_j), area * t) - area * p_j * cross(unit_j, d_j(t, p_j));
  }

  /// In J of what is elastic, pressures and bending aside.
  double energy(const Vector<dim> &t, double p_i, double p_j) const
  {
    return 0.5 * area * (d_i(t, p_i).squaredNorm() / c_i + d_j(t, p_j).squaredNorm() / c_j);
  }
  /// The same as if the whole motion were elastic: the first part of eq. (D20b).
  double whole_energy(const Vector<dim> &t, double p_i, double p_j) const
  {
    return 0.5 * area *
           (whole_i(t, p_i).squaredNorm() / c_i + whole_j(t, p_j).squaredNorm() / c_j);
  }

  /// The bond in the system for the pressures p of both particles, eqs. (D18) and (D19):
  /// V theta = of_motion - (ii p_i + ij p_j) and likewise for j; m^3/Pa and m^3.
  struct Coupling
  {
    double ii, ij, jj, of_motion_i, of_motion_j;
  };
  Coupling coupling() const
  {
    const double c = c_i + c_j, k = area * c_i * c_j / c;
    return {k * unit_i.squaredNorm(), -k * unit_i.dot(unit_j), k * unit_j.squaredNorm(),
            area * c_i / c * unit_i.dot(motion.elastic),
            area * c_j / c * unit_j.dot(motion.elastic)};
  }
};
} // namespace ligament::dem
