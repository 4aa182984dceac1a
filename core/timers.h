// Wall time by named section, cheap enough for the time loop: one clock read per change of section.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace ligament::core
{
/// Times are exclusive: while an inner section runs, the outer one stands still, so that the rows
/// add up to the total. Not for several threads.
class Timers
{
public:
  using Clock = std::chrono::steady_clock;

  struct Row
  {
    std::string name;
    double seconds;
    std::int64_t calls;
  };

  /// Runs a section until the end of the block.
  class [[nodiscard]] Scope
  {
  public:
    Scope(Timers &timers, int section);
    ~Scope();
    Scope(const Scope &) = delete;
    Scope &operator=(const Scope &) = delete;

  private:
    Timers &timers_;
    int outer_;
  };

  Timers();

  /// Number of the section of this name, made when it does not exist yet.
  int section(const std::string &name);
  /// `const auto timing = timers.scope(forces);`
  Scope scope(int section) { return Scope(*this, section); }

  /// For a run that goes on: as if these had passed here, too.
  void add(const std::vector<Row> &rows);

  /// All sections in the order in which they were made; time outside of all of them is the last
  /// row, "rest". The section that runs counts up to now.
  std::vector<Row> rows() const;
  /// Seconds since the timers were made, equal to the sum over rows().
  double total() const;

private:
  void charge();
  int switch_to(int section);

  std::vector<Row> rows_; // rows_[0] is the rest
  int running_ = 0;
  Clock::time_point start_, last_;
};

/// Name, seconds, share, calls and time per call, one line per row.
std::string timing_table(const std::vector<Timers::Row> &rows);
} // namespace ligament::core
