// Checks that are always on: wrong input leaves with a reason and a remedy, a guard stops a run.
#pragma once

#include <stdexcept>
#include <string>

namespace ligament::core
{
/// The scene or the command line is wrong: exit code 2.
struct InputError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// The run left the range in which its result can be trusted: exit code 3.
struct GuardStop : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// Disk, memory, MPI or files of the machine: exit code 4.
struct EnvironmentError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// Always on; throws Error with the message when the condition does not hold.
template <typename Error = InputError>
void require(bool condition, const std::string &message)
{
  if (!condition)
    throw Error(message);
}
} // namespace ligament::core
