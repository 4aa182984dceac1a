#include "src/launcher/solver_start.h"

#include "core/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>

namespace ligament::program
{
namespace
{
/// Of a program beside this one.
std::string path_of(const std::string &name)
{
  std::error_code failed;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", failed);
  core::require<core::EnvironmentError>(!failed,
                                        "cannot find the own program: " + failed.message());
  return (self.parent_path() / name).string();
}

std::string cannot_start(const std::string &name, const std::string &path, int error)
{
  return fmt::format(
      "cannot start {}: {}; build it (scripts/build.sh {}), or install it into the same folder",
      path, std::strerror(error), name);
}

[[noreturn]] void start(const std::string &name, int argc, char *const *argv)
{
  std::string path = path_of(name);
  std::vector<char *> arguments(argv, argv + argc);
  arguments[0] = path.data();
  arguments.push_back(nullptr);
  execv(path.c_str(), arguments.data());
  throw core::EnvironmentError(cannot_start(name, path, errno));
}

constexpr std::array<const char *, 3> counts_of_ranks = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE",
                                                         "SLURM_STEP_NUM_TASKS"};
} // namespace

std::string solver_path()
{
  const std::string name = "ligament-solver", path = path_of(name);
  if (::access(path.c_str(), X_OK) != 0)
    throw core::EnvironmentError(cannot_start(name, path, errno));
  return path;
}

void start_solver(int argc, char *const *argv)
{
  start("ligament-solver", argc, argv);
}

void start_verification(int argc, char *const *argv)
{
  start("ligament-verify", argc, argv);
}

void refill_standard_input(const std::string &text)
{
  const int memory = memfd_create("scene", 0);
  std::size_t written = 0;
  while (memory >= 0 && written < text.size()) {
    const ssize_t n = write(memory, text.data() + written, text.size() - written);
    if (n <= 0)
      break;
    written += std::size_t(n);
  }
  core::require<core::EnvironmentError>(
      memory >= 0 && written == text.size() && lseek(memory, 0, SEEK_SET) == 0 &&
          dup2(memory, STDIN_FILENO) == STDIN_FILENO,
      fmt::format("cannot hand the scene to the solver: {}", std::strerror(errno)));
}

int launched_ranks()
{
  for (const char *name : counts_of_ranks)
    if (const char *value = std::getenv(name))
      return std::max(1, std::atoi(value));
  return 1;
}

std::string launch_variables()
{
  std::string names;
  for (const char *name : counts_of_ranks)
    names += (names.empty() ? "" : ", ") + std::string(name);
  return names;
}

void require_one_rank(const std::string &command)
{
  const int ranks = launched_ranks();
  core::require(ranks == 1, fmt::format("{} ranks: {} runs in one process; start it without mpirun "
                                        "or srun",
                                        ranks, command));
}
} // namespace ligament::program
