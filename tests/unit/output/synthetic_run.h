// A small output folder with known figures, for tests of report and compare.
#pragma once

#include "core/files.h"
#include "src/output/broken_bonds.h"
#include "src/output/history.h"
#include "src/output/run_folder.h"
#include "src/output/run_record.h"
#include "src/output/snapshot.h"

#include <cmath>
#include <filesystem>

namespace ligament::tests
{
/// A straight load line up to the peak, then nothing; a crack along y = crack_y that takes over
/// shortly before the grips see the peak.
struct SyntheticRun
{
  double stiffness = 70e9;  // Pa
  double peak_stress = 1e6; // Pa
  double area = 0.1;        // m^2
  double length = 0.2;      // m
  double peak_time = 1e-4;  // s
  double spacing = 1e-3;    // m
  double crack_y = 0;       // m
  double onset = 0.95;      // of the peak's time: the stored energy falls from then on
  int n_broken_before = 3, n_broken_after = 4;
  double displacement_factor = 1;
  std::vector<double> snapshot_times = {0.9e-4}; // s, the latest first, at most three
  std::int64_t first_id = 0;
  double wall_seconds = 10;
  std::int64_t particles = 1000;
  std::string status = "done";
  std::optional<double> trusted_until; // s
  double noise = 0;                    // of the load, as a share of the peak, with 7 periods

  double peak_load() const { return peak_stress * area; }
  double peak_strain() const { return peak_stress / stiffness; }
  double work() const { return 0.5 * peak_load() * peak_strain() * length; }

  /// Elastic energy in J at a share of the peak's time.
  double stored(double share) const
  {
    return work() * (share <= onset ? share * share : 2 * onset * onset - share * share);
  }

  program::RunFolder write(const std::string &path) const
  {
    using namespace program;
    std::filesystem::remove_all(path);
    const RunFolder folder{path};
    folder.create();

    RunRecord record;
    record.title = "Synthetic <run>";
    record.version = "1.2.3";
    record.status = status;
    record.reason = "why it ended";
    record.trusted_until = trusted_until;
    record.kind = "coupled";
    record.plane = "strain";
    record.spacing = spacing;
    record.size = {area, length};
    record.particles = particles;
    record.wall_seconds = wall_seconds;
    record.largest_load = peak_load();
    record.largest_stress = peak_stress;
    record.largest_time = peak_time;
    if (n_broken_before + n_broken_after > 0) {
      record.peak_load = record.largest_load;
      record.peak_stress = record.largest_stress;
      record.peak_time = record.largest_time;
    }
    write_run_record(folder.record(), record);

    HistoryWriter history(folder.history(), history_columns(2));
    const int n = 100;
    for (int i = 0; i <= n + 10; ++i) {
      const double s = double(i) / n, load = i <= n ? s : 0;
      history.set("time", s * peak_time);
      history.set("stress", load * peak_stress);
      history.set("load", (load + noise * std::sin(14 * M_PI * s)) * peak_load());
      history.set("strain", s * peak_strain());
      history.set("displacement", s * peak_strain() * length);
      history.set("external_work", std::min(s * s, 1.) * work());
      history.set("potential_discrete", 0.6 * stored(s));
      history.set("potential_far", 0.5 * stored(s));
      history.set("blended", -0.1 * stored(s));
      history.set("kinetic_discrete", 1e-3 * stored(s));
      history.set("kinetic_far", 1e-3 * stored(s));
      history.set("residual", 1e-6 * s * work());
      history.end_row();
    }
    history.flush();

    std::vector<BrokenBond> bonds;
    for (int b = 0; b < n_broken_before + n_broken_after; ++b)
      bonds.push_back({b,
                       b + 1,
                       peak_time * (b < n_broken_before ? onset - 0.01 : onset + 0.01),
                       {b * spacing, crack_y, 0},
                       {0, 1, 0},
                       0.5 * spacing,
                       1e-6});
    write_broken_bonds(folder.broken_bonds(), bonds, 2);

    Snapshot snapshot;
    snapshot.spacing = spacing;
    for (int i = 0; i < 10; ++i) {
      snapshot.global_id.push_back(first_id + i);
      const double x = i * spacing;
      snapshot.reference.insert(snapshot.reference.end(), {x, -x});
      snapshot.displacement.insert(snapshot.displacement.end(),
                                   {displacement_factor * 1e-6 * (i + 1), 0});
      snapshot.velocity.insert(snapshot.velocity.end(), {0, 0.1 * i});
    }
    for (std::size_t i = 0; i < snapshot_times.size(); ++i) {
      snapshot.time = snapshot_times[i];
      write_snapshot(folder.snapshots()[i], snapshot);
    }
    return folder;
  }
};
} // namespace ligament::tests
