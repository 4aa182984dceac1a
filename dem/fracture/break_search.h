// Which bonds break: the criteria of theory.md section 1.6, looked at only where a bound of the
// kernels says that they could hold.
#pragma once

#include "dem/fracture_law.h"
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

template <int dim>
class BreakSearch
{
public:
  using Particles = particles::Particles<dim>;

  /// Particles `at_interfaces` have bonds to another material; names of all particles that no
  /// numbering changes (empty: their indices), which scatter of strengths reads.
  BreakSearch(const FractureLaw &law, const BondedBody<dim> &body, std::vector<int> at_interfaces,
              const std::vector<std::int64_t> &names);

  const FractureLaw &law() const { return law_; }
  bool can_break() const { return law_.criterion != FractureLaw::Criterion::none; }
  bool breaks_under_pressure() const { return can_break() && criterion().breaks_under_pressure(); }
  /// By maximum tension if there was no criterion; in Pa.
  void set_strength(double strength, const BondedBody<dim> &body);
  /// See ForceReport::set_noted_share.
  void set_noted_share(double share);

  /// The next evaluation notes what could break.
  void ask(Evaluation<dim> &evaluation, const PlasticFlow<dim> &flow) const;
  /// Of a state that may not stay: it notes what reaches this share of its limit.
  void ask_trial(Evaluation<dim> &evaluation, double share) const;
  /// After it: leaves out what the stresses clear of the particles that it noted.
  void clear_by_stress(const StressedBody<dim> &state, Evaluation<dim> &evaluation);

  /// Those that break now, in this order.
  std::vector<BondId> exceeding_bonds(const StressedBody<dim> &state) const;

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
  /// Other bonds, or others' strengths, from now on.
  void reset(const BondedBody<dim> &body);

private:
  const CriterionIn<dim> &criterion() const { return law_.criterion.template in<dim>(); }
  /// What the kernels look for; of the table's bonds in terms of the first material's.
  BreakScreen screen(const BondedBody<dim> &body, double share, bool of_table) const;
  const FaceStrength &strength_in(int material) const
  {
    return law_.strengths.empty() ? law_.strength : law_.strengths[material];
  }
  StressMeasure measure_of(const FaceStrength &strength, const DemMaterial &material) const;
  /// Of a bond; only where some scatter.
  double scatter_of(const Bond<dim> &bond, int material) const;
  /// Of a bond in Pa, if it were of one material; and the smaller one of both sides.
  double strength_of(const Bond<dim> &bond, int material) const;
  double strength_of(const Bond<dim> &bond, const Materials &materials) const;
  double size_factor(const Bond<dim> &bond) const;
  /// With a bound of the utilisation that the traction alone gives, eq. (D12c).
  BondTension<dim> bond_tension(const BondId &id, const Bond<dim> &bond,
                                const StressedBody<dim> &state) const;
  /// The bonds whose bound reaches the share that was asked for, some of them twice.
  std::vector<BondTension<dim>> suspected_bonds(const StressedBody<dim> &state) const;
  /// Utilisations by the criterion in place of their bounds; where they stay below `least`,
  /// something not smaller and below it may stand instead.
  void find_tensions(std::vector<BondTension<dim>> &bonds, const StressedBody<dim> &state,
                     double least) const;
  double utilisation(const LoadedFace<dim> &face, const Bond<dim> &bond, double strength,
                     double least) const;

  FractureLaw law_;
  std::vector<StressMeasure> measures_;       // of each material
  bool one_measure_ = true;                   // they are all the same
  std::optional<particles::GlobalIds> names_; // where strengths scatter
  std::vector<int> at_interfaces_;            // ascending
  double noted_share_ = 1;                    // of the limit
  double most_weakened_ = 1; // largest size factor of a bond over what scatter leaves of it
  bool one_by_one_ = false;
  StressScreen<dim> screen_;
};
} // namespace ligament::dem
