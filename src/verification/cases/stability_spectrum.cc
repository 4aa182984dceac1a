// All eigenvalues of the step operator of small bodies: step ratios, dampers, every scheme.
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases/stability.h"
#include "src/verification/instruments/step_operator.h"

namespace ligament::program
{
namespace
{
std::vector<Result> spectrum()
{
  using coupling::Scheme;
  std::vector<StabilitySetting> settings;
  // Step ratios near 0.6 of the far field's stable step, which is where `run` refuses.
  for (const bool damped : {false, true}) {
    settings.push_back({"hexagonal", 2, 0.3, 0.9, Scheme::fine_scale_split, 1, 4.1, 2, damped});
    settings.push_back({"hexagonal", 2, 0.3, 0.9, Scheme::fine_scale_split, 2, 4.1, 2, damped});
    settings.push_back({"hexagonal", 2, 0.3, 0.9, Scheme::fine_scale_split, 3, 4.1, 2, damped});
    settings.push_back({"hexagonal", 2, 0.3, 0.8, Scheme::fine_scale_split, 4, 4.1, 2, damped});
    settings.push_back({"random", 2, 0.2, 0.9, Scheme::fine_scale_split, 2, 4.1, 2, damped});
    for (const Scheme scheme : {Scheme::acceleration, Scheme::xiao_belytschko,
                                Scheme::xiao_belytschko_lumped, Scheme::pointwise})
      settings.push_back({"square", 2, 0.49, 0.95, scheme, 1, 4.1, 3, damped});
  }
  for (const char *packing : {"hexagonal", "square", "random"})
    settings.push_back({packing, 2, 0.49, 0.95, Scheme::fine_scale_split, 1, 4.1, 3, true});
  std::vector<Result> results;
  for (const auto &setting : settings) {
    UnitBody<2> unit(held(setting.scene(2.2 * setting.cell_size)));
    results.push_back(
        {"stability_spectrum/" + setting.name(), largest_growth(unit.body), 1e-9, {}});
  }
  return results;
}
} // namespace

Scene held(Scene scene)
{
  for (const int side : {2, 3}) {
    LoadParameters load;
    load.boundary = side;
    load.kind = LoadKind::velocity;
    for (int c = 0; c < 2; ++c)
      load.value[c] = 0;
    load.velocity = load.value;
    scene.loads.push_back(load);
  }
  return scene;
}

std::vector<Case> spectrum_cases()
{
  return {
      {"stability_spectrum",
       "largest modulus of an eigenvalue of the step operator less one, bodies of 300 particles",
       true, spectrum}};
}
} // namespace ligament::program
