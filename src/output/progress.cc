#include "src/output/progress.h"

#include "core/tell.h"
#include "src/output/format.h"

#include <fmt/core.h>

#include <unistd.h>

namespace ligament::program
{
std::string progress_line(const ProgressState &s, double seconds, int dimension)
{
  const double rate = seconds > 0 ? double(s.step - s.first_step) / seconds : 0;
  const double share = s.n_steps > 0 ? 100. * double(s.step) / double(s.n_steps) : 100;
  std::string line = fmt::format(
      "{:3.0f} %  step {}/{}  t {}  Ekin {}  Epot {}  work {}  resid {}  broken {}  "
      "crack {}  {:.0f} steps/s",
      share, s.step, s.n_steps, quantity(s.time, "s"), quantity(s.kinetic, "J"),
      quantity(s.potential, "J"), quantity(s.external_work, "J"), quantity(s.residual, "J"),
      s.broken_bonds, quantity(s.crack_length, dimension == 2 ? "m" : "m^2"), rate);
  if (rate > 0)
    line += "  ETA " + duration(double(s.n_steps - s.step) / rate);
  return line;
}

Progress::Progress(std::FILE *stream, int dimension, double interval)
    : stream_(stream), dimension_(dimension), terminal_(stream && isatty(fileno(stream))),
      interval_(terminal_ ? 0.2 : interval), start_(Clock::now()), next_(start_)
{
}

bool Progress::is_due() const
{
  return stream_ && Clock::now() >= next_;
}

void Progress::print(const ProgressState &state)
{
  put(state, false);
}

void Progress::finish(const ProgressState &state)
{
  put(state, true);
}

void Progress::put(const ProgressState &state, bool last)
{
  if (!stream_)
    return;
  const auto now = Clock::now();
  const std::string line =
      progress_line(state, std::chrono::duration<double>(now - start_).count(), dimension_);
  if (terminal_)
    // Padded to cover what is left of a longer line.
    core::tell(stream_, fmt::format("\r{:<{}}{}", line, width_, last ? "\n" : ""));
  else
    core::tell(stream_, line + "\n");
  width_ = line.size();
  next_ =
      now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(interval_));
}
} // namespace ligament::program
