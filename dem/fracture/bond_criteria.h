// What each bond of a body bears: the criteria of its materials, their measures and strengths, and
// what follows from them for screens.
#pragma once

#include "dem/bonded_body.h"
#include "dem/fracture_law.h"
#include "dem/lattice_kernel.h"

#include <optional>

namespace ligament::dem
{
template <int dim>
class BondCriteria
{
public:
  /// `names` of all particles that no numbering changes (empty: their indices), which scatter
  /// reads.
  BondCriteria(const FractureLaw &law, const BondedBody<dim> &body,
               const std::vector<std::int64_t> &names);

  const FractureLaw &law() const { return law_; }
  bool can_break() const;
  bool break_under_pressure() const;
  bool need_stress() const;
  /// Of two faces closer than this (units of d) one breaks in a step; 0: all at once.
  double apart() const;
  /// Of the first material; by maximum tension if nothing could break; in Pa.
  void set_strength(double strength, const BondedBody<dim> &body);
  /// Other bonds from now on.
  void reset(const BondedBody<dim> &body);

  /// What the kernels look for at this share of the limit; of the table's bonds in terms of the
  /// first material's.
  BreakScreen screen(const Materials &materials, double share, bool of_table) const;
  /// Whether the stresses of particles may clear their bonds.
  bool clear_by_stress() const;
  /// Then: of the screen of stresses, in Pa over that of the measure; and the measure.
  double limit(const Bond<dim> &bond, const Materials &materials) const;
  StressMeasure measure() const { return of_[0].measure.times(of_[0].criterion->least_share); }
  double tangent() const { return of_[0].criterion->tangent; }

  /// What the utilisation is not above, eq. (D12c), for the traction alone (Pa); 0: cannot break.
  double bound(const Bond<dim> &bond, const Vector<dim> &normal, const Vector<dim> &traction,
               const Materials &materials) const;
  /// Tension over strength; what stays below `least` may be a bound of it that does, too.
  double utilisation(LoadedFace<dim> face, const Bond<dim> &bond, const Materials &materials,
                     double least) const;
  /// Of the two materials of a bond the one whose criterion says most; of equals that one whose
  /// faces take less energy.
  int failing_material(LoadedFace<dim> face, const Bond<dim> &bond,
                       const Materials &materials) const;
  /// Whether faces of one material bear unequal strengths.
  bool scatter() const { return names_.has_value(); }

private:
  struct OfMaterial
  {
    const CriterionIn<dim> *criterion; // null: never breaks
    FaceStrength strength;
    StressMeasure measure;
    double whole_face; // m^2, of its size factors; 0: none
  };
  /// visit(material) of those whose criteria a bond obeys.
  template <typename Visit>
  void for_each_of(const Bond<dim> &bond, const Materials &materials, Visit &&visit) const;
  double strength_of(const Bond<dim> &bond, const OfMaterial &of) const;
  double scatter_of(const Bond<dim> &bond, const OfMaterial &of) const;
  double size_factor(const Bond<dim> &bond, const OfMaterial &of) const;

  FractureLaw law_;
  std::vector<OfMaterial> of_;
  bool one_criterion_ = true, one_measure_ = true; // of all materials
  std::optional<particles::GlobalIds> names_;      // where strengths scatter
  double most_weakened_ = 1; // largest size factor of a bond over what scatter leaves of it
};
} // namespace ligament::dem
