#include "core/timers.h"

#include <fmt/core.h>

#include <algorithm>

namespace ligament::core
{
namespace
{
double seconds(Timers::Clock::duration d)
{
  return std::chrono::duration<double>(d).count();
}
} // namespace

Timers::Timers() : rows_{{"rest", 0, 0}}, start_(Clock::now()), last_(start_)
{
}

int Timers::section(const std::string &name)
{
  for (std::size_t i = 1; i < rows_.size(); ++i)
    if (rows_[i].name == name)
      return int(i);
  rows_.push_back({name, 0, 0});
  return int(rows_.size()) - 1;
}

void Timers::charge()
{
  const auto now = Clock::now();
  rows_[running_].seconds += seconds(now - last_);
  last_ = now;
}

int Timers::switch_to(int section)
{
  charge();
  const int outer = running_;
  running_ = section;
  return outer;
}

Timers::Scope::Scope(Timers &timers, int section)
    : timers_(timers), outer_(timers.switch_to(section))
{
  ++timers_.rows_[section].calls;
}

Timers::Scope::~Scope()
{
  timers_.switch_to(outer_);
}

void Timers::add(const std::vector<Row> &rows)
{
  for (const Row &row : rows) {
    Row &mine = rows_[row.name == rows_[0].name ? 0 : section(row.name)];
    mine.seconds += row.seconds;
    mine.calls += row.calls;
    start_ -=
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(row.seconds));
  }
}

std::vector<Timers::Row> Timers::rows() const
{
  std::vector<Row> rows(rows_.begin() + 1, rows_.end());
  rows.push_back(rows_[0]);
  const double running = seconds(Clock::now() - last_);
  (running_ == 0 ? rows.back() : rows[running_ - 1]).seconds += running;
  return rows;
}

double Timers::total() const
{
  return seconds(Clock::now() - start_);
}

std::string timing_table(const std::vector<Timers::Row> &rows)
{
  std::size_t width = 7;
  double total = 0;
  for (const auto &row : rows) {
    width = std::max(width, row.name.size());
    total += row.seconds;
  }
  std::string text = fmt::format("{:<{}} {:>10} {:>7} {:>11} {:>12}\n", "section", width, "seconds",
                                 "share", "calls", "us per call");
  for (const auto &row : rows)
    text += fmt::format("{:<{}} {:>10.3f} {:>5.1f} % {:>11} {:>12}\n", row.name, width, row.seconds,
                        total > 0 ? 100 * row.seconds / total : 0., row.calls,
                        row.calls > 0 ? fmt::format("{:.2f}", 1e6 * row.seconds / row.calls) : "-");
  return text + fmt::format("{:<{}} {:>10.3f}\n", "total", width, total);
}
} // namespace ligament::core
