// The checkpoints of a run, from which it can go on: whole or not there, whatever happens.
#pragma once

#include "core/ranks.h"
#include "core/state.h"
#include "src/output/checkpoint_manifest.h"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ligament::program
{
struct Checkpoint
{
  CheckpointManifest manifest;
  std::map<std::string, core::State> states; // by name
  std::map<std::string, core::State> kept;   // those that are not lost
  std::vector<std::string> kept_lost;        // why
  core::State reference;                     // empty: there is none, or it is lost
  std::string reference_lost;                // why
};

/// A state that a run keeps from an earlier time, for pictures and comparisons. It never changes:
/// it is written once, under its name beside the checkpoints that name it.
struct KeptState
{
  std::string name;
  std::function<core::State()> take; // asked only where it is not on the disk yet
};

/// What was found: the newest one that can be used, and why newer ones cannot.
struct FoundCheckpoint
{
  std::optional<Checkpoint> checkpoint;
  std::vector<std::string> passed_over;
};

/// A folder with one folder per checkpoint, checkpoint_000001, 000002, ...: files of states and,
/// written last, manifest.json. It is made as checkpoint_NNNNNN.tmp and renamed when all of it is
/// on the disk. Folders without a manifest and those that are still .tmp are none.
class Checkpoints
{
public:
  explicit Checkpoints(std::string folder);

  /// Writes one more and removes what is older than the one before; number and files of the
  /// manifest are filled in here. Throws core::EnvironmentError when the disk refuses: the
  /// newest one before is untouched then.
  void write(CheckpointManifest manifest, const std::map<std::string, core::State> &states,
             const std::vector<KeptState> &kept = {}) const;

  /// Of several ranks, which all call it: with what take() gives on the first one, asked already
  /// where that is not on the disk. All take part in it.
  std::vector<KeptState> taken(std::vector<KeptState> kept, const core::Ranks &ranks) const;

  /// What all checkpoints of a run have in common, written once beside them; its sum belongs into
  /// their manifests. It is what a set-up can find again: a checkpoint can do without.
  core::StateFileSum write_reference(const core::State &state) const;

  /// Verifies before it answers; the folder stays as it is. Does not throw for what is damaged.
  /// One that has lost nothing comes first; where none is left, the newest that has lost no more
  /// than kept states: a run can do without.
  FoundCheckpoint newest_good() const;

  /// For a run that goes on from an older one: the newer ones are of a future that will not be.
  void remove_newer_than(std::int64_t number) const;

private:
  void make() const;
  std::string path(std::int64_t number) const;
  /// Of all that have left .tmp behind, ascending.
  std::vector<std::int64_t> numbers() const;
  /// Removes what is not whole, and kept states that no checkpoint names.
  void clean() const;
  /// Writes those that are not there yet.
  void write_kept(CheckpointManifest &manifest, const std::vector<KeptState> &kept) const;
  /// Whether one is on the disk already, and a checkpoint names it.
  std::vector<std::int64_t> are_missing(const std::vector<KeptState> &kept) const;
  /// Of the checkpoints that are there.
  std::map<std::string, core::StateFileSum> all_kept() const;
  CheckpointManifest read_manifest(std::int64_t number) const;
  Checkpoint read(std::int64_t number) const;

  std::string folder_;
};
} // namespace ligament::program
