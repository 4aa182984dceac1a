// Motion of all particles at one time, exact to the last bit: what compare takes field errors from.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace ligament::program
{
struct Snapshot
{
  int dimension = 2;
  double time = 0;                     // s
  double spacing = 0;                  // m
  std::vector<std::int64_t> global_id; // one per particle
  // dimension numbers per particle
  std::vector<double> reference;    // m
  std::vector<double> displacement; // m
  std::vector<double> velocity;     // m/s

  std::size_t size() const { return global_id.size(); }
};

/// Runs keep snapshots at exactly the common times 1.02^k seconds, k a whole number, so that runs of the same
/// scene with other meshes, steps or zones have states of the same times. Index k of the last
/// common time up to `time` > 0, in s.
int common_time_index(double time);
/// In s.
double common_time(int index);

/// Binary with a checksum; replaced at once.
void write_snapshot(const std::string &path, const Snapshot &snapshot);
/// InputError when the file is missing, cut short or damaged.
Snapshot read_snapshot(const std::string &path);
} // namespace ligament::program
