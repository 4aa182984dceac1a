#include "src/commands/rank_process.h"

#include "core/check.h"
#include "core/interruption.h"
#include "core/mpi_job.h"
#include "core/version.h"
#include "particles/instruction_set.h"
#include "src/launcher/program.h"
#include "src/launcher/solver_start.h"
#include "src/output/open_run.h"

#include <fmt/format.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sys/prctl.h>
#include <unistd.h>

namespace ligament::program
{
namespace
{
// What all ranks find wrong the first one says, and ends the others; one that finds something alone
// waits so long for that before it speaks.
constexpr auto patience = std::chrono::seconds(3);

/// Where what has started the processes isn't of the MPI that they use, each finds itself alone,
/// and would compute the whole body into the same folder.
void require_all(const CommandLine &line, const core::Ranks &ranks)
{
  core::require<core::EnvironmentError>(
      launched_ranks() == ranks.size(),
      fmt::format(
          "started as one of {} ranks, of which Open MPI finds {}: what has started them is "
          "not of Open MPI; use its mpirun or `srun --mpi=pmix`, or, where one process is "
          "meant, unset {}",
          launched_ranks(), ranks.size(), launch_variables()));
  core::require(
      line.ranks == 1 || line.ranks == ranks.size(),
      fmt::format("-n {}, but mpirun or srun has started {} ranks, which is their number; "
                  "leave -n out, or mpirun and srun",
                  line.ranks, ranks.size()));
}

/// Other builds and other vectors give other last digits: what ranks compute of the same particles
/// would come apart.
void require_likeness(const core::Ranks &ranks)
{
  const std::string own = fmt::format("version {}, commit {}, {}", core::version(), core::commit(),
                                      particles::instruction_set());
  const auto all = ranks.gather(std::vector<char>(own.begin(), own.end()));
  for (int r = 1; r < ranks.size(); ++r)
    core::require<core::EnvironmentError>(
        all[r] == all[0],
        fmt::format("ranks are unlike: rank 0 is {}, rank {} is {}: their last digits differ, and "
                    "results would depend on who computes what; start one build on nodes with one "
                    "kind of processor",
                    std::string(all[0].begin(), all[0].end()), r,
                    std::string(all[r].begin(), all[r].end())));
}
} // namespace

RankProcess::RankProcess(core::Ranks ranks) : ranks_(std::move(ranks))
{
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (ranks_.is_first())
    return;
  error_ = ::dup(STDERR_FILENO);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
  ::close(nowhere);
}

RankProcess::~RankProcess()
{
  if (error_ >= 0)
    ::close(error_);
}

void RankProcess::end_all(const std::string &message, int exit_code)
{
  std::fflush(stdout);
  if (ranks_.is_first())
    ranks_.abort("", exit_code);
  std::this_thread::sleep_for(patience);
  if (folder_)
    end_for_another(*folder_, exit_code == int(ExitCode::stopped_by_guard) ? "stopped" : "failed",
                    fmt::format("rank {}: {}", ranks_.rank(), message));
  ::dup2(error_, STDERR_FILENO);
  ranks_.abort(message, exit_code);
}

void require_one_mind(bool accepts, const core::Ranks &ranks)
{
  const bool is_refused = ranks.any(!accepts);
  core::require<core::EnvironmentError>(
      !accepts || !is_refused,
      "another rank cannot read the scene, or what it names, as this one does");
}

int run_rank(int argc, char **argv,
             const std::function<int(const CommandLine &, RankProcess &)> &dispatch)
{
  core::Interruption::block_for_threads(); // MPI starts some
  const core::MpiJob job;
  RankProcess process(job.ranks());
  const core::Ranks &ranks = process.ranks();
  const int code = run_program(
      argc, argv,
      [&](const CommandLine &line, int, char **) {
        require_all(line, ranks);
        require_likeness(ranks);
        return dispatch(line, process);
      },
      [&](const std::string &message, int exit_code) {
        if (!ranks.is_one())
          process.end_all(message, exit_code);
      });
  // mpirun ends all others when one has ended with a code that is not 0.
  ranks.any(false);
  return ranks.is_first() ? code : 0;
}
} // namespace ligament::program
