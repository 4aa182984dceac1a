// Stability under stress: a covering set of settings, each accepted and stable, or refused.
#include "src/verification/cases/stability.h"

#include "core/check.h"
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/instruments/covering_set.h"
#include "src/verification/instruments/linear_motion.h"
#include "src/verification/instruments/noise_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ligament::program
{
namespace
{
struct Packing
{
  const char *name;
  int dimension;
};
constexpr Packing packings[] = {{"hexagonal", 2}, {"square", 2},       {"random", 2},
                                {"fcc", 3},       {"simple_cubic", 3}, {"random", 3}};
constexpr double poissons_ratios[] = {0, 0.2, 0.3, 0.45, 0.49};
constexpr double fractions[] = {0.5, 0.9, 0.95};
struct Stepping
{
  coupling::Scheme scheme;
  int step_ratio; // energy-weighted schemes have no other than 1
};
constexpr Stepping steppings[] = {{coupling::Scheme::fine_scale_split, 1},
                                  {coupling::Scheme::fine_scale_split, 2},
                                  {coupling::Scheme::fine_scale_split, 4},
                                  {coupling::Scheme::acceleration, 1}};
constexpr double size_ratios[][3] = {{2.6, 4.1, 7.9}, {2.6, 2.9, 3.1}}; // h/d in 2D, 3D
constexpr int overlaps[] = {2, 3, 4};
/// So small that cubic terms, which make (E1) wander by some strains in 1e5 steps
/// (docs/verification.md, "What the noise runs found"), stay below round-off: what grows here is
/// the linear step.
constexpr double strain = 1e-10;
constexpr int long_run = 100000; // steps, after which a slope stands out of round-off

StabilitySetting setting_of(const std::vector<int> &row)
{
  const Packing packing = packings[row[0]];
  return {packing.name,
          packing.dimension,
          poissons_ratios[row[1]],
          fractions[row[2]],
          steppings[row[3]].scheme,
          steppings[row[3]].step_ratio,
          size_ratios[packing.dimension - 2][row[4]],
          overlaps[row[5]],
          row[6] != 0};
}

/// Settings that once blew up, where no two of their values are at fault alone.
std::vector<StabilitySetting> known_settings()
{
  using coupling::Scheme;
  return {{"square", 2, 0.49, 0.95, Scheme::acceleration, 1, 7.9, 4, true},
          {"square", 2, 0.49, 0.95, Scheme::xiao_belytschko_lumped, 1, 7.9, 4, true},
          {"square", 2, 0.49, 0.95, Scheme::fine_scale_split, 1, 4.1, 3, true},
          {"hexagonal", 2, 0.49, 0.95, Scheme::fine_scale_split, 1, 4.1, 3, true}};
}

/// At most 2000 particles.
Scene scene_of(const StabilitySetting &s)
{
  return s.scene(s.dimension == 2 ? 17 : 2 * s.cell_size + 0.2);
}

/// Modulus less one of the largest eigenvalue of the leap-frog's step operator: symmetric, so that
/// the ends of the spectrum of -accelerations say all.
template <int dim>
double growth(CoupledBody<dim> &body)
{
  LinearMotion<dim> motion(body);
  const auto [least, largest] = motion.squared_frequencies();
  motion.rest();
  const double x = std::sqrt(largest) * body.dt / 2;
  // Rigid motions have the eigenvalue 0 to round-off.
  const double exponent = least < -1e-12 * largest ? std::sqrt(-least) * body.dt : 0;
  return std::max(x > 1 ? std::pow(x + std::sqrt(x * x - 1), 2) - 1 : 0., std::expm1(exponent));
}

/// Largest rise of the energy between samples over the energy at the start.
double largest_rise(const std::vector<double> &series)
{
  double rise = -1;
  for (std::size_t k = 1; k < series.size(); ++k)
    keep_largest(rise, (series[k] - series[k - 1]) / series[0]);
  return rise;
}

/// n_steps of the particles; samples of the energy every five of the far field's steps.
template <int dim>
void judge(const std::string &name, const StabilitySetting &setting, int n_steps,
           std::vector<Result> &results)
{
  UnitBody<dim> unit(scene_of(setting)); // refuses
  const int m = setting.step_ratio;
  if (m == 1 && !setting.damped)
    results.push_back({name + "/growth", growth(unit.body), 1e-9, {}});
  const int interval = 5 * m;
  std::vector<double> energy;
  try {
    energy = run_noise(unit.body, strain, n_steps, interval, 0).leap_frog;
  } catch (const core::InputError &) { // a body that was accepted and blew up
    results.push_back({name + "/energy", std::numeric_limits<double>::quiet_NaN(), 1, {}});
    return;
  }
  if (setting.damped) {
    results.push_back({name + "/rise", largest_rise(energy), m == 1 ? 1e-12 : 5e-3, {}});
    results.push_back({name + "/left", energy.back() / energy.front(), 1, {}});
  } else {
    const Course course = course_of(energy, interval);
    results.push_back({name + "/fluctuation", course.fluctuation, m == 1 ? 1e-8 : 5e-3, {}});
    if (m == 1 && n_steps >= long_run)
      results.push_back({name + "/drift", course.drift, 1e-8, 1e-9});
  }
}

std::vector<Result> stability(const std::string &name, int n_steps)
{
  std::vector<Result> results;
  int n_refused = 0;
  const auto run = [&](const StabilitySetting &setting) {
    const std::string figure = name + "/" + setting.name();
    setting.dimension == 2 ? judge<2>(figure, setting, n_steps, results)
                           : judge<3>(figure, setting, n_steps, results);
  };
  const auto accepts = [&](const std::vector<int> &row) {
    const StabilitySetting setting = setting_of(row);
    try {
      run(setting);
      return true;
    } catch (const core::InputError &error) {
      ++n_refused;
      fmt::print("  refused: {}: {}\n", setting.name(), error.what());
      return false;
    }
  };
  for (const auto &setting : known_settings())
    run(setting);
  const auto set = covering_set({6, 5, 3, 4, 3, 3, 2}, accepts);
  for (const auto &p : set.given_up)
    fmt::print("  refused wherever they met: level {} of factor {}, level {} of factor {}\n", p[1],
               p[0], p[3], p[2]);
  results.push_back({name + "/settings", double(set.rows.size()), 80, {}});
  results.push_back({name + "/refused", double(n_refused), 80, {}});
  results.push_back({name + "/pairs_refused", double(set.given_up.size()), 20, {}});
  return results;
}
std::vector<Result> square_packing()
{
  std::vector<Result> results;
  for (const double nu : {0.45, 0.49})
    judge<2>(fmt::format("stability_square_long/nu_{}", nu),
             {"square", 2, nu, 0.95, coupling::Scheme::fine_scale_split, 1, 4.1, 2, false},
             long_run, results);
  return results;
}
} // namespace

std::string StabilitySetting::name() const
{
  return fmt::format("{}_{}d/nu {} f {} m {} h {} cells {} {} {}", packing, dimension,
                     poissons_ratio, step_fraction, step_ratio, cell_size, overlap_cells,
                     damped ? "damped" : "undamped", coupling::scheme_names[int(scheme)]);
}

Scene StabilitySetting::scene(double width) const
{
  const int transition = 3;
  const double zone = 2 * overlap_cells * cell_size + 8.5,
               whole = zone + 2 * (transition + 3) * cell_size;
  Scene scene = unit_scene(
      dimension, dimension == 2 ? Point{width, whole, 0} : Point{width, width + 0.1, whole},
      poissons_ratio);
  scene.zone.packing = named<PackingKind>(packing);
  add_far_field(scene, dimension == 2 ? Point{0, zone, 0} : Point{0, 0, zone}, cell_size);
  scene.time.step_fraction = step_fraction;
  scene.coupling.scheme = scheme;
  scene.coupling.step_ratio = step_ratio;
  scene.coupling.overlap_cells = overlap_cells;
  scene.coupling.transition_cells = transition;
  if (damped) {
    scene.coupling.fine_damper = 8;
    scene.coupling.gap_filter = is_energy_weighted(scheme) ? 0 : 4;
  }
  return scene;
}

std::vector<Case> stability_cases()
{
  const std::string text = "settings in which any two meet, from noise of strain 1e-10, ";
  std::vector<Case> cases = {
      {"stability", text + "4e3 steps", true, [] { return stability("stability", 4000); }},
      {"stability_long", text + "1e5 steps", true,
       [] { return stability("stability_long", long_run); }},
      {"stability_square_long", "the square packing, whose energy wanders most, 1e5 steps", true,
       square_packing}};
  for (const auto &more : {spectrum_cases(), stress_cases()})
    cases.insert(cases.end(), more.begin(), more.end());
  return cases;
}

std::vector<Case> select_stability(bool full)
{
  std::vector<Case> selected;
  for (const auto &c : all_cases()) {
    const bool is_long = c.name.find("_long") != std::string::npos;
    const bool belongs = c.name.rfind("stability", 0) == 0 || c.name.rfind("spin_", 0) == 0;
    if (belongs && (full || !is_long))
      selected.push_back(c);
  }
  return selected;
}
} // namespace ligament::program
