// A face that touched and is bonded again: what it keeps of the moment when it was, and what it
// bears in a state of its particles.
#pragma once

#include "dem/bond_law.h"
#include "dem/contacts.h"

#include <algorithm>

namespace ligament::dem
{
/// How two particles are turned against each other where their bond has no couple.
template <int dim>
struct NaturalTurn;
template <>
struct NaturalTurn<2>
{
  double angle = 0; // rad, of j less that of i
};
template <>
struct NaturalTurn<3>
{
  Turn<3> of_i_in_j; // Q of Q_j Q, which is that of i
};

/// theory.md section 1.14. The levers end where the contact touched; opening, turn and strains are
/// such that neither forces nor torques nor pressures nor stresses jumped.
template <int dim>
struct RebondedFace
{
  using Matrix = Eigen::Matrix<double, dim, dim>;

  int i, j;                       // as in the contact
  bool turns_with_i;              // the opening, with the particle of the smaller global id
  Vector<dim> lever_i, lever_j;   // m, in their particles' axes
  Vector<dim> normal_i, normal_j; // unit, i -> j, in their particles' axes
  double area, distance;          // m^2, m
  double shear_modulus;           // Pa
  double bending, twist;          // N m
  double strength, friction;      // Pa, of adhesion; Coulomb's coefficient under it
  Vector<dim> opening;            // w, m
  NaturalTurn<dim> turn;
  /// What V times the strain of either particle has besides S/r d (x) A, m^dim, symmetric.
  Matrix strain_i = Matrix::Zero(), strain_j = Matrix::Zero();
  double flowed = 0; // m, by how much flow had drawn the levers out along the normal
  // Until it acts, from the next step on.
  bool acts = false;
  double pressure_i = 0, pressure_j = 0; // Pa, lambda theta
  double gained = 0;                     // J, by the face beside the volumes

  BondLaw<dim> law() const
  {
    const double area_r = area / distance;
    return {2 * shear_modulus * area_r, area_r};
  }
  /// S a (x) n of either side in its own axes, symmetric, m^dim.
  Matrix moment(bool of_i) const
  {
    const Matrix m = of_i ? Matrix(area * lever_i * normal_i.transpose())
                          : Matrix(-area * lever_j * normal_j.transpose());
    return 0.5 * (m + m.transpose());
  }
};

template <int dim>
Vector<dim> in_space(const Turn<dim> &turn, const Vector<dim> &own)
{
  return own + turn.change(own);
}
template <int dim>
Vector<dim> in_own_axes(const Turn<dim> &turn, const Vector<dim> &v)
{
  return v + turn.inverse().change(v);
}

/// Couple on i in N m (space axes), less that on j; energy in J.
inline Spin<2> couple(const RebondedFace<2> &f, const particles::Particles<2> &p)
{
  return Spin<2>(f.bending * (p.rotation[0][f.j] - p.rotation[0][f.i] - f.turn.angle));
}
inline double couple_energy(const RebondedFace<2> &f, const particles::Particles<2> &p)
{
  const double turn = p.rotation[0][f.j] - p.rotation[0][f.i] - f.turn.angle;
  return 0.5 * f.bending * turn * turn;
}

inline Turn<3> product(const Turn<3> &a, const Turn<3> &b)
{
  return {a.w * b.w - a.v.dot(b.v), a.w * b.v + b.w * a.v + a.v.cross(b.v)};
}
/// Half the couple in the axes of i, and the energy, of a turn of j as i sees it.
inline Vector<3> half_couple(const RebondedFace<3> &f, const Turn<3> &seen)
{
  const HWY_NAMESPACE::SpaceBending<double> law{f.bending, f.twist - f.bending};
  return law.add_half_couple(f.normal_i, seen.w, seen.v, Vector<3>(Vector<3>::Zero()));
}
inline Turn<3> seen_turn(const RebondedFace<3> &f, const particles::Particles<3> &p)
{
  return product(Turn<3>::of(p, f.i).inverse(), product(Turn<3>::of(p, f.j), f.turn.of_i_in_j));
}
inline Spin<3> couple(const RebondedFace<3> &f, const particles::Particles<3> &p)
{
  return in_space<3>(Turn<3>::of(p, f.i), Vector<3>(2 * half_couple(f, seen_turn(f, p))));
}
inline double couple_energy(const RebondedFace<3> &f, const particles::Particles<3> &p)
{
  const HWY_NAMESPACE::SpaceBending<double> law{f.bending, f.twist - f.bending};
  const Turn<3> seen = seen_turn(f, p);
  const double along = f.normal_i.dot(seen.v);
  return 2 * law.add_half_energy(seen.v.squaredNorm(), along * along, 0);
}

/// Couples fall with the square of a face's area, what a contact presses on a part of it with the
/// area: slivers bend too far for what they have to bear, and stay contacts.
constexpr double largest_turn = 0.8; // rad, of theory.md eq. (D45); the sine of it in 3D
inline double least_bending(const RebondedFace<2> &f)
{
  return f.bending;
}
inline double least_bending(const RebondedFace<3> &f)
{
  return std::min(f.bending, f.twist);
}

/// From now on the couple on i is this one (N m, space axes), of no more than largest_turn.
inline void set_couple(RebondedFace<2> &f, const particles::Particles<2> &p, const Spin<2> &wanted)
{
  f.turn.angle = p.rotation[0][f.j] - p.rotation[0][f.i] - wanted[0] / f.bending;
}
inline void set_couple(RebondedFace<3> &f, const particles::Particles<3> &p, const Spin<3> &wanted)
{
  const Turn<3> turn_i = Turn<3>::of(p, f.i), turn_j = Turn<3>::of(p, f.j);
  const Vector<3> half = in_own_axes<3>(turn_i, wanted) / 2;
  const auto answer = [&](const Vector<3> &couple) -> Vector<3> { // of the linear law
    const double along = f.normal_i.dot(couple);
    return (couple - along * f.normal_i) / f.bending + along / f.twist * f.normal_i;
  };
  Turn<3> seen;
  for (int round = 0; round < 60; ++round) { // each leaves a third of it, of small ones less
    const Vector<3> missing = answer(half - half_couple(f, seen));
    seen.v += missing;
    seen.w = std::sqrt(1 - seen.v.squaredNorm());
    if (missing.norm() <= 1e-16)
      break;
  }
  f.turn.of_i_in_j = product(turn_j.inverse(), product(turn_i, seen));
}

/// A rebonded face in a state of its particles, in space.
template <int dim>
struct RebondedState
{
  const RebondedFace<dim> &face;
  BondLaw<dim> law;
  Turn<dim> turn_i, turn_j;
  Vector<dim> a_i, a_j;             // m, present levers
  Vector<dim> opening;              // w
  Vector<dim> d;                    // m, g - w of the gap g between the ends of the levers
  Vector<dim> stretch_i, stretch_j; // m, R e A of the particles' own strains

