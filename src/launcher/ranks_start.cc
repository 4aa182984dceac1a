#include "src/launcher/ranks_start.h"

#include "core/check.h"
#include "core/interruption.h"
#include "core/tell.h"
#include "src/launcher/program.h"
#include "src/launcher/solver_start.h"
#include "src/output/open_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace ligament::program
{
namespace
{
/// mpirun's command line.
std::vector<std::string> mpirun_words(int ranks, int argc, char *const *argv)
{
  std::vector<std::string> words = {"mpirun",          "--quiet",   "-n",  std::to_string(ranks),
                                    "--oversubscribe", "--bind-to", "none"};
  words.push_back(solver_path());
  words.insert(words.end(), argv + 1, argv + argc);
  return words;
}

/// Those that this process doesn't ignore, and the end of a child.
sigset_t awaited_signals()
{
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGCHLD);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) {
    struct sigaction action;
    if (::sigaction(signal, nullptr, &action) == 0 && action.sa_handler != SIG_IGN)
      sigaddset(&set, signal);
  }
  return set;
}

/// In the child. A failure is written to the pipe, which otherwise closes.
[[noreturn]] void become_mpirun(std::vector<std::string> words, const sigset_t &mask, pid_t parent,
                                int failure)
{
  ::setpgid(0, 0); // a terminal's signals reach the parent alone
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent)
    ::_exit(int(SIGTERM));
  pthread_sigmask(SIG_SETMASK, &mask, nullptr);
  // mpirun would read what is meant for the next command of a script.
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ::dup2(nothing, STDIN_FILENO);
  if (::geteuid() == 0) {
    ::setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    ::setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  }
  std::vector<char *> arguments;
  for (std::string &word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execvp(arguments[0], arguments.data());
  const int error = errno;
  [[maybe_unused]] const auto written = ::write(failure, &error, sizeof(error));
  ::_exit(127);
}

/// Waits for the child's end, and hands on what asks for it; returns the last signal, 0: none.
int wait_for(pid_t child, const sigset_t &signals, int &status)
{
  using Clock = std::chrono::steady_clock;
  int asked_by = 0;
  Clock::time_point asked_at;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    const int signal = ::sigwaitinfo(&signals, nullptr);
    if (signal <= 0 || signal == SIGCHLD)
      continue;
    if (asked_by != 0 && Clock::now() - asked_at < core::Interruption::one_wish)
      continue;
    ::kill(child, asked_by == 0 ? SIGUSR1 : SIGTERM);
    asked_by = signal;
    asked_at = Clock::now();
  }
  return asked_by;
}

/// Codes with which ranks end that have said why (docs/manual/exit_codes.md): any of them may have
/// been asked to end by a signal.
bool is_told(int code)
{
  constexpr int out_of_time = 124;
  return code == int(ExitCode::done) || code == int(ExitCode::wrong_input) ||
         code == int(ExitCode::stopped_by_guard) || code == int(ExitCode::bad_environment) ||
         code == out_of_time || code == 128 + SIGHUP || code == 128 + SIGINT ||
         code == 128 + SIGUSR1 || code == 128 + SIGTERM;
}

bool has_checkpoint(const std::string &folder)
{
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::directory_iterator entries(RunFolder{folder}.checkpoints(), error);
  return !error && std::any_of(fs::begin(entries), fs::end(entries), [](const auto &entry) {
    return entry.path().filename().string().rfind("checkpoint_", 0) == 0;
  });
}

/// mpirun, which is quiet, keeps most of what it knows to itself.
std::string why_killed(const std::string &folder, int signal, bool is_mpirun)
{
  const std::string rest =
      has_checkpoint(folder)
          ? fmt::format("what was computed up to the newest checkpoint is on the disk: `ligament "
                        "resume {}` goes on from it",
                        folder)
          : "there was no checkpoint yet: run the scene again";
  return fmt::format("{} was ended by signal {} ({}), and the ranks with it{}; {}",
                     is_mpirun ? "mpirun" : "a rank", signal, ::strsignal(signal),
                     signal == SIGKILL ? ": the system does that where memory is short, and "
                                         "`ligament check -n` predicts what each rank needs"
                                       : "",
                     rest);
}
} // namespace

int run_on_ranks(const CommandLine &line, int argc, char *const *argv)
{
  const char *outer = "OMPI_COMM_WORLD_SIZE"; // mpirun doesn't start within another one
  core::require(std::getenv(outer) == nullptr,
                fmt::format("-n {} within mpirun ({} is set): mpirun does not start another one; "
                            "leave -n out and give mpirun the number, or start without mpirun",
                            line.ranks, outer));
  const auto words = mpirun_words(line.ranks, argc, argv);
  ::signal(SIGCHLD, SIG_DFL); // where it is ignored, nobody says when a child ends
  const sigset_t signals = awaited_signals();
  sigset_t before;
  pthread_sigmask(SIG_BLOCK, &signals, &before);
  int failure[2];
  core::require<core::EnvironmentError>(
      ::pipe2(failure, O_CLOEXEC) == 0,
      fmt::format("cannot start ranks: {}", std::strerror(errno)));
  const pid_t parent = ::getpid(), child = ::fork();
  if (child == 0)
    become_mpirun(words, before, parent, failure[1]);
  ::close(failure[1]);
  int error = child < 0 ? errno : 0, status = 0;
  if (child > 0 && ::read(failure[0], &error, sizeof(error)) < 0)
    error = 0;
  ::close(failure[0]);
  const int asked_by = child > 0 ? wait_for(child, signals, status) : 0;
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  core::require<core::EnvironmentError>(
      error == 0, fmt::format("cannot start mpirun: {}; install Open MPI's programs (Debian: "
                              "openmpi-bin), or leave -n out",
                              std::strerror(error)));
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  if (asked_by != 0) // mpirun that was told twice ends with a code of its own
    return code > 128 || !is_told(code) ? 128 + asked_by : code;
  if (is_told(code))
    return code;
  core::require<core::EnvironmentError>(
      code > 128,
      fmt::format("mpirun ended with code {}, with which no rank ends: it could not start them, or "
                  "could not pass messages between them; `mpirun -n {} true` says more: see that "
                  "TMPDIR, or /tmp, can be written and has room; or leave -n out",
                  code, line.ranks));
  const std::string folder = line.command == "resume" ? line.run : output_folder(line);
  const std::string why = why_killed(folder, code - 128, WIFSIGNALED(status));
  end_for_another({folder}, "failed", why);
  core::tell(stderr, fmt::format("error: {}\n", why));
  if (line.json)
    fmt::print("{}\n", error_json("failed", why));
  return code;
}
} // namespace ligament::program
