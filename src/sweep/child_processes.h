// Programs that run beside this one: started with their output in files, waited for one by one.
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace ligament::program
{
struct ChildEnd
{
  pid_t id;
  int code;            // exit code; 128 + the signal that ended it
  double seconds;      // from start to end
  double core_seconds; // of all its threads
  double peak_memory;  // bytes, largest resident set
};

/// Children end with this process, even when that is killed.
class ChildProcesses
{
public:
  /// Standard output and standard error go to the two files. EnvironmentError when the program
  /// cannot be started.
  pid_t start(const std::vector<std::string> &command, const std::string &output,
              const std::string &errors);
  /// The next one that ends.
  ChildEnd wait();
  std::size_t n_running() const { return started_.size(); }

private:
  struct Started
  {
    pid_t id;
    double time;
  };
  std::vector<Started> started_;
};
} // namespace ligament::program
