#include "src/verification/cases/random_scenes_judge.h"

#include "core/extremes.h"
#include "src/scene/geometry.h"
#include "src/scene/read_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ligament::program
{
namespace
{
constexpr double stated = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Faces of a coupled run that broke in its overlap before the end of the far field's last step.
int overlap_breaks(const RandomScene &scene, const SceneRuns &runs)
{
  const auto input = parse_scene(scene.json.dump(), "scene");
  const auto zone = zone_shape<3>(*input.scene);
  const bool stopped = runs.coupled.record.status == "stopped";
  const double end = runs.coupled.record.simulated_time - (stopped ? 1.5 * runs.far_step : 0);
  const double depth = runs.overlap - 0.5 * runs.coupled.record.spacing;
  return int(std::count_if(runs.coupled.broken.begin(), runs.coupled.broken.end(),
                           [&](const BrokenBond &b) {
                             return b.time <= end && zone.distance(Vector<3>(b.centroid)) < depth;
                           }));
}

/// Whether the first face that breaks in the body of particles lies where the coupled one may
/// break, too.
bool breaks_in_zone(const RandomScene &scene, const SceneRuns &runs)
{
  if (runs.discrete.broken.empty())
    return true;
  const auto input = parse_scene(scene.json.dump(), "scene");
  return zone_shape<3>(*input.scene).distance(Vector<3>(runs.discrete.broken[0].centroid)) >
         runs.overlap;
}

double end_of(const SceneRun &run)
{
  return std::min(run.record.simulated_time, run.onset().value_or(stated));
}

/// Slope of the load over the displacement of the sides, by least squares; a line through 0.
double slope(const SceneRun &run, double from, double to)
{
  const auto time = run.history.column("time", "s"), load = run.history.column("load", "N"),
             way = run.history.column("displacement", "m");
  double xx = 0, xy = 0;
  for (std::size_t k = 0; k < time.size(); ++k)
    if (time[k] >= from && time[k] <= to)
      xx += way[k] * way[k], xy += way[k] * load[k];
  return xy / xx;
}

// The first wave has come and gone by a third of the way.
double stiffness_error(const SceneRun &run, const SceneRun &reference)
{
  const double end = 0.95 * std::min(end_of(run), end_of(reference));
  return slope(run, end / 3, end) / slope(reference, end / 3, end) - 1;
}

/// Distance of the error from the interval between 0 and that of the mesh alone: two models joined
/// are as stiff as one of them, or something between.
double stiffness_beyond_mesh(const SceneRuns &runs)
{
  const double error = stiffness_error(runs.coupled, runs.discrete);
  const double mesh =
      runs.closer.mesh ? stiffness_error(*runs.closer.mesh, *runs.closer.particles) : 0;
  return std::abs(error - std::clamp(error, std::min(0., mesh), std::max(0., mesh)));
}

double peak_error(const SceneRuns &runs)
{
  return std::abs(runs.coupled.record.peak_load.value_or(nan) /
                      runs.discrete.record.peak_load.value_or(nan) -
                  1);
}

/// Gap between the peaks of coupled and discrete runs that differ in the step alone, over the
/// least.
double peak_beyond_scatter(const SceneRuns &runs)
{
  if (runs.closer.coupled_peaks.empty())
    return peak_error(runs);
  const auto [least, most] =
      std::minmax_element(runs.closer.coupled_peaks.begin(), runs.closer.coupled_peaks.end());
  const auto [least_discrete, most_discrete] =
      std::minmax_element(runs.closer.discrete_peaks.begin(), runs.closer.discrete_peaks.end());
  return std::max({0., *least / *most_discrete - 1, *least_discrete / *most - 1});
}

bool peaks_compare(const RandomScene &scene, const SceneRuns &runs)
{
  return runs.refused.empty() && breaks_in_zone(scene, runs) &&
         runs.coupled.record.status == "done" && runs.coupled.onset() && runs.discrete.onset();
}

/// What drives the run at a time: the load of tractions, else the way of the sides.
double drive(const RandomScene &scene, const SceneRun &run, double time)
{
  const auto t = run.history.column("time", "s"), y = scene.control == "traction"
                                                          ? run.history.column("load", "N")
                                                          : run.history.column("displacement", "m");
  const auto after = std::lower_bound(t.begin(), t.end(), time) - t.begin();
  if (after == 0 || after == std::ptrdiff_t(t.size()))
    return nan;
  const double share = (time - t[after - 1]) / (t[after] - t[after - 1]);
  return y[after - 1] + share * (y[after] - y[after - 1]);
}

/// Relative difference of the drives at which the first faces break; 1 where only one run breaks
/// although the other went on for longer; empty where none does.
std::optional<double> onset_error(const RandomScene &scene, const SceneRun &run,
                                  const SceneRun &reference)
{
  const auto a = run.onset(), b = reference.onset();
  if (a && b) // a mirror turns the signs of drives along x
    return std::abs(std::abs(drive(scene, run, *a) / drive(scene, reference, *b)) - 1);
  if (!a && !b)
    return {};
  const double onset = a ? *a : *b, end = (a ? reference : run).record.simulated_time;
  return end > 1.02 * onset ? std::optional(1.) : std::nullopt;
}

/// Largest difference between the histories up to `end`, loads over the largest load, energies over
/// the largest work.
double history_error(const SceneRun &run, const SceneRun &reference, double end)
{
  const auto time = reference.history.column("time", "s");
  const auto other_time = run.history.column("time", "s");
  std::size_t n = 0;
  while (n < time.size() && n < other_time.size() && std::max(time[n], other_time[n]) < end)
    ++n;
  double worst = 0;
  const auto largest = [&](const std::vector<double> &values) {
    double most = 0;
    for (std::size_t k = 0; k < n; ++k)
      keep_largest(most, std::abs(values[k]));
    return most;
  };
  const auto compare = [&](const char *name, const char *unit, const char *scale_name) {
    const auto a = run.history.column(name, unit), b = reference.history.column(name, unit);
    const double scale = largest(reference.history.column(scale_name, unit));
    for (std::size_t k = 0; k < n && scale != 0; ++k)
      // Sideways loads change their sign in the mirror.
      keep_largest(worst, std::abs(std::abs(a[k]) - std::abs(b[k])) / scale);
  };
  compare("load", "N", "load");
  for (const char *energy : {"kinetic_discrete", "potential_discrete", "kinetic_far",
                             "potential_far", "blended", "external_work"})
    compare(energy, "J", "external_work");
  return n > 2 ? worst : nan;
}

/// 1 where the verdict says more than is so, or leaves out what is.
double verdict_error(const SceneRuns &runs, int n_overlap_breaks)
{
  const RunRecord &r = runs.coupled.record;
  const bool calm = r.verdict.find("nothing unstable") != std::string::npos;
  const bool sound = r.status == "done" && r.energy_residual && *r.energy_residual < 1e-2 &&
                     n_overlap_breaks == 0 && runs.coupled.n_warnings == 0;
  const bool says_stop = r.verdict.find("stopped") != std::string::npos;
  return calm != sound || says_stop != (r.status == "stopped");
}

/// K at the peak of the load over K_Ic.
double toughness_ratio(const RandomScene::Toughness &t, const RunRecord &record)
{
  if (!record.peak_stress)
    return nan;
  const double stress = *record.peak_stress - t.drag, a = t.half_length;
  return stress * std::sqrt(M_PI * a / std::cos(M_PI * a / t.width)) / t.toughness;
}

/// Of the packing, and what cracks and ligaments of so few spacings leave open: the tip is known to
/// d/4, and the next terms of the field count for 3.5 % where there are 10 d (theory.md
/// section 1.6).
double toughness_bound(const RandomScene &scene, double spacing)
{
  const double packing = scene.packing == "random" ? 0.1 : 0.05;
  const auto &t = *scene.toughness;
  return packing + 0.125 * spacing / t.half_length +
         0.35 * spacing / std::min(t.half_length, t.width / 2 - t.half_length);
}

/// Collects the figures. Without damping the runs swing, and local damping drags what moves on and
/// makes runs sensitive to rounding: such figures have names of their own.
class Judgement
{
public:
  Judgement(const RandomScene &scene, const SceneRuns &runs) : scene_(scene), runs_(runs)
  {
    suffix_ = scene.damping == "mass"   ? ""
              : scene.damping == "none" ? "_undamped"
                                        : "_local_damping";
  }

  void energies()
  {
    add("residual", runs_.coupled.record.energy_residual.value_or(nan), 1e-4);
    add("residual_discrete", runs_.discrete.record.energy_residual.value_or(nan), 1e-4);
  }

  void coupled_against_discrete()
  {
    const auto &coupled = runs_.coupled, &discrete = runs_.discrete;
    add("stiffness" + suffix_, std::abs(stiffness_error(coupled, discrete)), stated);
    if (suffix_.empty())
      add("stiffness_beyond_mesh", stiffness_beyond_mesh(runs_), stiffness_bound);
    if (!breaks_in_zone(scene_, runs_))
      return;
    if (const auto error = onset_error(scene_, coupled, discrete))
      add("onset" + suffix_, *error, suffix_.empty() ? 0.01 : stated);
    if (!peaks_compare(scene_, runs_))
      return;
    add("peak" + suffix_, peak_error(runs_), stated);
    if (suffix_.empty())
      add("peak_beyond_scatter", peak_beyond_scatter(runs_), peak_bound);
  }

  void mirror_image()
  {
    if (!runs_.has_mirror)
      return;
    const auto &image = runs_.mirror, &coupled = runs_.coupled;
    const double must = scene_.damping == "local" ? stated : 1e-9;
    if (!runs_.is_mirrored)
      return add("mirror" + local(), nan, must);
    const double end = std::min(end_of(coupled), end_of(image));
    add("mirror" + local(), history_error(image, coupled, end), must);
    if (const auto error = onset_error(scene_, image, coupled))
      add("mirror_onset" + local(), *error, must);
  }

  // A face breaks at a whole step.
  void half_step()
  {
    const auto error = onset_error(scene_, runs_.half_step, runs_.coupled);
    if (!error)
      return;
    const double step = runs_.coupled.record.dt / end_of(runs_.coupled);
    add("half_step_onset" + suffix_, std::max(0., *error - step),
        scene_.damping == "mass" ? 1e-3 : stated);
  }

  void toughness()
  {
    const auto &record = runs_.coupled.record;
    if (!scene_.toughness || !runs_.coupled.onset() || record.status != "done")
      return;
    const double ratio = toughness_ratio(*scene_.toughness, record);
    add("toughness" + local(), ratio, stated);
    add("toughness_over_bound" + local(),
        std::abs(ratio - 1) / toughness_bound(scene_, record.spacing),
        local().empty() ? 1 : stated);
  }

  void compression()
  {
    if (!scene_.must_hold)
      return;
    add("broken_in_compression", double(runs_.coupled.broken.size()), 0);
    add("broken_in_compression_discrete", double(runs_.discrete.broken.size()), 0);
    add("stopped_in_compression", runs_.coupled.record.status != "done", 0);
  }

  void what_the_run_says()
  {
    const int n = overlap_breaks(scene_, runs_);
    add("unseen_overlap_breaks", n, 0);
    add("verdict", verdict_error(runs_, n), 0);
  }

  std::vector<SceneFigure> figures;

private:
  void add(const std::string &name, double value, double must)
  {
    figures.push_back({name, value, must});
  }
  std::string local() const { return scene_.damping == "local" ? suffix_ : ""; }

  const RandomScene &scene_;
  const SceneRuns &runs_;
  std::string suffix_;
};
} // namespace

bool stiffness_is_doubtful(const RandomScene &scene, const SceneRuns &runs)
{
  return runs.refused.empty() && scene.damping == "mass" &&
         std::abs(stiffness_error(runs.coupled, runs.discrete)) > stiffness_bound;
}

bool peak_is_doubtful(const RandomScene &scene, const SceneRuns &runs)
{
  return scene.damping == "mass" && peaks_compare(scene, runs) && peak_error(runs) > peak_bound;
}

std::vector<SceneFigure> judge(const RandomScene &scene, const SceneRuns &runs)
{
  if (!runs.refused.empty())
    return {};
  Judgement judgement(scene, runs);
  judgement.energies();
  judgement.coupled_against_discrete();
  judgement.mirror_image();
  judgement.half_step();
  judgement.toughness();
  judgement.compression();
  judgement.what_the_run_says();
  return judgement.figures;
}

std::string remark(const RandomScene &scene, const SceneRuns &runs)
{
  if (!runs.refused.empty())
    return "refused";
  if (runs.coupled.record.status != "done")
    return runs.coupled.record.status;
  if (!breaks_in_zone(scene, runs))
    return "breaks elsewhere";
  if (!scene.must_hold && !runs.coupled.onset())
    return "nothing broke";
  return "";
}
} // namespace ligament::program
