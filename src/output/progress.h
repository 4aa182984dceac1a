// The live line of a run: step, time, energies, broken bonds, crack length, steps/s, time to go.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>

namespace ligament::program
{
struct ProgressState
{
  std::int64_t step = 0, n_steps = 0;
  std::int64_t first_step = 0; // of this process
  double time = 0;          // s
  double kinetic = 0;       // J, both models
  double potential = 0;     // J
  double external_work = 0; // J
  double residual = 0;      // J
  std::int64_t broken_bonds = 0;
  double crack_length = 0; // m (3D: m^2)
};

/// The line without its end; `seconds` of wall time have passed since the process's first step.
std::string progress_line(const ProgressState &state, double seconds, int dimension);

/// Rewrites one line on a terminal, else prints one line per interval.
class Progress
{
public:
  /// interval in s of wall time; a terminal is refreshed five times a second. `stream` may be null:
  /// then nothing is printed.
  Progress(std::FILE *stream, int dimension, double interval);

  /// Cheap: ask every step, gather the state only when true.
  bool is_due() const;
  void print(const ProgressState &state);
  /// Prints the last state and ends the line.
  void finish(const ProgressState &state);

private:
  using Clock = std::chrono::steady_clock;
  void put(const ProgressState &state, bool last);

  std::FILE *stream_;
  int dimension_;
  bool terminal_;
  double interval_;
  Clock::time_point start_, next_;
  std::size_t width_ = 0; // of the line on the terminal
};
} // namespace ligament::program
