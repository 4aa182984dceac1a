// The environment of programs whose disk refuses what it is told to (faulty_disk.cc).
#pragma once

#include <string>

namespace ligament::tests
{
/// Goes in front of a command, beside FAULTY_DISK_...; of test programs that know
/// LIGAMENT_FAULTY_DISK. Sanitizers are told that this library comes before theirs, and not to look
/// for leaks: the program that names those would load it, too.
inline std::string with_faulty_disk()
{
  return std::string("LD_PRELOAD=") + LIGAMENT_FAULTY_DISK +
         " ASAN_OPTIONS=verify_asan_link_order=0:detect_leaks=0 ";
}
} // namespace ligament::tests
