// The stress at a face: the mean tensor of its particles with the face's own traction put in place
// of the tensor's, theory.md eq. (D12e), and which faces it may break.
#pragma once

#include "dem/fracture/criterion.h"
#include "dem/principal_tension.h"

namespace ligament::dem
{
/// What the criteria of whole tensors share.
template <int dim>
struct OwnTraction
{
  /// Of the largest traction that a plane under this stress could free, that of faces that are
  /// asked; and of the strength, so that something is freed at all.
  static constexpr double share = PrincipalTension<dim>::cone, least_share = share / 2;

  /// Symmetric, with the traction of the face on its plane.
  static Strain<dim> stress_of(const LoadedFace<dim> &face)
  {
    const Vector<dim> &n = face.normal;
    const Vector<dim> rest = face.traction - times(face.stress, n);
    const Vector<dim> left = 2 * rest - rest.dot(n) * n;
    Strain<dim> s = face.stress;
    for (int c = 0; c < dim; ++c)
      s[c] += n[c] * left[c];
    for (int a = 0, k = n_strains<dim> - 1; a < dim; ++a)
      for (int b = a + 1; b < dim; ++b, --k)
        s[k] += (n[a] * left[b] + n[b] * left[a]) / 2;
    return s;
  }

  /// What a break frees of a traction: friction may carry what presses.
  static double freed(const LoadedFace<dim> &face)
  {
    const double normal = face.traction.dot(face.normal);
    return normal > 0 ? face.traction.norm() : (face.traction - normal * face.normal).norm();
  }

  /// The measure of the stress where the face bears its part of it, else 0.
  static double tension(const LoadedFace<dim> &face)
  {
    const Strain<dim> stress = stress_of(face);
    const PrincipalRange<dim> range(stress);
    const double value = value_of(face.measure, stress, range), freed = OwnTraction::freed(face),
                 most = std::max(range.largest, (range.largest - range.smallest) / 2);
    return freed >= share * most && freed >= least_share * value ? value : 0;
  }

  static double size_factor(double area_ratio)
  {
    return dim == 2 ? std::pow(std::max(area_ratio, 0.7), 0.3)
                    : std::pow(std::max(area_ratio, 0.5), 0.15);
  }

private:
  static Vector<dim> times(const Strain<dim> &s, const Vector<dim> &n)
  {
    Vector<dim> t;
    for (int c = 0; c < dim; ++c)
      t[c] = s[c] * n[c];
    for (int a = 0, k = n_strains<dim> - 1; a < dim; ++a)
      for (int b = a + 1; b < dim; ++b, --k) {
        t[a] += s[k] * n[b];
        t[b] += s[k] * n[a];
      }
    return t;
  }
};

/// The members that are the same for all criteria with a measure of the whole tensor.
template <int dim>
struct TensorCriterion
{
  using Own = OwnTraction<dim>;

  static constexpr double tangent = either_side;
  static constexpr double least_share = Own::least_share;
  static constexpr Clearing clearing = Clearing::by_stress;
  static constexpr bool needs_stress = true;
  static constexpr double apart = 1.6;

  static double size_factor(double area_ratio) { return Own::size_factor(area_ratio); }
  static double tension(const LoadedFace<dim> &face) { return Own::tension(face); }
  static double bound(const LoadedFace<dim> &face) { return Own::tension(face); }
};

/// Stress across the plane over the sum of those in it: 0 in plane stress, and in 3D.
template <int dim>
double lateral_share(const DemMaterial &material)
{
  return dim == 2 && material.plane == PlaneMode::strain ? material.poissons_ratio : 0;
}

/// Coefficients of sqrt(a s:s - b tr^2) of the tensor in space.
template <int dim>
void set_root(StressMeasure &m, double a, double b, double lateral)
{
  m.square = a;
  m.trace_square = a * lateral * lateral - b * (1 + lateral) * (1 + lateral);
}
} // namespace ligament::dem
