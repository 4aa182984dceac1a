// A disk that fails, or a process that is killed, at the N-th call that changes a folder: loaded
// before the C library (LD_PRELOAD) into a program that knows nothing of it.
//
//   FAULTY_DISK_FOLDER  calls below it are counted: open for writing, write, fsync, rename, mkdir,
//                       unlink, rmdir
//   FAULTY_DISK_CALL    N, from 1
//   FAULTY_DISK_ACTION  kill: the process ends behind the N-th call
//                       tear: the same, and files lose half of what was not synchronised
//                       fail: the N-th call fails; fail_on: so do all behind it
//   FAULTY_DISK_ERROR   errno of the calls that fail
//   FAULTY_DISK_COUNT   file that receives the number of calls when the process ends by itself
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <string>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace
{
struct File
{
  std::string path;
  off_t synchronised = 0;
};

/// The files that are open, and those that were closed before they were synchronised.
struct Disk
{
  std::string folder = value("FAULTY_DISK_FOLDER"), action = value("FAULTY_DISK_ACTION");
  long fault_at = std::atol(value("FAULTY_DISK_CALL")), calls = 0;
  int error = std::atoi(value("FAULTY_DISK_ERROR"));
  std::map<int, File> files;
  std::recursive_mutex mutex; // the program may have threads

  static const char *value(const char *name)
  {
    const char *text = std::getenv(name);
    return text ? text : "";
  }
  ~Disk()
  {
    if (FILE *file = std::fopen(value("FAULTY_DISK_COUNT"), "w")) {
      std::fprintf(file, "%ld\n", calls);
      std::fclose(file);
    }
  }
};

Disk &disk()
{
  static Disk d;
  return d;
}

template <typename Function>
Function *real(const char *name, Function *)
{
  return reinterpret_cast<Function *>(dlsym(RTLD_NEXT, name));
}

using Lock = std::lock_guard<std::recursive_mutex>;

bool is_below(const char *path)
{
  const Disk &d = disk();
  return !d.folder.empty() && std::strncmp(path, d.folder.c_str(), d.folder.size()) == 0;
}

void tear_files()
{
  for (const auto &[descriptor, file] : disk().files) {
    struct stat status;
    if (stat(file.path.c_str(), &status) == 0 && status.st_size > file.synchronised)
      if (truncate(file.path.c_str(), (file.synchronised + status.st_size) / 2) != 0)
        _exit(98);
  }
}

/// Counts a call that concerns the folder, and does what is due at it.
template <typename Call>
long count(Call &&call)
{
  Disk &d = disk();
  const Lock lock(d.mutex);
  const long n = ++d.calls;
  if ((d.action == "fail" && n == d.fault_at) || (d.action == "fail_on" && n >= d.fault_at)) {
    errno = d.error;
    return -1;
  }
  const long result = call();
  if (n == d.fault_at && (d.action == "kill" || d.action == "tear")) {
    if (d.action == "tear")
      tear_files();
    _exit(99);
  }
  return result;
}

int open_file(const char *path, int flags, mode_t mode)
{
  static const auto real_open = real("open", ::open);
  if (!is_below(path) || (flags & O_ACCMODE) == O_RDONLY)
    return real_open(path, flags, mode);
  return int(count([&] {
    const int descriptor = real_open(path, flags, mode);
    if (descriptor >= 0)
      disk().files[descriptor] = {path};
    return descriptor;
  }));
}

mode_t mode_of(int flags, va_list arguments)
{
  return flags & O_CREAT ? va_arg(arguments, mode_t) : 0;
}
} // namespace

extern "C" {
int open(const char *path, int flags, ...)
{
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return open_file(path, flags, mode);
}

int open64(const char *path, int flags, ...)
{
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return open_file(path, flags, mode);
}

ssize_t write(int descriptor, const void *bytes, size_t n)
{
  static const auto real_write = real("write", ::write);
  const auto is_watched = [&] {
    const Lock lock(disk().mutex);
    return disk().files.count(descriptor) > 0;
  };
  if (!is_watched())
    return real_write(descriptor, bytes, n);
  return count([&] { return real_write(descriptor, bytes, n); });
}

// Killed processes lose nothing that they gave to the system: what matters is who asked for it.
int fsync(int descriptor)
{
  char path[4096];
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  const ssize_t n = readlink(link.c_str(), path, sizeof(path) - 1);
  path[n > 0 ? n : 0] = '\0';
  if (!is_below(path))
    return 0;
  return int(count([&] {
    const auto file = disk().files.find(descriptor);
    struct stat status;
    if (file != disk().files.end() && fstat(descriptor, &status) == 0)
      file->second.synchronised = status.st_size;
    return 0;
  }));
}

int close(int descriptor)
{
  static const auto real_close = real("close", ::close);
  const Lock lock(disk().mutex);
  auto &files = disk().files;
  if (const auto file = files.find(descriptor); file != files.end()) {
    files[-1 - int(files.size())] = file->second; // may be torn still
    files.erase(descriptor);
  }
  return real_close(descriptor);
}

int rename(const char *from, const char *to)
{
  static const auto real_rename = real("rename", ::rename);
  if (!is_below(to))
    return real_rename(from, to);
  return int(count([&] {
    const std::string old = from;
    for (auto &[descriptor, file] : disk().files)
      if (file.path.compare(0, old.size(), old) == 0)
        file.path = to + file.path.substr(old.size());
    return real_rename(from, to);
  }));
}

int mkdir(const char *path, mode_t mode)
{
  static const auto real_mkdir = real("mkdir", ::mkdir);
  return is_below(path) ? int(count([&] { return real_mkdir(path, mode); }))
                        : real_mkdir(path, mode);
}

int unlink(const char *path)
{
  static const auto real_unlink = real("unlink", ::unlink);
  return is_below(path) ? int(count([&] { return real_unlink(path); })) : real_unlink(path);
}

int rmdir(const char *path)
{
  static const auto real_rmdir = real("rmdir", ::rmdir);
  return is_below(path) ? int(count([&] { return real_rmdir(path); })) : real_rmdir(path);
}
}
