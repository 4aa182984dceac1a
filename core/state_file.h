// A State on the disk: tables with their names, packed keys and words bit by bit, under checksums.
#pragma once

#include "core/state.h"

#include <cstdint>
#include <optional>
#include <string>

namespace ligament::core
{
/// What tells one file of states from another.
struct StateFileSum
{
  std::int64_t bytes = 0;
  std::int64_t checksum = 0; // CRC-32 of all that the file says

  bool operator==(const StateFileSum &other) const
  {
    return bytes == other.bytes && checksum == other.checksum;
  }
};

/// Replaced at once, synchronised with the disk. Throws EnvironmentError when the disk refuses.
StateFileSum write_state_file(const std::string &path, const State &state);

/// That of the file which this state makes.
StateFileSum state_file_sum(const State &state);

/// Verifies all of it before any of it is used. Throws InputError with the path and what is wrong
/// for a file that is missing, cut, damaged, of another format, or not the expected one.
State read_state_file(const std::string &path, const std::optional<StateFileSum> &expected = {});
} // namespace ligament::core
