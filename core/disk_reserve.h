// Room on the disk that is kept for the last file of a run: what it was, when the disk is full.
#pragma once

#include <string>

namespace ligament::core
{
/// A file of zeros that is there until the room is needed.
class DiskReserve
{
public:
  /// Takes the room beside the file that it is for. Throws EnvironmentError when there is none;
  /// file systems that cannot reserve anything are left in peace.
  DiskReserve(const std::string &for_file, std::size_t bytes);
  ~DiskReserve();
  DiskReserve(const DiskReserve &) = delete;
  DiskReserve &operator=(const DiskReserve &) = delete;

private:
  std::string for_file_;
};

/// Gives the room that is reserved for this file back to the disk; false when there is none.
bool release_reserve(const std::string &for_file);
} // namespace ligament::core
