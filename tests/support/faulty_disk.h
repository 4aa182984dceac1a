// The environment of programs whose disk refuses what it is told to (faulty_disk.cc).
#pragma once

#include <string>

namespace ligament::tests
{
/// Goes in front of a command of the shell, beside FAULTY_DISK_...; of test programs that know
/// LIGAMENT_FAULTY_DISK. Sanitizers are told that this library comes before theirs.
inline std::string with_faulty_disk()
{
  return std::string("LD_PRELOAD=") + LIGAMENT_FAULTY_DISK +
         " ASAN_OPTIONS=verify_asan_link_order=0:$ASAN_OPTIONS ";
}
} // namespace ligament::tests
