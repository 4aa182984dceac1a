#include "src/verification/cases/random_scenes_results.h"

#include "core/check.h"
#include "core/version.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

namespace ligament::program
{
namespace
{
using Json = nlohmann::ordered_json;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t n_worst = 5;

std::string build()
{
  return fmt::format("{} {}", core::version(), core::commit());
}

Json number(double value)
{
  return std::isfinite(value) ? Json(value) : Json();
}

double number(const Json &json, double otherwise)
{
  return json.is_number() ? json.get<double>() : otherwise;
}

Json to_json(const SceneResult &r)
{
  Json figures = Json::object();
  for (const auto &f : r.figures)
    figures[f.name] = {number(f.value), number(f.must)};
  return {{"seed", r.seed},     {"build", build()},     {"kind", r.kind},    {"refused", r.refused},
          {"remark", r.remark}, {"seconds", r.seconds}, {"figures", figures}};
}

SceneResult from_json(const Json &json)
{
  SceneResult r;
  r.seed = json.at("seed");
  r.kind = json.at("kind");
  r.refused = json.at("refused");
  r.remark = json.at("remark");
  r.seconds = json.at("seconds");
  for (const auto &[name, pair] : json.at("figures").items())
    r.figures.push_back({name, number(pair.at(0), std::nan("")), number(pair.at(1), infinity)});
  return r;
}

std::string kind_of(const RandomScene &s)
{
  return fmt::format("{}D {} nu {} {} {} {} {} by {}, {} damping", s.dimension, s.packing,
                     s.json["material"]["poissons_ratio"].get<double>(), s.zone, s.crack,
                     s.json["discrete_zone"].contains("orientation") ? "turned" : "straight",
                     s.load, s.control, s.damping);
}

/// Figures of one name, the worst first: what is not a number is worse than any number.
struct Sample
{
  double must = 0;
  std::vector<std::pair<double, int>> values; // and seeds

