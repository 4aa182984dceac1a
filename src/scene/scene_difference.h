// In which keys two resolved scenes differ, and which of these a run may go on with.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace ligament::program
{
struct KeyDifference
{
  std::string key;     // "/time/duration"
  std::string was, is; // as JSON; "nothing" where there is none
};

/// In the order of the first scene's keys, then those that it lacks.
std::vector<KeyDifference> differences(const nlohmann::ordered_json &was,
                                       const nlohmann::ordered_json &is);

/// Those of them with which a run cannot go on: all but a longer /time/duration, /output, and the
/// paths of named files, whose contents keep_named_files() compares.
std::vector<KeyDifference> differences_that_matter(const nlohmann::ordered_json &was,
                                                   const nlohmann::ordered_json &is);
} // namespace ligament::program
