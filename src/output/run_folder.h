// Where things lie in the output folder of a run: writers and readers take the names from here.
#pragma once

#include <array>
#include <string>

namespace ligament::program
{
/// With the folders above it; one that is there stays. EnvironmentError when the disk refuses.
void make_folder(const std::string &path);

struct RunFolder
{
  std::string path;

  std::string record() const { return path + "/run.json"; }
  std::string resolved_scene() const { return path + "/scene.resolved.json"; }
  /// Particles of an irregular packing, as /discrete_zone/packing_file reads them.
  std::string packing() const { return path + "/packing.csv"; }
  std::string log() const { return path + "/run.log"; }
  std::string history() const { return path + "/history.csv"; }
  std::string broken_bonds() const { return path + "/broken_bonds.csv"; }
  /// Faces that initial cracks cut, in the same columns; only of runs with a crack.
  std::string cut_faces() const { return path + "/cut_faces.csv"; }
  /// Pieces of the body at the end; only of runs with a gauge that counts them.
  std::string fragments() const { return path + "/fragments.csv"; }
  /// Motion of the particles at the last common times (see common_time_index) before fracture took
  /// over, the latest first.
  std::array<std::string, 3> snapshots() const
  {
    return {path + "/snapshot_0.bin", path + "/snapshot_1.bin", path + "/snapshot_2.bin"};
  }
  std::string pvd() const { return path + "/fields.pvd"; }
  std::string fields() const { return path + "/fields"; }
  std::string pictures() const { return path + "/pictures"; }
  std::string checkpoints() const { return path + "/checkpoints"; }
  std::string report() const { return path + "/report.html"; }

  /// Makes the folder with its subfolders; EnvironmentError when the disk refuses.
  void create() const;
  /// True when a run wrote its record here.
  bool holds_a_run() const;
  /// The name of something that no run wrote here; empty in a folder of a run, or where one that
  /// was killed at once may have been.
  std::string foreign_entry() const;
};
} // namespace ligament::program