  double quantile(double share) const
  {
    const auto n = double(values.size());
    return values[std::size_t(std::clamp(std::floor((1 - share) * n), 0., n - 1))].first;
  }
  long n_failing() const
  {
    return std::count_if(values.begin(), values.end(),
                         [&](const auto &v) { return !(v.first <= must); });
  }
};

std::vector<std::pair<std::string, Sample>> samples(const std::vector<SceneResult> &results)
{
  std::vector<std::pair<std::string, Sample>> all;
  const auto of = [&](const std::string &name) -> Sample & {
    for (auto &[other, sample] : all)
      if (other == name)
        return sample;
    return all.emplace_back(name, Sample()).second;
  };
  for (const auto &r : results)
    for (const auto &f : r.figures) {
      Sample &sample = of(f.name);
      sample.must = std::max(sample.must, f.must);
      sample.values.push_back({std::isnan(f.value) ? infinity : f.value, r.seed});
    }
  for (auto &[name, sample] : all)
    std::sort(sample.values.begin(), sample.values.end(), std::greater<>());
  return all;
}

template <typename Condition>
double share(const std::vector<SceneResult> &results, Condition &&condition)
{
  return double(std::count_if(results.begin(), results.end(), condition)) /
         double(std::max<std::size_t>(1, results.size()));
}

bool was_refused(const SceneResult &r)
{
  return !r.refused.empty();
}

std::string first_line(const std::string &text)
{
  return text.substr(0, text.find('\n'));
}
} // namespace

bool SceneResult::holds() const
{
  return std::all_of(figures.begin(), figures.end(), [](const auto &f) { return f.holds(); });
}

SceneResult compute_scene(int seed, const std::string &folder)
{
  const RandomScene scene = draw_scene(seed);
  SceneResult result;
  result.seed = seed;
  result.kind = kind_of(scene);
  try {
    SceneRuns runs = run_scene(scene, folder);
    look_closer(scene, folder, stiffness_is_doubtful(scene, runs), peak_is_doubtful(scene, runs),
                runs);
    result.refused = first_line(runs.refused);
    result.seconds = runs.seconds;
    result.figures = judge(scene, runs);
    result.remark = remark(scene, runs);
  } catch (const std::exception &error) {
    result.remark = first_line(error.what());
    result.figures = {{"failed", 1, 0}};
  }
  return result;
}

ResultsFile::ResultsFile(const std::string &path) : path_(path)
{
  std::ifstream file(path);
  for (std::string text; std::getline(file, text);) {
    const Json line = Json::parse(text, nullptr, false);
    if (line.is_discarded() || !line.contains("build") || line["build"] != build())
      continue;
    if (line.contains("figures"))
      results_[line["seed"]] = from_json(line);
    else
      ++n_begun_[line["seed"]];
  }
}

std::optional<SceneResult> ResultsFile::find(int seed) const
{
  if (const auto known = results_.find(seed); known != results_.end())
    return known->second;
  if (const auto begun = n_begun_.find(seed); begun == n_begun_.end() || begun->second < 2)
    return {};
  SceneResult crashed;
  crashed.seed = seed;
  crashed.remark = "the program ended while it computed the scene, twice";
  crashed.figures = {{"failed", 1, 0}};
  return crashed;
}

void ResultsFile::append(const Json &line) const
{
  if (path_.empty())
    return;
  // A torn line of a killed program must not swallow the next one.
  std::ofstream file(path_, std::ios::app);
  file << '\n' << line.dump(-1, ' ', false, Json::error_handler_t::replace) << std::endl;
  core::require<core::EnvironmentError>(file.good(), "cannot write " + path_);
}

void ResultsFile::begin(int seed)
{
  ++n_begun_[seed];
  append({{"seed", seed}, {"build", build()}});
}

void ResultsFile::add(const SceneResult &result)
{
  results_[result.seed] = result;
  append(to_json(result));
}

std::vector<Result> statistics(const std::string &name, const std::vector<SceneResult> &results)
{
  using Bound = Result::Bound;
  std::vector<SceneResult> computed;
  std::copy_if(results.begin(), results.end(), std::back_inserter(computed),
               [](const auto &r) { return !was_refused(r); });
  double longest = 0;
  for (const auto &r : results)
    longest = std::max(longest, r.seconds);
  std::vector<Result> lines = {{name + "/share_that_holds",
                                share(computed, [](const auto &r) { return r.holds(); }), 0.99, 1,
                                Bound::at_least},
                               {name + "/share_refused", share(results, was_refused), 0.1, 0},
                               {name + "/longest_seconds", longest, 7, {}}};
  for (const auto &[figure, sample] : samples(computed)) {
    Result line{name + "/" + figure, sample.quantile(0.99), sample.must, {}};
    line.spread.emplace();
    line.spread->median = sample.quantile(0.5);
    line.spread->tenth = sample.quantile(0.1);
    line.spread->nine_tenths = sample.quantile(0.9);
    line.spread->worst = sample.values.front().first;
    line.spread->n = int(sample.values.size());
    line.spread->n_failing = int(sample.n_failing());
    for (std::size_t k = 0; k < std::min(n_worst, sample.values.size()); ++k)
      line.spread->worst_seeds.push_back(sample.values[k].second);
    lines.push_back(line);
  }
  return lines;
}

std::string table(const std::vector<SceneResult> &results)
{
  std::string text =
      fmt::format("  {:<32} {:>5} {:>10} {:>10} {:>10} {:>10} {:>8} {:>7}  {}\n", "figure", "n",
                  "median", "90 %", "99 %", "worst", "must", "failing", "seeds of the worst");
  std::vector<SceneResult> computed;
  std::map<std::string, std::vector<int>> remarks;
  for (const auto &r : results) {
    if (!was_refused(r))
      computed.push_back(r);
    const std::string why = was_refused(r) ? "refused: " + r.refused : r.remark;
    if (!why.empty())
      remarks[why].push_back(r.seed);
  }
  for (const auto &[name, s] : samples(computed)) {
    std::string seeds;
    for (std::size_t k = 0; k < std::min(n_worst, s.values.size()); ++k)
      seeds += fmt::format("{} ", s.values[k].second);
    text += fmt::format(
        "  {:<32} {:>5} {:>10.2g} {:>10.2g} {:>10.2g} {:>10.2g} {:>8} {:>7}  {}\n", name,
        s.values.size(), s.quantile(0.5), s.quantile(0.9), s.quantile(0.99), s.values.front().first,
        std::isfinite(s.must) ? fmt::format("{:.2g}", s.must) : "-", s.n_failing(), seeds);
  }
  for (const auto &[why, seeds] : remarks)
    text += fmt::format("  {} of {}: {} (seed {}{})\n", seeds.size(), results.size(), why, seeds[0],
                        seeds.size() > 1 ? ", ..." : "");
  return text;
}
} // namespace ligament::program
