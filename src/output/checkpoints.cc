#include "src/output/checkpoints.h"

#include "core/check.h"
#include "core/files.h"
#include "core/folders.h"

#include <fmt/format.h>

#include <algorithm>

#include <unistd.h>

namespace ligament::program
{
namespace
{
const std::string reference_name = "reference", prefix = "checkpoint_",
                  manifest_file = "manifest.json", unfinished = ".tmp", kept_prefix = "kept_",
                  ending = ".bin";

/// Of a name checkpoint_NNNNNN; 0: it is none.
std::int64_t number_of(const std::string &name)
{
  if (name.rfind(prefix, 0) != 0 || name.size() > prefix.size() + 18)
    return 0;
  std::int64_t number = 0;
  for (std::size_t c = prefix.size(); c < name.size(); ++c) {
    if (name[c] < '0' || name[c] > '9')
      return 0;
    number = 10 * number + (name[c] - '0');
  }
  return number;
}

bool is_unfinished(const std::string &name)
{
  return name.size() > unfinished.size() &&
         name.compare(name.size() - unfinished.size(), unfinished.size(), unfinished) == 0 &&
         number_of(name.substr(0, name.size() - unfinished.size())) > 0;
}

bool is_there(const std::string &path)
{
  return ::access(path.c_str(), F_OK) == 0;
}

/// The name of the kept state in this file.
std::string kept_of(const std::string &file)
{
  const std::size_t size = file.size() - std::min(file.size(), ending.size());
  return file.substr(kept_prefix.size(), size - std::min(size, kept_prefix.size()));
}

std::string state_file(const std::string &folder, const std::string &name)
{
  return folder + "/" + name + ending;
}
} // namespace

Checkpoints::Checkpoints(std::string folder) : folder_(std::move(folder))
{
}

std::string Checkpoints::path(std::int64_t number) const
{
  return fmt::format("{}/{}{:06}", folder_, prefix, number);
}

std::vector<std::int64_t> Checkpoints::numbers() const
{
  std::vector<std::int64_t> numbers;
  for (const std::string &name : core::folder_entries(folder_))
    if (const std::int64_t number = number_of(name); number > 0)
      numbers.push_back(number);
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

std::map<std::string, core::StateFileSum> Checkpoints::all_kept() const
{
  std::map<std::string, core::StateFileSum> kept;
  for (const std::int64_t number : numbers())
    try {
      const CheckpointManifest manifest = read_manifest(number);
      kept.insert(manifest.kept.begin(), manifest.kept.end());
    } catch (const core::InputError &) {
      // A checkpoint that cannot be used keeps nothing.
    }
  return kept;
}

void Checkpoints::clean() const
{
  for (const std::string &name : core::folder_entries(folder_)) {
    const std::string entry = folder_ + "/" + name;
    if (is_unfinished(name) || (number_of(name) > 0 && !is_there(entry + "/" + manifest_file)))
      core::remove_folder(entry);
  }
  const auto kept = all_kept();
  for (const std::string &name : core::folder_entries(folder_))
    if (name.rfind(kept_prefix, 0) == 0 && !kept.count(kept_of(name)))
      core::remove_file(folder_ + "/" + name);
}

void Checkpoints::make() const
{
  if (!is_there(folder_))
    core::make_new_folder(folder_);
}

core::StateFileSum Checkpoints::write_reference(const core::State &state) const
{
  make();
  const core::StateFileSum sum = core::write_state_file(state_file(folder_, reference_name), state);
  core::sync_folder(folder_);
  return sum;
}

std::vector<std::int64_t> Checkpoints::are_missing(const std::vector<KeptState> &kept) const
{
  std::vector<std::int64_t> missing(kept.size(), 1);
  try {
    const auto there = all_kept();
    for (std::size_t k = 0; k < kept.size(); ++k)
      missing[k] = there.count(kept[k].name) == 0 ||
                   !is_there(state_file(folder_, kept_prefix + kept[k].name));
  } catch (const core::EnvironmentError &) {
    // Who writes says so.
  }
  return missing;
}

std::vector<KeptState> Checkpoints::taken(std::vector<KeptState> kept,
                                          const core::Ranks &ranks) const
{
  if (ranks.is_one())
    return kept;
  const auto missing =
      ranks.max(ranks.is_first() ? are_missing(kept) : std::vector<std::int64_t>(kept.size(), 0));
  for (std::size_t k = 0; k < kept.size(); ++k)
    if (missing[k])
      kept[k].take = [state = kept[k].take()] { return state; };
  return kept;
}

void Checkpoints::write_kept(CheckpointManifest &manifest, const std::vector<KeptState> &kept) const
{
  const auto there = all_kept();
  manifest.kept.clear();
  bool is_new = false;
  for (const KeptState &state : kept) {
    const std::string file = state_file(folder_, kept_prefix + state.name);
    const auto found = there.find(state.name);
    if (found != there.end() && is_there(file)) {
      manifest.kept.insert(*found);
      continue;
    }
    manifest.kept[state.name] = core::write_state_file(file, state.take());
    is_new = true;
  }
  if (is_new)
    core::sync_folder(folder_);
}

void Checkpoints::write(CheckpointManifest manifest,
                        const std::map<std::string, core::State> &states,
                        const std::vector<KeptState> &kept) const
{
  make();
  clean();
  const std::vector<std::int64_t> before = numbers();
  manifest.number = before.empty() ? 1 : before.back() + 1;
  manifest.states.clear();
  const std::string whole = path(manifest.number), part = whole + unfinished;
  try {
    write_kept(manifest, kept);
    core::make_new_folder(part);
    for (const auto &[name, state] : states)
      manifest.states[name] = core::write_state_file(state_file(part, name), state);
    core::write_file(part + "/" + manifest_file, manifest_text(manifest));
    core::sync_folder(part);
    core::rename_folder(part, whole);
  } catch (const core::EnvironmentError &) {
    try {
      clean(); // gives the room back
    } catch (const core::EnvironmentError &) {
      // The next write tries again.
    }
    throw;
  }
  for (std::size_t k = 0; k + 1 < before.size(); ++k)
    core::remove_folder(path(before[k]));
  clean();
}

CheckpointManifest Checkpoints::read_manifest(std::int64_t number) const
{
  CheckpointManifest manifest;
  const std::string file = path(number) + "/" + manifest_file;
  const std::string text = core::read_file(file);
  try {
    manifest = parse_manifest(text);
  } catch (const core::InputError &error) {
    throw core::InputError(file + ": " + error.what());
  }
  core::require(manifest.number == number,
                fmt::format("{}: of checkpoint {}, not of this one", file, manifest.number));
  return manifest;
}

Checkpoint Checkpoints::read(std::int64_t number) const
{
  const std::string folder = path(number);
  Checkpoint checkpoint;
  CheckpointManifest &manifest = checkpoint.manifest;
  manifest = read_manifest(number);
  for (const auto &[name, sum] : manifest.states)
    checkpoint.states[name] = core::read_state_file(state_file(folder, name), sum);
  for (const auto &[name, sum] : manifest.kept)
    try {
      checkpoint.kept[name] = core::read_state_file(state_file(folder_, kept_prefix + name), sum);
    } catch (const core::InputError &error) {
      checkpoint.kept_lost.push_back(error.what());
    }
  if (manifest.reference)
    try {
      checkpoint.reference =
          core::read_state_file(state_file(folder_, reference_name), manifest.reference);
    } catch (const core::InputError &error) {
      checkpoint.reference_lost = error.what();
    }
  return checkpoint;
}

FoundCheckpoint Checkpoints::newest_good() const
{
  FoundCheckpoint found;
  std::optional<Checkpoint> with_losses; // the newest
  std::vector<std::string> passed_over;  // without it
  try {
    const std::vector<std::int64_t> all = numbers();
    for (auto number = all.rbegin(); number != all.rend(); ++number)
      try {
        Checkpoint checkpoint = read(*number);
        if (checkpoint.kept_lost.empty()) {
          found.checkpoint = std::move(checkpoint);
          return found;
        }
        const auto &lost = checkpoint.kept_lost;
        found.passed_over.insert(found.passed_over.end(), lost.begin(), lost.end());
        if (!with_losses)
          with_losses = std::move(checkpoint);
      } catch (const core::InputError &error) {
        found.passed_over.push_back(error.what());
        passed_over.push_back(error.what());
      } catch (const core::EnvironmentError &error) {
        found.passed_over.push_back(error.what());
        passed_over.push_back(error.what());
      }
  } catch (const core::EnvironmentError &error) {
    found.passed_over.push_back(error.what());
    passed_over.push_back(error.what());
  }
  if (with_losses)
    return {std::move(with_losses), std::move(passed_over)};
  return found;
}

void Checkpoints::remove_newer_than(std::int64_t number) const
{
  const std::vector<std::int64_t> all = numbers();
  for (auto newer = all.rbegin(); newer != all.rend() && *newer > number; ++newer)
    core::remove_folder(path(*newer));
}
} // namespace ligament::program