  /// Strains in the particles' own axes.
  RebondedState(const RebondedFace<dim> &of, const particles::Particles<dim> &p,
                const Eigen::Matrix<double, dim, dim> &strain_i,
                const Eigen::Matrix<double, dim, dim> &strain_j)
      : face(of), law(of.law()), turn_i(Turn<dim>::of(p, of.i)), turn_j(Turn<dim>::of(p, of.j)),
        a_i(in_space<dim>(turn_i, of.lever_i)), a_j(in_space<dim>(turn_j, of.lever_j)),
        opening(in_space<dim>(of.turns_with_i ? turn_i : turn_j, of.opening)), d(gap(p) - opening),
        stretch_i(in_space<dim>(turn_i, Vector<dim>(strain_i * of.lever_i))),
        stretch_j(in_space<dim>(turn_j, Vector<dim>(strain_j * of.lever_j)))
  {
  }

  Vector<dim> gap(const particles::Particles<dim> &p) const
  {
    const Vector<dim> between = get(p.reference, face.j) - get(p.reference, face.i) +
                                (get(p.displacement, face.j) - get(p.displacement, face.i));
    return between + a_j - a_i;
  }
  Vector<dim> normal() const
  {
    return (in_space<dim>(turn_i, face.normal_i) + in_space<dim>(turn_j, face.normal_j))
        .normalized();
  }
  /// On i, in N, under the pressures of both.
  Vector<dim> force(double p_i, double p_j) const
  {
    return law.force(Vector<dim>(d - stretch_i + stretch_j), p_i, a_i, p_j, a_j);
  }
  /// What it adds to V theta of i and of j, in m^3.
  double volume_i() const { return law.add_dilatation(d, a_i, 0) + face.strain_i.trace(); }
  double volume_j() const
  {
    return law.add_dilatation(Vector<dim>(-d), a_j, 0) + face.strain_j.trace();
  }
  /// The same of V times the strain, in the particle's own axes, m^dim.
  Eigen::Matrix<double, dim, dim> strain_i() const
  {
    return law.area_r * in_own_axes<dim>(turn_i, d) * face.lever_i.transpose() + face.strain_i;
  }
  Eigen::Matrix<double, dim, dim> strain_j() const
  {
    return -law.area_r * in_own_axes<dim>(turn_j, d) * face.lever_j.transpose() + face.strain_j;
  }
  /// Torque on i and on j in N m without the couple.
  std::array<Spin<dim>, 2> torques(double p_i, double p_j) const
  {
    const Vector<dim> f = force(p_i, p_j), sheared = law.shear * d;
    std::array<Spin<dim>, 2> t = {
        cross(a_i, Vector<dim>(f - law.area_r * p_i * d)) + cross(stretch_i, sheared),
        cross(a_j, Vector<dim>(law.area_r * p_j * d - f)) - cross(stretch_j, sheared)};
    t[face.turns_with_i ? 0 : 1] += cross(opening, f);
    return t;
  }
  /// In J, beside volumes, couple and what strains of the particles change.
  double shear_energy() const { return law.twice_energy(d) / 2; }
};
} // namespace ligament::dem
