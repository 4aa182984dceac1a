// What a checkpoint says of itself: where the run stood, of what scene and program, and which
// files.
#pragma once

#include "core/state_file.h"
#include "core/timers.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ligament::program
{
struct CheckpointManifest
{
  std::int64_t number = 0; // of the checkpoint, counted up in a run
  std::int64_t step = 0;
  double time = 0; // s
  double dt = 0;   // s

  // What the run did so far, for its record.
  std::string started; // date and time
  double setup_seconds = 0, wall_seconds = 0;
  std::vector<core::Timers::Row> timing; // of both
  std::vector<std::string> warnings;

  // The program: another one computes other last bits.
  std::string version, commit;
  std::string instructions; // that the kernels were compiled for

  nlohmann::ordered_json scene; // resolved
  /// Bytes of the files of the run that grow, by their names in its folder: what follows was
  /// written later.
  std::map<std::string, std::int64_t> positions;
  std::map<std::string, core::StateFileSum> states; // by name
  std::map<std::string, core::StateFileSum> kept;   // likewise, see KeptState
  std::optional<core::StateFileSum> reference;      // see Checkpoints::write_reference
};

/// Its file, with a checksum of all that it says.
std::string manifest_text(const CheckpointManifest &manifest);

/// Throws core::InputError with what is wrong for a text that manifest_text() does not make.
CheckpointManifest parse_manifest(const std::string &text);
} // namespace ligament::program
