// The program from outside: started with a shell's line, its streams and its end looked at.
#pragma once

#include <nlohmann/json.hpp>

#include <csignal>
#include <cstdio>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

namespace ligament::tests
{
inline std::string file_text(const std::string &path)
{
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

inline nlohmann::json file_json(const std::string &path)
{
  return nlohmann::json::parse(file_text(path), nullptr, false);
}

struct Outcome
{
  int code; // exit code; 128 + the signal that ended it
  std::string output, errors;

  std::string last_line() const
  {
    const std::size_t end = output.find_last_not_of('\n') + 1;
    const std::size_t begin = output.rfind('\n', end == 0 ? 0 : end - 1);
    return output.substr(begin == output.npos ? 0 : begin + 1);
  }
  nlohmann::json json() const { return nlohmann::json::parse(last_line(), nullptr, false); }
};

/// A program that runs on while the test looks at what it does.
class Process
{
public:
  /// `shell` is a line for sh, which is replaced by its last command when that is behind "exec".
  explicit Process(const std::string &shell, const std::string &name = "process")
      : output_(name + ".out"), errors_(name + ".err"), id_(fork())
  {
    if (id_ != 0)
      return;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGXFSZ})
      std::signal(signal, SIG_DFL);
    if (std::freopen(output_.c_str(), "w", stdout) && std::freopen(errors_.c_str(), "w", stderr))
      execl("/bin/sh", "sh", "-c", shell.c_str(), static_cast<char *>(nullptr));
    _exit(127);
  }
  ~Process()
  {
    if (id_ > 0)
      kill(id_, SIGKILL), waitpid(id_, nullptr, 0);
  }
  Process(const Process &) = delete;
  Process &operator=(const Process &) = delete;

  void send(int signal) const { kill(id_, signal); }
  Outcome wait()
  {
    int status = 0;
    waitpid(id_, &status, 0);
    id_ = 0;
    return {WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status), file_text(output_),
            file_text(errors_)};
  }

private:
  std::string output_, errors_;
  pid_t id_;
};

inline Outcome run_shell(const std::string &line)
{
  return Process(line).wait();
}

/// Waits until it holds, for at most half a minute.
inline bool eventually(const std::function<bool()> &holds)
{
  for (int k = 0; k < 3000; ++k) {
    if (holds())
      return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}
} // namespace ligament::tests
