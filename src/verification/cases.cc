#include "src/verification/cases.h"

#include "core/check.h"
#include "src/verification/bodies/waves_twin.h"
#include "src/verification/cases/atoms.h"
#include "src/verification/cases/breaking.h"
#include "src/verification/cases/closed_crack.h"
#include "src/verification/cases/face_life.h"
#include "src/verification/cases/flow.h"
#include "src/verification/cases/lab.h"
#include "src/verification/cases/lab_general_cells.h"
#include "src/verification/cases/law.h"
#include "src/verification/cases/law_viscous.h"
#include "src/verification/cases/softening.h"
#include "src/verification/cases/softening_flow.h"
#include "src/verification/cases/static.h"

namespace ligament::program
{
std::vector<Case> all_cases()
{
  std::vector<Case> cases;
  const auto add = [&](std::vector<Case> more) {
    cases.insert(cases.end(), more.begin(), more.end());
  };
  add(moduli_cases());
  add(rotation_cases());
  add(patch_cases());
  add(critical_step_cases());
  add(regime_cases());
  add(coarse_mass_cases());
  add(drift_cases());
  add(wave_cases());
  add(waves_twin_cases());
  add(scheme_cases());
  add(wave_bench_cases());
  add(absorbing_cases());
  add(absorbing_steady_cases());
  add(kirsch_cases());
  add(beam_cases());
  add(cantilever_cases());
  add(stability_cases());
  add(contrast_cases());
  add(compression_cases());
  add(breaking_cases());
  add(closed_crack_cases());
  add(toughness_cases());
  add(toughness_3d_cases());
  add(toughness_mixed_cases());
  add(static_cases());
  add(static_run_cases());
  add(lab_gauges_cases());
  add(lab_cases());
  add(lab_general_cells_cases());
  add(lab_hertz_cases());
  add(lab_shapes_cases());
  add(lab_kirsch_cases());
  add(lab_periodic_cases());
  add(lab_oblique_cases());
  add(lab_ring_cases());
  add(law_cases());
  add(flow_strip_cases());
  add(flow_cone_cases());
  add(flow_balance_cases());
  add(law_viscous_cases());
  add(softening_cases());
  add(face_life_cases());
  add(softening_flow_cases());
  add(atom_cases());
  add(atom_strain_cases());
  add(atom_cleavage_cases());
  add(atom_crack_disc_cases());
  add(atom_emission_cases());
  add(atom_heat_cases());
  add(atom_motion_cases());
  add(atom_wave_cases());
  add(random_scene_cases());
  return cases;
}

std::vector<Case> select_cases(const std::string &name, bool full)
{
  std::vector<Case> selected;
  std::string names;
  bool is_only_slow = false;
  for (const auto &c : all_cases()) {
    names += (names.empty() ? "" : ", ") + c.name;
    if (c.name == name)
      return {c};
    if (c.name.compare(0, name.size(), name) != 0)
      continue;
    if (full || !c.slow)
      selected.push_back(c);
    else
      is_only_slow = true;
  }
  core::require(!selected.empty() || !is_only_slow,
                "the cases beginning with \"" + name + "\" are slow; add --full");
  core::require(!selected.empty(), "no case \"" + name + "\"; there are " + names);
  return selected;
}
} // namespace ligament::program
