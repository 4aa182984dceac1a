#include "src/sweep/child_processes.h"

#include "core/check.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace ligament::program
{
namespace
{
double now()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double seconds(const timeval &t)
{
  return double(t.tv_sec) + 1e-6 * double(t.tv_usec);
}

int open_for_writing(const std::string &path)
{
  const int descriptor = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  core::require<core::EnvironmentError>(descriptor >= 0,
                                        "cannot write " + path + ": " + std::strerror(errno));
  return descriptor;
}
} // namespace

pid_t ChildProcesses::start(const std::vector<std::string> &command, const std::string &output,
                            const std::string &errors)
{
  std::vector<char *> arguments;
  for (const std::string &word : command)
    arguments.push_back(const_cast<char *>(word.c_str()));
  arguments.push_back(nullptr);
  const int out = open_for_writing(output), err = open_for_writing(errors);
  const pid_t parent = getpid();
  const pid_t id = fork();
  if (id == 0) {
    // Only calls that are safe between fork and exec.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() == parent && dup2(out, STDOUT_FILENO) >= 0 && dup2(err, STDERR_FILENO) >= 0)
      execv(arguments[0], arguments.data());
    _exit(127);
  }
  close(out);
  close(err);
  core::require<core::EnvironmentError>(id > 0, "cannot start a process: " +
                                                    std::string(std::strerror(errno)));
  started_.push_back({id, now()});
  return id;
}

ChildEnd ChildProcesses::wait()
{
  int status = 0;
  rusage usage{};
  pid_t id = -1;
  do
    id = wait4(-1, &status, 0, &usage);
  while (id < 0 && errno == EINTR);
  const auto found =
      std::find_if(started_.begin(), started_.end(), [&](const Started &s) { return s.id == id; });
  core::require<core::EnvironmentError>(found != started_.end(), "lost track of a process");
  const ChildEnd end = {id, WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status),
                        now() - found->time, seconds(usage.ru_utime) + seconds(usage.ru_stime),
                        1024. * double(usage.ru_maxrss)};
  started_.erase(found);
  return end;
}
} // namespace ligament::program
