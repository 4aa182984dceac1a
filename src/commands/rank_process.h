// The solver as one of several ranks: the first one talks, and none is left waiting for another.
#pragma once

#include "core/ranks.h"
#include "src/launcher/command_line.h"

#include "src/output/run_folder.h"

#include <functional>
#include <optional>

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

  /// Where the run's record is: a later rank that ends it says so there.
  void is_of(const RunFolder &folder) { folder_ = folder; }

  /// Ends all ranks for what this one has found. What all of them find the first one has said
  /// already; one that finds something alone says it, in the record of the run, too.
  [[noreturn]] void end_all(const std::string &message, int exit_code);

private:
  core::Ranks ranks_;
  std::optional<RunFolder> folder_;
  int error_ = -1; // standard error, where it is silenced
};

/// Scenes lie in files that all ranks read. Throws core::EnvironmentError on ranks that accept one
/// where another rank doesn't.
void require_one_mind(bool accepts, const core::Ranks &ranks);

/// The main function of a rank, which all have: calls `dispatch` where all ranks are there that
/// were started, of one build and on one kind of processor. What is thrown on a rank ends all of
/// them, with its message and exit code.
int run_rank(int argc, char **argv,
             const std::function<int(const CommandLine &, RankProcess &)> &dispatch);
} // namespace ligament::program
