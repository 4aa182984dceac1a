#include "core/folders.h"

#include "core/check.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace ligament::core
{
namespace
{
[[noreturn]] void fail(const std::string &action, const std::string &path)
{
  throw EnvironmentError("cannot " + action + " " + path + ": " + std::strerror(errno));
}

std::string parent_of(const std::string &path)
{
  const std::size_t slash = path.rfind('/');
  return slash == path.npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
}

} // namespace

void sync_folder(const std::string &path)
{
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0)
    fail("open", path);
  // File systems that cannot synchronise folders say so by EINVAL.
  const bool failed = ::fsync(descriptor) != 0 && errno != EINVAL && errno != EROFS;
  const int error = errno;
  ::close(descriptor);
  errno = error;
  if (failed)
    fail("write", path);
}

void make_new_folder(const std::string &path)
{
  if (::mkdir(path.c_str(), 0777) != 0)
    fail("make", path);
  sync_folder(parent_of(path));
}

void rename_folder(const std::string &from, const std::string &to)
{
  if (::rename(from.c_str(), to.c_str()) != 0)
    fail("rename", from);
  sync_folder(parent_of(to));
}

void remove_folder(const std::string &path)
{
  for (const std::string &name : folder_entries(path))
    if (const std::string file = path + "/" + name; ::unlink(file.c_str()) != 0)
      fail("remove", file);
  if (::rmdir(path.c_str()) != 0)
    fail("remove", path);
  sync_folder(parent_of(path));
}

void remove_file(const std::string &path)
{
  if (::unlink(path.c_str()) != 0)
    fail("remove", path);
  sync_folder(parent_of(path));
}

std::vector<std::string> folder_entries(const std::string &path)
{
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(path, error), end; !error && entry != end;
       entry.increment(error))
    names.push_back(entry->path().filename());
  require<EnvironmentError>(!error || error == std::errc::no_such_file_or_directory,
                            "cannot look into " + path + ": " + error.message());
  std::sort(names.begin(), names.end());
  return names;
}
} // namespace ligament::core
