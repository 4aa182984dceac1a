// A study: which cases of a scene are computed, and what they are measured against.
#pragma once

#include "core/diagnostic.h"
#include "core/json.h"

#include <optional>
#include <string>
#include <vector>

namespace ligament::program
{
/// Every combination of the values of some keys.
struct StudyGrid
{
  std::string name;                   // empty: the names of its keys
  std::vector<core::JsonMember> set;  // keys and values of all its cases
  std::vector<core::JsonMember> vary; // keys and lists of values
};

/// One case with a name.
struct StudyRow
{
  std::string name;
  bool rival = false; // marked in the plots: what users would try in place of coupling
  std::vector<core::JsonMember> set;
};

/// The answer that the total error is measured against; one member is given, or none.
struct TotalReference
{
  std::string reference; // row, output folder of a run, or CSV curve
  std::optional<double> peak_load, peak_stress, stiffness; // N, Pa, Pa
};

/// Which error the plots show.
enum class Measure
{
  peak_load,
  stiffness,
  energy,
  crack_distance,
  displacement,
  breaking_time
};

/// What the plots show over which.
enum class Cost
{
  run_time, // what a user waits
  core_time // what the processors work: also sound when others use the machine
};

struct Study
{
  std::string title;
  std::string scene;
  std::vector<core::JsonMember> set;
  std::vector<StudyGrid> grids;
  std::vector<StudyRow> rows;
  std::string reference;
  TotalReference total;
  Measure measure = Measure::peak_load;
  Cost cost = Cost::run_time;
};

struct StudyResult
{
  std::optional<Study> study; // without value when there are errors
  core::JsonValue json;       // as it was written, for the places of later errors
  std::vector<core::Diagnostic> errors;
};

/// Reads a study file (JSON with comments); paths in it become relative to the present folder.
/// Keys of the scene are not looked at: see make_cases(). Does not throw for wrong input.
StudyResult read_study(const std::string &file);

/// All keys of study files, in Markdown.
std::string study_markdown();

/// JSON schema of study files.
std::string study_schema();
} // namespace ligament::program
