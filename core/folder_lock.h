// A folder in which one process at a time works: a lock that ends with its process.
#pragma once

#include <string>

namespace ligament::core
{
/// Held from construction to destruction, released by the system when the process is killed.
class FolderLock
{
public:
  /// Locks the folder, which must exist, by a file "lock" in it. Throws EnvironmentError when
  /// another process works there, in words: "<folder>: another <work> is under way in this folder".
  FolderLock(const std::string &folder, const std::string &work);
  ~FolderLock();
  FolderLock(const FolderLock &) = delete;
  FolderLock &operator=(const FolderLock &) = delete;

  /// Does a process work in this folder now?
  static bool is_held(const std::string &folder);

private:
  std::string file_;
  int descriptor_ = -1;
};
} // namespace ligament::core
