// A softening face as the sweep sees it in which faces open: numbers alone, so that ranks can tell
// each other of it.
#pragma once

#include "core/check.h"
#include "dem/bond_law.h"
#include "dem/laws/cohesive.h"

#include <array>

namespace ligament::dem
{
/// What an opening w changes of a bond, whether its sides are of one material or in series, (D18):
/// its force by -k w, V theta of i by -s_i a_i . w and that of j by s_j a_j . w.
struct OpenedBond
{
  double shear;            // k, N/m
  double share_i, share_j; // s, m; S/r within a material

  template <int dim>
  static OpenedBond of(const Bond<dim> &b)
  {
    if (!b.joins_materials) {
      const auto law = law_of(b);
      return {law.shear, law.area_r, law.area_r};
    }
    const double c_i = b.lever_i.dot(b.normal) / (2 * b.shear_i),
                 c_j = -b.lever_j.dot(b.normal) / (2 * b.shear_j), k = b.area / (c_i + c_j);
    return {k, k / (2 * b.shear_i), k / (2 * b.shear_j)};
  }

  /// On i, in N, of what of a motion (m) is elastic, under the pressures of both.
  template <int dim>
  Vector<dim> force(const Vector<dim> &left, double p_i, const Vector<dim> &a_i, double p_j,
                    const Vector<dim> &a_j) const
  {
    return shear * left + Vector<dim>(share_i * p_i * a_i - share_j * p_j * a_j);
  }
  /// What an opening adds to V theta of i and of j, in m^3.
  template <int dim>
  double volume_i(const Vector<dim> &a_i, const Vector<dim> &opening) const
  {
    return -(share_i * a_i.dot(opening));
  }
  template <int dim>
  double volume_j(const Vector<dim> &a_j, const Vector<dim> &opening) const
  {
    return share_j * a_j.dot(opening);
  }
};

/// In space, in a state of its particles in which it opens.
template <int dim>
struct SweptFace
{
  std::array<std::int64_t, 2> name; // of both particles, ascending
  int one;                          // of the faces at hand; -1: none of them
  int i, j;                         // of the particles in the sweep
  double unit;                      // m, in which its openings are compared

  CohesiveLaw<dim> law;
  OpenedBond bond;
  double lambda_i, lambda_j; // per volume, Pa/m^3
  Vector<dim> elastic, a_i, a_j, normal;
  Opening<dim> last;                         // from which it opens
  Eigen::Matrix<double, dim, dim> stiffness; // how much of the force an opening takes, N/m

  Opening<dim> opening; // so far

  /// On i, in N.
  Vector<dim> force(double p_i, double p_j) const
  {
    return bond.force<dim>(elastic - opening.jump, p_i, a_i, p_j, a_j);
  }
};

/// The same on its way to other ranks, before it opens. Its particles by their names.
template <int dim>
struct ToldFace
{
  static constexpr int n_numbers = 18 + 5 * dim + dim * dim;

  std::array<std::int64_t, 2> name;
  std::int64_t i, j;
  std::array<double, n_numbers> numbers;
};

/// visit(number) for all that others have to know of a face, and of the pressures of its particles.
template <typename Face, typename Pressure, typename Visit>
void for_each_told_number(Face &f, Pressure &p_i, Pressure &p_j, Visit &&visit)
{
  for (auto *of : {&f.law.strength, &f.law.reach, &f.law.shape.corner_share,
                   &f.law.shape.corner_opening, &f.law.mode_ratio, &f.law.friction, &f.law.excess,
                   &f.law.excess_reach, &f.bond.shear, &f.bond.share_i, &f.bond.share_j,
                   &f.lambda_i, &f.lambda_j, &f.unit, &f.last.largest, &f.last.damage, &p_i, &p_j})
    visit(*of);
  for (auto *of : {&f.elastic, &f.a_i, &f.a_j, &f.normal, &f.last.jump})
    for (int c = 0; c < int(of->size()); ++c)
      visit((*of)[c]);
  for (int c = 0; c < int(f.stiffness.size()); ++c)
    visit(f.stiffness.data()[c]);
}

/// Of one that has not opened yet.
template <int dim>
ToldFace<dim> told_face(const SweptFace<dim> &face, std::int64_t i, std::int64_t j,
                        const double p_i, const double p_j)
{
  ToldFace<dim> t{face.name, i, j, {}};
  auto place = t.numbers.begin();
  for_each_told_number(face, p_i, p_j, [&](double number) { *place++ = number; });
  core::require(place == t.numbers.end(), "numbers of a face were not counted");
  return t;
}

/// And back; where it is here is not known yet.
template <int dim>
SweptFace<dim> heard_face(const ToldFace<dim> &t, double &p_i, double &p_j)
{
  SweptFace<dim> face{};
  face.name = t.name;
  face.one = -1;
  auto place = t.numbers.begin();
  for_each_told_number(face, p_i, p_j, [&](double &number) { number = *place++; });
  face.opening = {face.last.jump, face.last.largest, face.last.damage};
  return face;
}
} // namespace ligament::dem
