// Which bonds break: the criteria of theory.md section 1.6, looked at only where a bound of the
// kernels says that they could hold.
#pragma once

#include "dem/fracture/bond_criteria.h"
#include "dem/parts/cohesive_faces.h"
#include "dem/stress_screen.h"
#include "dem/stressed_body.h"

namespace ligament::dem
{
using particles::Utilisation, particles::Watch;

/// A loaded bond as a criterion looks at it.
template <int dim>
struct BondTension
{
  BondId id;
  Bond<dim> bond;
  Vector<dim> normal, traction; // of the face at present; Pa
  double utilisation;           // tension over strength, or a bound of it; 0: cannot break
};

/// A bond that bears too much, as ranks tell each other of it.
template <int dim>
struct ExceedingBond
{
  std::array<std::int64_t, 2> name; // of its particles, the smaller one first
  double utilisation;
  std::array<double, dim> place; // m, of the face in the reference
  BondId id;                     // on the rank that tells
};

template <int dim>
class BreakSearch
{
public:
  using Particles = particles::Particles<dim>;

  /// Particles `at_interfaces` have bonds to another material; names of all particles that no
  /// numbering changes (empty: their indices), which scatter of strengths reads. Faces that soften
  /// have broken as far as the search knows.
  BreakSearch(const FractureLaw &law, const BondedBody<dim> &body, std::vector<int> at_interfaces,
              const std::vector<std::int64_t> &names, const CohesiveFaces<dim> &softening);

  const FractureLaw &law() const { return criteria_.law(); }
  bool can_break() const { return criteria_.can_break(); }
  bool reads_stresses() const { return criteria_.need_stress(); }
  bool breaks_under_pressure() const { return criteria_.break_under_pressure(); }
  /// By maximum tension if there was no criterion; in Pa.
  void set_strength(double strength, const BondedBody<dim> &body);
  /// See ForceReport::set_noted_share.
  void set_noted_share(double share);

  /// The next evaluation notes what could break.
  void ask(Evaluation<dim> &evaluation, const InelasticStrains<dim> &strains) const;
  /// Of a state that may not stay: it notes what reaches this share of its limit.
  void ask_trial(Evaluation<dim> &evaluation, double share) const;
  /// After it: leaves out what the stresses clear of the particles that it noted.
  void clear_by_stress(const StressedBody<dim> &state, Evaluation<dim> &evaluation);

  /// Of the bonds at hand, in any order, some of them twice. A bond is sure to be among those of a
  /// rank that steps one of its particles.
  std::vector<ExceedingBond<dim>> exceeding_bonds(const StressedBody<dim> &state) const;
  /// Of all that exceed in the body those that break now, each once, in this order.
  std::vector<ExceedingBond<dim>> breaking(std::vector<ExceedingBond<dim>> exceeding,
                                           const BondedBody<dim> &body) const;

  /// Of several bonds only the most loaded one breaks from now on.
  void break_one_by_one() { one_by_one_ = true; }

  /// Largest utilisation of any bond; 0 where none reaches the share that was asked for.
  double largest_share(const StressedBody<dim> &state) const;

  /// See ForceReport::utilisation.
  Utilisation<dim> utilisation(const StressedBody<dim> &state,
                               const std::vector<Watch> &watch) const;

  /// Of the bonds of these particles the one that bears the largest share of its strength by the
  /// criterion; of utilisation 0 where none is under tension, and without a criterion.
  BondTension<dim> weakest_bond(const StressedBody<dim> &state, const std::vector<int> &of) const;

  /// Whether the last evaluation's stresses were asked of many particles.
  bool looks_by_stress() const { return screen_.was_asked(); }

  /// The bond no longer carries.
  void remove(const Bond<dim> &bond) { screen_.remove(bond); }
  /// In m/s; 0: of any.
  double crack_velocity_of(const Bond<dim> &bond, const Materials &materials) const
  {
    return law().crack_velocity_of(materials.number(bond.i), materials.number(bond.j));
  }
  /// Whether faces of one material bear unequal strengths.
  bool strengths_scatter() const { return criteria_.scatter(); }
  /// Of its two materials the one in which a bond bears the larger share of its strength.
  int failing_material(const BondId &id, const Bond<dim> &bond,
                       const StressedBody<dim> &state) const;
  /// Other bonds, or others' strengths, from now on.
  void reset(const BondedBody<dim> &body);

private:
  BreakLook look_at(const Materials &materials, double share, bool cleared_by_stress) const;
  /// With a bound of the utilisation that the traction alone gives, eq. (D12c).
  BondTension<dim> bond_tension(const BondId &id, const Bond<dim> &bond,
                                const StressedBody<dim> &state) const;
  /// The bonds whose bound reaches the share that was asked for, some of them twice.
  std::vector<BondTension<dim>> suspected_bonds(const StressedBody<dim> &state) const;
  /// Utilisations by the criterion in place of their bounds; where they stay below `least`,
  /// something not smaller and below it may stand instead.
  void find_tensions(std::vector<BondTension<dim>> &bonds, const StressedBody<dim> &state,
                     double least) const;

  BondCriteria<dim> criteria_;
  const CohesiveFaces<dim> &softening_;
  std::vector<int> at_interfaces_; // ascending
  std::vector<int> at_images_;     // with a bond to an image, which the screen doesn't know
  double noted_share_ = 1;         // of the limit
  bool one_by_one_ = false;
  StressScreen<dim> screen_;
};
} // namespace ligament::dem
