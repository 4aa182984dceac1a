// Each figure of a drawn scene fails when what it measures is broken, and no other does.
#include "src/verification/cases/random_scenes_judge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

using namespace ligament;
using namespace ligament::program;

namespace
{
constexpr double onset = 0.6, end = 0.9; // s

/// Load of a run of stiffness 2 N/m that is pulled at 1 m/s; row by row through `change`.
Table history(const std::function<void(int row, double &load)> &change = {})
{
  const std::string path = (std::filesystem::temp_directory_path() / "history.csv").string();
  std::ofstream file(path);
  file << "time,load,displacement,kinetic_discrete,potential_discrete,kinetic_far,potential_far,"
          "blended,external_work\ns,N,m,J,J,J,J,J,J\n";
  file.precision(17);
  for (int row = 0; row <= 90; ++row) {
    const double t = row / 100.;
    double load = 2 * t;
    if (change)
      change(row, load);
    file << t << ',' << load << ',' << t << ",0," << t * t << ",0,0,0," << t * t << '\n';
  }
  file.close();
  return read_csv(path);
}

BrokenBond face(double time, double x, double y)
{
  return {1, 2, time, {x, y, 0}, {0, 1, 0}, 1, 0};
}

RandomScene drawn(const std::function<bool(const RandomScene &)> &fits)
{
  for (int seed = 1;; ++seed)
    if (const auto scene = draw_scene(seed); fits(scene))
      return scene;
}

/// Runs without fault.
struct Sound
{
  RandomScene scene;
  SceneRuns runs;

  explicit Sound(bool must_hold = false)
      : scene(drawn([&](const RandomScene &s) {
          return s.dimension == 2 && s.zone == "band" && s.damping == "mass" &&
                 s.must_hold == must_hold && (must_hold || s.toughness) &&
                 s.json["discrete_zone"]["region"]["lower"][0].is_null();
        }))
  {
    SceneRun run;
    run.record.status = "done";
    run.record.verdict = "energy residual 1e-06; nothing unstable";
    run.record.energy_residual = 1e-6;
    run.record.peak_load = 1.2;
    run.record.simulated_time = end;
    run.record.dt = 1e-4;
    run.record.spacing = scene.json["discrete_zone"]["spacing"];
    run.history = history();
    if (!must_hold) {
      const auto &t = *scene.toughness;
      run.record.peak_stress =
          t.drag +
          t.toughness / std::sqrt(M_PI * t.half_length / std::cos(M_PI * t.half_length / t.width));
      const auto &tip = scene.json["specimen"]["cracks"][0]["points"][1];
      run.broken = {face(onset, tip[0], tip[1])};
    }
    runs.coupled = runs.discrete = runs.mirror = runs.half_step = run;
    runs.overlap = scene.json["coupling"]["overlap_cells"].get<double>() *
                   scene.json["far_field"]["cell_size"].get<double>();
    runs.far_step = 1e-4;
  }

