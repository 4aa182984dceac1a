#include "src/output/run_folder.h"

#include "core/check.h"

#include <filesystem>

namespace ligament::program
{
void RunFolder::create() const
{
  for (const auto &folder : {path, fields(), pictures()}) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    core::require<core::EnvironmentError>(!error, "cannot make the folder " + folder + ": " +
                                                      error.message());
  }
}

bool RunFolder::holds_a_run() const
{
  std::error_code error;
  return std::filesystem::is_regular_file(record(), error);
}
} // namespace ligament::program
