#include "src/verification/cases/random_scenes.h"

#include "core/check.h"
#include "src/verification/cases/random_scenes_results.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include <unistd.h>

namespace ligament::program
{
namespace
{
const std::string case_name = "random_scenes";

/// Removed with all that is in it.
class TemporaryFolder
{
public:
  TemporaryFolder()
      : path_((std::filesystem::temp_directory_path() / fmt::format("ligament-{}", getpid()))
                  .string())
  {
    clear();
  }
  ~TemporaryFolder() { clear(); }
  void clear() const
  {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::string &path() const { return path_; }

private:
  std::string path_;
};

/// Results of the seeds first to last, those that the file holds as they are there.
std::vector<SceneResult> compute(int first, int last, ResultsFile &file)
{
  const TemporaryFolder folder;
  std::vector<SceneResult> results;
  for (int seed = first; seed <= last; ++seed) {
    auto result = file.find(seed);
    if (!result) {
      file.begin(seed);
      result = compute_scene(seed, folder.path());
      folder.clear();
      file.add(*result);
    }
    if (!result->holds())
      for (const auto &f : result->figures)
        if (!f.holds())
          fmt::print("  seed {:>4}: {} {:.3g} ({})\n", seed, f.name, f.value, result->kind);
    std::fflush(stdout);
    results.push_back(*result);
  }
  return results;
}

std::vector<Result> run_range(int first, int last, const std::string &folder)
{
  if (!folder.empty())
    std::filesystem::create_directories(folder);
  ResultsFile file(folder.empty() ? "" : folder + "/results.jsonl");
  const auto results = compute(first, last, file);
  fmt::print("{}", table(results));
  return statistics(case_name, results);
}

std::vector<Result> run_one(int seed, const std::string &folder)
{
  write_scene(draw_scene(seed), folder);
  fmt::print("  {}/scene.json and its variants, with the folders of their runs\n", folder);
  for (const char *run : {"coupled", "all_discrete", "half_step", "mirror"})
    std::filesystem::remove_all(folder + "/" + run);
  const SceneResult result = compute_scene(seed, folder);
  fmt::print("  {}\n", result.kind);
  for (const auto &text : {result.refused, result.remark})
    if (!text.empty())
      fmt::print("  {}\n", text);
  std::vector<Result> figures;
  for (const auto &f : result.figures)
    figures.push_back({case_name + "/" + f.name, f.value, f.must, {}});
  return figures;
}

/// Nothing but digits, as a number.
int number(const std::string &text, const std::string &seeds)
{
  core::require(!text.empty() && text.size() < 10 &&
                    text.find_first_not_of("0123456789") == std::string::npos,
                "--seeds " + seeds + ": give a number, or two like 1:1000");
  return std::stoi(text);
}
} // namespace

Case select_random_scenes(const std::string &seeds, const std::string &folder)
{
  const auto colon = seeds.find(':');
  const int first = number(seeds.substr(0, colon), seeds);
  if (colon == std::string::npos) {
    const std::string own = folder.empty() ? fmt::format("random_scene_{}-out", first) : folder;
    return {case_name, fmt::format("the scene of seed {}", first), true,
            [=] { return run_one(first, own); }};
  }
  const int last = number(seeds.substr(colon + 1), seeds);
  core::require(first <= last, "--seeds " + seeds + ": the range is empty");
  const std::string own = folder.empty() ? "random_scenes-out" : folder;
  return {case_name, fmt::format("scenes drawn from the seeds {} to {}", first, last), true,
          [=] { return run_range(first, last, own); }};
}

std::vector<Case> random_scene_cases()
{
  return {{case_name,
           "ten scenes drawn at random, each coupled and all discrete, in a mirror and "
           "with half the step",
           true, [] { return run_range(1, 10, ""); }},
          {case_name + "_thousand",
           "a thousand of them; random_scenes-out keeps the results, a second call goes on", true,
           [] { return run_range(1, 1000, "random_scenes-out"); }}};
}
} // namespace ligament::program
