// The solver as one of several ranks: the first one talks, and none is left waiting for another.
#pragma once

#include "core/ranks.h"
#include "src/launcher/command_line.h"

#include <functional>

namespace ligament::program
{
/// One rank of a job.
class RankProcess
{
public:
  /// Silences standard output and error of all ranks but the first. A rank whose mpirun is killed
  /// ends, too.
  explicit RankProcess(core::Ranks ranks);
  ~RankProcess();

  const core::Ranks &ranks() const { return ranks_; }

  /// Ends all ranks for what this one has found. What all of them find the first one has said
  /// already; one that finds something alone says it.
  [[noreturn]] void end_all(const std::string &message, int exit_code);

private:
  core::Ranks ranks_;
  int error_ = -1; // standard error, where it is silenced
};

/// The main function of a rank, which all have: calls `dispatch`. What that throws on a rank ends
/// all of them, with its message and exit code.
int run_rank(int argc, char **argv,
             const std::function<int(const CommandLine &, RankProcess &)> &dispatch);
} // namespace ligament::program
