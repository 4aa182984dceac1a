// What the search for breaking bonds asks of a fracture criterion, and how a small struct becomes
// one.
#pragma once

#include "core/types.h"
#include "dem/fracture/face_strength.h"
#include "dem/material.h"
#include "dem/stress_measure.h"

namespace ligament::dem
{
/// A bonded face; of criteria that don't break faces under pressure with sigma = traction . normal
/// above 0.
template <int dim>
struct LoadedFace
{
  Vector<dim> normal;   // unit, at present
  Vector<dim> traction; // Pa, on the side that the normal leaves
  Strain<dim> stress;   // Pa, mean of its particles (D10), Voigt order; of criteria that need it
  StressMeasure measure = {}; // of criteria that have one
};

/// How far stresses of particles may clear faces before these are looked at one by one.
enum class Clearing
{
  by_face,     // not at all
  by_particle, // no tension is above the right side of theory.md eq. (D12d), of criteria that have
               // a measure of (D12f)
  by_stress    // and those of both particles together tell more (dem/stress_screen.h); without a
               // measure eq. (D12) is the tension itself
};

/// A tangent that stands for: faces under pressure break, too.
inline constexpr double either_side = -1;

/// A criterion in one dimension. It calls a bond's load its tension, in Pa: where it reaches the
/// strength over the size factor of the face, the bond breaks.
template <int dim>
struct CriterionIn
{
  /// No tension is above sigma + tangent |tau|, the normal and the tangential traction, or where
  /// it is either_side, above q over least_share, q^2 = max(sigma, 0)^2 + tau^2.
  double tangent;
  double least_share;
  Clearing clearing;
  bool needs_stress; // without it `stress` is zero
  /// Of two faces closer than this (units of d) one alone breaks in a step, that of the larger
  /// tension over its strength; 0: all that exceed break at once.
  double apart;
  /// Of a face of so many whole faces; at least one value is 1 or above.
  double (*size_factor)(double area_ratio);
  double (*tension)(const LoadedFace<dim> &face);
  /// What no tension of the face is above, found in less time.
  double (*bound)(const LoadedFace<dim> &face);
  /// What the stresses of its particles say, in units in which the value of FaceStrength breaks a
  /// face; null: the largest principal stress with the bound of eq. (D12d).
  StressMeasure (*measure)(const FaceStrength &strength, const DemMaterial &material);

  bool breaks_under_pressure() const { return tangent == either_side; }
};

/// Of criteria of tractions and of maximum tension.
struct PlainCriterion
{
  static constexpr double least_share = 1;
  static constexpr StressMeasure (*measure)(const FaceStrength &, const DemMaterial &) = nullptr;
};

struct CriterionRecord
{
  const char *name;
  CriterionIn<2> plane;
  CriterionIn<3> space;
};

/// A criterion or none; cheap to copy.
struct CriterionRef
{
  const CriterionRecord *record = nullptr;

  /// Only where there is one.
  template <int dim>
  const CriterionIn<dim> &in() const
  {
    if constexpr (dim == 2)
      return record->plane;
    else
      return record->space;
  }
  friend constexpr bool operator==(CriterionRef a, CriterionRef b) { return a.record == b.record; }
  friend constexpr bool operator!=(CriterionRef a, CriterionRef b) { return !(a == b); }
};

template <template <int> class C, int dim>
inline constexpr CriterionIn<dim> criterion_in = {
    C<dim>::tangent,     C<dim>::least_share, C<dim>::clearing, C<dim>::needs_stress, C<dim>::apart,
    C<dim>::size_factor, C<dim>::tension,     C<dim>::bound,    C<dim>::measure};

template <template <int> class C>
inline constexpr CriterionRecord criterion_record = {C<2>::name, criterion_in<C, 2>,
                                                     criterion_in<C, 3>};

/// The criterion that a struct with the members of CriterionIn and a name describes.
template <template <int> class C>
constexpr CriterionRef criterion()
{
  return {&criterion_record<C>};
}
} // namespace ligament::dem
