#include "src/output/run_folder.h"

#include "core/check.h"

#include <algorithm>
#include <filesystem>

namespace ligament::program
{
namespace
{
/// What lies in a folder before the record of its run: left by `check --draw`, by a run that was
/// killed at once, or by a run that was refused at once.
constexpr const char *known_before_a_run[] = {"lock",      "run.json.part",     "run.json.reserve",
                                              "check.png", "check_packing.csv", "fields",
                                              "pictures"};
} // namespace

void make_folder(const std::string &path)
{
  std::error_code error;
  std::filesystem::create_directories(path, error);
  core::require<core::EnvironmentError>(!error,
                                        "cannot make the folder " + path + ": " + error.message());
}

void RunFolder::create() const
{
  for (const auto &folder : {path, fields(), pictures()})
    make_folder(folder);
}

bool RunFolder::holds_a_run() const
{
  std::error_code error;
  return std::filesystem::is_regular_file(record(), error);
}

std::string RunFolder::foreign_entry() const
{
  if (holds_a_run())
    return {};
  std::error_code error;
  for (const auto &entry : std::filesystem::directory_iterator(path, error)) {
    const std::string name = entry.path().filename();
    if (std::find(std::begin(known_before_a_run), std::end(known_before_a_run), name) ==
        std::end(known_before_a_run))
      return name;
  }
  core::require<core::EnvironmentError>(!error,
                                        "cannot look into " + path + ": " + error.message());
  return {};
}
} // namespace ligament::program