  std::set<std::string> failing() const
  {
    std::set<std::string> names;
    for (const auto &f : judge(scene, runs))
      if (!f.holds())
        names.insert(f.name);
    return names;
  }
};

using Names = std::set<std::string>;

TEST(Judgement, SoundRunsHold)
{
  EXPECT_EQ(Sound().failing(), Names());
  EXPECT_GE(judge(Sound().scene, Sound().runs).size(), 11u);
  EXPECT_EQ(Sound(true).failing(), Names());
  EXPECT_EQ(remark(Sound().scene, Sound().runs), "");
}

TEST(Judgement, Energies)
{
  Sound s;
  s.runs.coupled.record.energy_residual = 1.1e-4;
  EXPECT_EQ(s.failing(), Names{"residual"});
  s = Sound();
  s.runs.discrete.record.energy_residual = std::nan("");
  EXPECT_EQ(s.failing(), Names{"residual_discrete"});
}

TEST(Judgement, CoupledAgainstDiscrete)
{
  Sound s;
  s.runs.discrete.history = history([](int, double &load) { load *= 1.004; });
  EXPECT_EQ(s.failing(), Names{"stiffness_beyond_mesh"});
  s = Sound();
  s.runs.discrete.history = history([](int, double &load) { load += 0.01; });
  EXPECT_EQ(s.failing(), Names{"stiffness_beyond_mesh"});
  s = Sound();
  s.runs.discrete.broken[0].time = 1.02 * onset;
  EXPECT_EQ(s.failing(), Names{"onset"});
  s = Sound();
  s.runs.discrete.broken.clear(); // although it went on
  EXPECT_EQ(s.failing(), Names{"onset"});
  s = Sound();
  s.runs.discrete.record.peak_load = 1.22;
  EXPECT_EQ(s.failing(), Names{"peak_beyond_scatter"});
  s.scene.damping = "local";
  EXPECT_EQ(s.failing(), Names());
}

// A coupled body may be as stiff as its mesh alone, not more, nor off to the other side.
TEST(Judgement, ACloserLookAtTheStiffness)
{
  const auto times = [](double factor) {
    return history([=](int, double &load) { load *= factor; });
  };
  Sound s;
  s.runs.has_mirror = false;
  const SceneRun sound = s.runs.coupled;
  s.runs.coupled.history = times(1.01);
  EXPECT_TRUE(stiffness_is_doubtful(s.scene, s.runs));
  s.runs.closer.mesh = s.runs.closer.particles = sound;
  EXPECT_EQ(s.failing(), Names{"stiffness_beyond_mesh"});
  s.runs.closer.mesh->history = times(1.008);
  EXPECT_EQ(s.failing(), Names());
  s.runs.closer.mesh->history = times(1.02);
  EXPECT_EQ(s.failing(), Names());
  s.runs.closer.mesh->history = times(0.98);
  EXPECT_EQ(s.failing(), Names{"stiffness_beyond_mesh"});
  s.runs.coupled.history = times(1.002);
  EXPECT_FALSE(stiffness_is_doubtful(s.scene, s.runs));
}

TEST(Judgement, ACloserLookAtThePeak)
{
  Sound s;
  s.runs.discrete.record.peak_load = 1.3;
  EXPECT_TRUE(peak_is_doubtful(s.scene, s.runs));
  s.runs.closer.coupled_peaks = {1.2, 1.22, 1.24};
  s.runs.closer.discrete_peaks = {1.3, 1.26, 1.35};
  EXPECT_EQ(s.failing(), Names{"peak_beyond_scatter"}); // 1.26 / 1.24 - 1
  s.runs.closer.discrete_peaks.push_back(1.25);
  EXPECT_EQ(s.failing(), Names());
  s.runs.discrete.record.peak_load = 1.21;
  EXPECT_FALSE(peak_is_doubtful(s.scene, s.runs));
}

TEST(Judgement, FarFieldsDontBreak)
{
  Sound s;
  s.runs.discrete.broken = {
      face(0.5 * onset, 0, s.scene.json["specimen"]["size"][1].get<double>() / 2)};
  EXPECT_EQ(s.failing(), Names());
  EXPECT_EQ(remark(s.scene, s.runs), "breaks elsewhere");
}

TEST(Judgement, MirrorImages)
{
  Sound s;
  s.runs.mirror.history = history([](int row, double &load) { load *= row == 50 ? 1 + 1e-8 : 1; });
  EXPECT_EQ(s.failing(), Names{"mirror"});
  s = Sound();
  s.runs.mirror.history = history([](int, double &load) { load = -load; });
  EXPECT_EQ(s.failing(), Names());
  s.runs.mirror.history = history([](int row, double &load) { load *= row == 70 ? 2 : 1; });
  EXPECT_EQ(s.failing(), Names()) << "after the first break";
  s.runs.mirror.broken[0].time = onset + 1e-4;
  EXPECT_EQ(s.failing(), Names{"mirror_onset"});
  s.runs.is_mirrored = false;
  EXPECT_EQ(s.failing(), Names{"mirror"});
}

TEST(Judgement, HalfTheStep)
{
  Sound s;
  s.runs.half_step.broken[0].time = 1.002 * onset;
  EXPECT_EQ(s.failing(), Names{"half_step_onset"});
  s.scene.damping = "none";
  EXPECT_EQ(s.failing(), Names());
}

TEST(Judgement, Toughness)
{
  Sound s;
  *s.runs.coupled.record.peak_stress *= 1.25;
  EXPECT_EQ(s.failing(), Names{"toughness_over_bound"});
}

TEST(Judgement, NothingBreaksUnderCompression)
{
  Sound s(true);
  s.runs.discrete.broken = {face(onset, 0, 0)};
  s.runs.coupled.broken = s.runs.mirror.broken = s.runs.half_step.broken = s.runs.discrete.broken;
  EXPECT_EQ(s.failing(), (Names{"broken_in_compression", "broken_in_compression_discrete"}));
  s = Sound(true);
  s.runs.coupled.record.status = "stopped";
  s.runs.coupled.record.verdict = "stopped: tension in the overlap";
  EXPECT_EQ(s.failing(), Names{"stopped_in_compression"});
}

TEST(Judgement, BreaksInTheOverlapAreSeen)
{
  Sound s;
  const double edge = s.scene.json["discrete_zone"]["region"]["upper"][1];
  s.runs.coupled.broken.push_back(face(0.7, 0, edge - 0.5 * s.runs.overlap));
  EXPECT_EQ(s.failing(), (Names{"unseen_overlap_breaks", "verdict"}));
  auto &record = s.runs.coupled.record;
  record.status = "stopped";
  record.verdict = "stopped: tension in the overlap";
  EXPECT_EQ(s.failing(), Names{"unseen_overlap_breaks"});
  record.simulated_time = 0.7; // in the very step
  EXPECT_EQ(s.failing(), Names());
}

TEST(Judgement, TheVerdictSaysWhatIsSo)
{
  Sound s;
  s.runs.coupled.n_warnings = 1;
  EXPECT_EQ(s.failing(), Names{"verdict"});
  s = Sound();
  s.runs.coupled.record.verdict = "energy residual 1e-06";
  EXPECT_EQ(s.failing(), Names{"verdict"});
}
} // namespace
