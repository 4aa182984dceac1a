// What the couplers may be told, with its defaults.
#pragma once

#include "coupling/scheme.h"

#include <array>
#include <cstdint>
#include <string>

namespace ligament::coupling
{
struct FineScaleSplitParameters
{
  int step_ratio = 1;     // m: the far field acts once per m steps
  double fine_damper = 8; // c_f
  double gap_filter = 4;  // c_g
  bool patch_fit = true;
  Solver solver = Solver::eigen;
  /// The regime may become nonlinear after bonds have broken: what its energy needs of the body is
  /// kept from the beginning, as all other terms of the overlap are those of the body as it was made.
  bool may_become_nonlinear = false;
  /// Factor on the particles' share of M_c; the far field's density carries it already.
  double coarse_mass = 1;
  /// kT in J; above 0 the fine damper is the friction of a heat bath for w, and no damper.
  double thermal_energy = 0;
  std::int64_t seed = 1;    // of its random numbers
  double zone_friction = 0; // 1/s, of a bath for the particles outside the overlap; 0: none
};

struct BridgingDomainParameters
{
  Scheme scheme = Scheme::acceleration;
  double fine_damper = 8; // c_f
  DamperForm damper_form = DamperForm::symmetrised;
  int multiplier_cells = 1;
  /// Normal strains (xx, yy, zz) at which constant forces cancel the ghost forces; 0: none.
  std::array<double, 3> reference_strain = {};
  Solver solver = Solver::eigen;
};
} // namespace ligament::coupling
