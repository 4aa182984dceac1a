// Results of drawn scenes in a file that grows line by line, and their statistics.
#pragma once

#include "src/verification/cases.h"
#include "src/verification/cases/random_scenes_judge.h"

#include <map>

namespace ligament::program
{
/// One scene's line.
struct SceneResult
{
  int seed = 0;
  std::string refused, remark; // see SceneRuns, remark()
  std::string kind;            // what was drawn, in a few words
  double seconds = 0;          // of the processor
  std::vector<SceneFigure> figures;

  bool holds() const;
};

/// Computes and judges the scene of a seed in `folder`. Whatever goes wrong becomes a figure
/// "failed" that doesn't hold.
SceneResult compute_scene(int seed, const std::string &folder);

/// A file of results in JSON, one per line. Lines of another version of the program, and the torn
/// last line of a killed one, are passed over.
class ResultsFile
{
public:
  /// Reads what is there. Without a path nothing is kept.
  explicit ResultsFile(const std::string &path);

  /// The result of a seed when it is known. A scene that twice began and never ended is one that
  /// crashes the program: "failed".
  std::optional<SceneResult> find(int seed) const;

  /// Before and after a scene.
  void begin(int seed);
  void add(const SceneResult &result);

private:
  void append(const nlohmann::ordered_json &line) const;

  std::string path_;
  std::map<int, SceneResult> results_;
  std::map<int, int> n_begun_;
};

/// One line per figure: the value that 99 % of the scenes don't exceed beside its bound, with the
/// spread and the seeds of the worst; before them the shares that hold and that were refused, and
/// the longest time.
std::vector<Result> statistics(const std::string &name, const std::vector<SceneResult> &results);

/// The same as a table with the remarks and the reasons of what was refused, for the terminal.
std::string table(const std::vector<SceneResult> &results);
} // namespace ligament::program
