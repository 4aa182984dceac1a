// The commands and options that users type; the launcher and the solver read the same ones.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace ligament::program
{
struct CommandLine
{
  std::string command; // run resume check new compare sweep explain report verify
  bool json = false;   // end with one JSON object on the last line of standard output

  std::string scene;                  // run, check: file; resume: empty: that of the run
  std::vector<std::string> overrides; // run, check: "/path=value", in their order
  std::string kind;                   // new: of scene; empty: lists them
  std::string output;                 // what is written: folder, new: file; empty: of that name
  int ranks = 1;                      // run, resume, check
  bool in_pieces = false;             // run, resume: fields, a file per rank
  bool draw = false;                  // check: also a picture
  std::string study;                  // sweep: file
  int jobs = 1;                       // sweep: runs at the same time
  bool dry_run = false;               // sweep: list the cases only
  double wall_time = 0;               // run, resume: s until it ends; 0: no limit
  int rebuild_interval = 0;           // run, resume: see Simulation::rebuild_every; 0: never
  std::string run, reference; // resume, compare, report: folders (the reference may be a curve)
  std::vector<std::string> fields; // report: of its pictures; empty: those of the run
  std::string key;                 // explain; empty: all keys
  bool markdown = false;           // explain: the page of the manual
  bool schema = false;             // explain: the JSON schema
  bool explain_study = false;      // explain: of study files
  std::string verify_case;         // verify; empty: all
  bool full = false;               // verify: also the slow ones; check: builds whatever its size
  bool stability = false;          // verify: those of stability under stress
  std::string seeds;               // verify: of random scenes, into `output`; "17" or "1:1000"

  /// Set when nothing is left to do: help and version were printed, or a mistake (2).
  std::optional<int> exit_code;
};

/// Reads the arguments; help and version go to standard output, mistakes to standard error (and,
/// with --json, to standard output as an object with "errors").
CommandLine parse_command_line(int argc, const char *const *argv);

/// JSON as text, on one line without `indent`. Bytes that are not UTF-8 (file names may hold some)
/// become U+FFFD.
std::string json_text(const nlohmann::ordered_json &json, int indent = -1);

/// Text of {"status": .., "errors": [message]} on one line, for what has no place in a scene:
/// status "wrong input", "stopped" or "failed".
std::string error_json(const std::string &status, const std::string &message);

/// Folder for the outputs of `run`: --output, or the scene's name with "-out": of a
/// scene.json that of its folder.
std::string output_folder(const CommandLine &line);
} // namespace ligament::program
