#include "core/input_file.h"

#include "core/check.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace ligament::core
{
bool is_named_file(const std::string &path)
{
  struct stat status;
  return path != "-" &&
         (::stat(path.c_str(), &status) != 0 || S_ISREG(status.st_mode) || S_ISDIR(status.st_mode));
}

std::string read_input(const std::string &path)
{
  const bool standard = path == "-";
  const int descriptor = standard ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  std::string text;
  char block[1 << 16];
  ssize_t n = descriptor < 0 ? -1 : 0;
  if (descriptor >= 0)
    while ((n = ::read(descriptor, block, sizeof(block))) > 0 || (n < 0 && errno == EINTR))
      if (n > 0)
        text.append(block, n);
  const int error = errno;
  if (!standard && descriptor >= 0)
    ::close(descriptor);
  if (n == 0)
    return text;
  throw EnvironmentError(error == EISDIR   ? "it is a folder"
                         : error == ENOENT ? "there is no such file"
                         : error == EACCES ? "it may not be read"
                                           : std::strerror(error));
}
} // namespace ligament::core
