// A disc of atoms around the front of a crack, its rim held at the field of a stress intensity.
#pragma once

#include "md/atom_force.h"
#include "md/griffith.h"

#include <vector>

namespace ligament::program
{
/// The crack lies across y at x < 0, its front along z, which repeats itself. Its flanks see each
/// other: it may close as well as open.
class CrackDisc
{
public:
  /// `radius` in m, the rim of twice the cut-off included. Throws core::InputError where planes
  /// across z are no mirrors.
  CrackDisc(const md::Crystal<3> &crystal, double radius);

  /// Moves the rim to this stress intensity over Griffith's, the rest along by the field's
  /// difference, and lets it come to rest: to 2 meV/angstrom, or 4000 evaluations.
  void load(double share);

  /// x in m of the foremost bond between nearest neighbours across the plane of the crack that has
  /// parted; -infinity: none has.
  double tip() const;
  /// Bonds that have parted elsewhere.
  int slipped() const;

private:
  struct Bond
  {
    int i, j;
    double x; // m, of its middle
    bool across;
  };
  bool is_parted(const Bond &bond) const;
  void relax();

  double period_;     // m, along z
  double limit_;      // m, longer bonds have parted
  double griffith_k_; // Pa sqrt(m)
  double share_ = 0;
  md::CrackField field_;
  packings::Packing<3> packing_;
  particles::Particles<3> atoms_;
  md::AtomForce<3> force_;
  std::vector<int> free_;
  std::vector<Bond> bonds_;
};
} // namespace ligament::program
