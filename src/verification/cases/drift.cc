// Energy of coupled bodies that move as noise: kept when undamped, falling with dampers.
#include "src/verification/bodies/box_zones.h"
#include "src/verification/bodies/grading.h"
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases.h"
#include "src/verification/instruments/noise_run.h"

#include <algorithm>

namespace ligament::program
{
namespace
{
Scene band_2d(int step_ratio)
{
  Scene scene = unit_scene(2, {18, 118, 0}, 0.22);
  add_far_field(scene, {0, 34, 0}, 4.6);
  scene.coupling.step_ratio = step_ratio;
  return scene;
}

Scene band_3d()
{
  Scene scene = unit_scene(3, {6.3, 6.7, 66}, 0.3);
  add_far_field(scene, {0, 0, 23}, 3.1);
  scene.coupling.transition_cells = 4;
  return scene;
}

/// Cells change their size in the overlap.
template <int dim>
Scene graded(const Grading &grading)
{
  Scene scene = dim == 2 ? band_2d(1) : band_3d();
  if (dim == 2)
    scene.specimen.size = {28, 128, 0}, scene.zone.lower[1] = -22, scene.zone.upper[1] = 22;
  else
    scene.specimen.size = {11.3, 10.9, 72}, scene.zone.lower[2] = -18, scene.zone.upper[2] = 18;
  scene.coupling.overlap_cells = 4;
  grading.apply(scene);
  return scene;
}

Scene made_random(Scene scene)
{
  scene.zone.packing = PackingKind::random;
  return scene;
}

/// K of (E7): the modes' shadow energy to 3e-5 at 0.9 of the critical step.
constexpr int shadow_terms = 10;

/// The shadow energy has no trend; the leap-frog's invariant, which is exact for linear forces
/// only, wanders by a share of the strain, with the coupler and without.
template <int dim>
void report(const std::string &name, const Scene &scene, double strain, long n_steps,
            std::vector<Result> &results)
{
  UnitBody<dim> unit(scene);
  const int interval = std::max(long(shadow_terms + 2), n_steps / 4000);
  const auto series = run_noise(unit.body, strain, n_steps, interval, shadow_terms);
  const Course shadow = course_of(series.shadow, interval);
  const Course leap_frog = course_of(series.leap_frog, interval);
  results.push_back({name + "/drift", shadow.drift, 1e-8, 1e-9});
  results.push_back({name + "/fluctuation", shadow.fluctuation, strain, {}});
  results.push_back({name + "/leap_frog_drift", leap_frog.drift, strain, {}});
}

/// The coupled body, and for long runs its discrete zone alone as a twin.
template <int dim>
std::vector<Result> undamped(const std::string &name, const Scene &scene, double strain,
                             long n_steps, bool with_twin)
{
  std::vector<Result> results;
  report<dim>(name, scene, strain, n_steps, results);
  if (!with_twin)
    return results;
  Scene twin = scene;
  twin.specimen.size[dim - 1] = scene.zone.upper[dim - 1] - scene.zone.lower[dim - 1];
  twin.zone.extent = DiscreteZone::Extent::all;
  twin.far_field.reset();
  report<dim>(name + "/discrete", twin, strain, n_steps, results);
  return results;
}

/// Step ratio m > 1: the energy fluctuates with the impulses of the far field, without a trend that
/// stands out of the scatter of its blocks.
std::vector<Result> undamped_ratio(const std::string &name, int step_ratio, double strain,
                                   long n_steps)
{
  UnitBody<2> unit(band_2d(step_ratio));
  const int interval = 5 * step_ratio;
  const auto series = run_noise(unit.body, strain, n_steps, interval, 0);
  const Course c = course_of(series.leap_frog, interval);
  return {{name + "/fluctuation", c.fluctuation, 5e-3, {}},
          {name + "/drift", c.drift, 5e-3, {}},
          {name + "/drift_over_error", c.drift / c.error, 4, {}}};
}

/// Largest rise of the energy from one sample to the next, over that at the start.
double largest_rise(const std::vector<double> &series)
{
  double rise = -1;
  for (std::size_t k = 1; k < series.size(); ++k)
    keep_largest(rise, (series[k] - series[k - 1]) / series[0]);
  return rise;
}

/// Energy-weighted schemes on cells that change their size: those with an invariant keep it, the
/// others only lose.
std::vector<Result> weighted_graded()
{
  using coupling::Scheme;
  std::vector<Result> results;
  for (const auto &[cells, grading] :
       {std::pair{"hanging", hanging_cells}, std::pair{"growing", growing_cells}})
    for (const Scheme scheme : {Scheme::acceleration, Scheme::pointwise, Scheme::xiao_belytschko,
                                Scheme::xiao_belytschko_lumped})
    {
      const std::string name =
          std::string("drift_graded_schemes/") + cells + "/" + coupling::scheme_names[int(scheme)];
      Scene scene = graded<2>(grading);
      scene.coupling.scheme = scheme;
      if (scheme == Scheme::acceleration || scheme == Scheme::pointwise)
        report<2>(name, scene, 1e-8, 5000, results);
      else {
        UnitBody<2> unit(scene);
        const auto series = run_noise(unit.body, 1e-9, 2000, 1, 0).leap_frog;
        results.push_back({name + "/rise", largest_rise(series), 1e-12, 0});
      }
    }
  return results;
}

template <int dim>
std::vector<Result> damped(const std::string &name, Scene scene)
{
  scene.time.step_fraction = 0.95;
  scene.coupling.fine_damper = 8;
  scene.coupling.gap_filter = 4;
  UnitBody<dim> unit(scene);
  const auto series = run_noise(unit.body, 1e-9, dim == 2 ? 4000 : 1000, 1, 0).leap_frog;
  return {{name + "/rise", largest_rise(series), 1e-12, 0},
          {name + "/left", series.back() / series[0], 1, {}}};
}
} // namespace

std::vector<Case> drift_cases()
{
  const std::string text = "undamped noise at 0.9 of the critical step, ";
  const std::string decay = "damped noise at 0.95 of the critical step, every step, ";
  return {
      {"drift", text + "strain 1e-8, 5e3 steps", false,
       [] { return undamped<2>("drift", band_2d(1), 1e-8, 5000, false); }},
      {"drift_3d", text + "FCC, strain 1e-8, 2e3 steps", false,
       [] { return undamped<3>("drift_3d", band_3d(), 1e-8, 2000, false); }},
      {"drift_random", text + "random, strain 1e-8, 5e3 steps", false,
       [] { return undamped<2>("drift_random", made_random(band_2d(1)), 1e-8, 5000, false); }},
      {"drift_random_3d", text + "random, strain 1e-8, 2e3 steps", true,
       [] { return undamped<3>("drift_random_3d", made_random(band_3d()), 1e-8, 2000, false); }},
      {"drift_long_random", text + "random, strain 1e-6, 1e5 steps", true,
       [] {
         return undamped<2>("drift_long_random", made_random(band_2d(1)), 1e-6, 100000, true);
       }},
      {"drift_l_shape", text + "zone with a re-entrant corner, strain 1e-8, 2e3 steps", true,
       [] { return undamped<2>("drift_l_shape", l_shape_2d(0.3), 1e-8, 2000, false); }},
      {"drift_two_zones", text + "two zones, strain 1e-8, 2e3 steps", true,
       [] { return undamped<2>("drift_two_zones", two_zones_2d(0.3), 1e-8, 2000, false); }},
      {"drift_graded", text + "cells double in the overlap, strain 1e-8, 5e3 steps", false,
       [] { return undamped<2>("drift_graded", graded<2>(hanging_cells), 1e-8, 5000, false); }},
      {"drift_graded_3d", text + "FCC, cells double in the overlap, strain 1e-8, 2e3 steps", true,
       [] { return undamped<3>("drift_graded_3d", graded<3>(hanging_cells), 1e-8, 2000, false); }},
      {"drift_graded_random", text + "random, cells double in the overlap, strain 1e-8, 5e3 steps",
       true,
       [] {
         return undamped<2>("drift_graded_random", made_random(graded<2>(hanging_cells)), 1e-8,
                            5000, false);
       }},
      {"drift_graded_random_3d", text + "random in 3D, growing cells, strain 1e-8, 2e3 steps", true,
       [] {
         return undamped<3>("drift_graded_random_3d", made_random(graded<3>(growing_cells)), 1e-8,
                            2000, false);
       }},
      {"drift_graded_schemes", text + "energy-weighted schemes, cells double or grow", true,
       weighted_graded},
      {"drift_long_graded", text + "cells double in the overlap, strain 1e-6, 1e5 steps", true,
       [] {
         return undamped<2>("drift_long_graded", graded<2>(hanging_cells), 1e-6, 100000, false);
       }},
      {"drift_long_growing", text + "growing cells, strain 1e-6, 1e5 steps", true,
       [] {
         return undamped<2>("drift_long_growing", graded<2>(growing_cells), 1e-6, 100000, false);
       }},
      {"drift_ratio", text + "step ratio 4, strain 1e-8, 1e4 steps", true,
       [] { return undamped_ratio("drift_ratio", 4, 1e-8, 10000); }},
      {"drift_long", text + "strain 1e-6, 1e5 steps", true,
       [] { return undamped<2>("drift_long", band_2d(1), 1e-6, 100000, true); }},
      {"drift_long_3d", text + "FCC, strain 1e-6, 1e5 steps", true,
       [] { return undamped<3>("drift_long_3d", band_3d(), 1e-6, 100000, true); }},
      {"drift_long_ratio", text + "step ratio 4, strain 1e-6, 1e5 steps", true,
       [] { return undamped_ratio("drift_long_ratio", 4, 1e-6, 100000); }},
      {"drift_long_random_3d", text + "random, strain 1e-6, 1e5 steps", true,
       [] {
         return undamped<3>("drift_long_random_3d", made_random(band_3d()), 1e-6, 100000, true);
       }},
      {"decay", decay + "hexagonal", false, [] { return damped<2>("decay", band_2d(1)); }},
      {"decay_random", decay + "random", true,
       [] { return damped<2>("decay_random", made_random(band_2d(1))); }},
      {"decay_3d", decay + "FCC", true, [] { return damped<3>("decay_3d", band_3d()); }},
      {"decay_random_3d", decay + "random in 3D", true,
       [] { return damped<3>("decay_random_3d", made_random(band_3d())); }}};
}
} // namespace ligament::program
