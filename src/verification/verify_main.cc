// The program that computes verification cases: started by `ligament verify` with the same
// arguments. Those who only run scenes need not build it.
#include "core/check.h"
#include "core/flush_denormals.h"
#include "src/launcher/program.h"
#include "src/launcher/solver_start.h"
#include "src/verification/cases/random_scenes.h"
#include "src/verification/cases/stability.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <limits>

namespace
{
using namespace ligament::program;

/// A case that can't be computed fails with one figure that is not a number.
std::vector<Result> run_case(const Case &c)
{
  try {
    const std::vector<Result> results = c.run();
    ligament::core::require(!results.empty(), "it has no figures");
    return results;
  } catch (const std::exception &error) {
    fmt::print("  {}: {}\n", c.name, error.what());
    return {{c.name, std::numeric_limits<double>::quiet_NaN(), 0, {}}};
  }
}

void print(const Result &result)
{
  const char *sign = result.bound == Result::Bound::at_most ? "<=" : ">=";
  fmt::print("  {:<44} {:>12.4g} {} {:<9.4g} {:<9} {}\n", result.name, result.value, sign,
             result.must, result.aim ? fmt::format("{:.4g}", *result.aim) : "-",
             result.passed() ? "passed" : "FAILED");
}

std::vector<Case> select(const CommandLine &line)
{
  if (line.stability)
    return select_stability(line.full);
  const std::string of_seeds = "random_scenes";
  ligament::core::require(
      line.seeds.empty() || line.verify_case.empty() || line.verify_case == of_seeds,
      fmt::format("--seeds belongs to the case {}, not to {}: leave one of them out", of_seeds,
                  line.verify_case));
  if (!line.seeds.empty())
    return {select_random_scenes(line.seeds, line.output)};
  return select_cases(line.verify_case, line.full);
}

nlohmann::ordered_json to_json(const Result &result)
{
  nlohmann::ordered_json json = {{"name", result.name},
                                 {"value", result.value},
                                 {"must", result.must},
                                 {"aim", nullptr},
                                 {"passed", result.passed()}};
  if (result.aim)
    json["aim"] = *result.aim;
  if (const auto &s = result.spread)
    json["spread"] = {{"n", s->n},
                      {"failing", s->n_failing},
                      {"median", s->median},
                      {"tenth", s->tenth},
                      {"nine_tenths", s->nine_tenths},
                      {"worst", s->worst},
                      {"worst_seeds", s->worst_seeds}};
  return json;
}

/// Computes the cases and prints their figures beside "must" and "aim"; 0 when all pass, else 3.
int verify(const CommandLine &line)
{
  require_one_rank("verify");
  const auto cases = select(line);
  nlohmann::ordered_json json = {{"cases", nlohmann::json::array()}};
  int n = 0, n_failed = 0;
  fmt::print("  {:<44} {:>12}    {:<9} {:<9}\n", "figure", "value", "must", "aim");
  for (const auto &c : cases) {
    fmt::print("{}: {}\n", c.name, c.text);
    const auto start = std::chrono::steady_clock::now();
    for (const auto &result : run_case(c)) {
      print(result);
      ++n;
      n_failed += !result.passed();
      json["cases"].push_back(to_json(result));
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    fmt::print("  {:.1f} s\n", seconds.count());
    std::fflush(stdout);
  }
  const std::string verdict = n_failed == 0 ? fmt::format("all {} figures hold", n)
                                            : fmt::format("{} of {} figures fail", n_failed, n);
  fmt::print("{}\n", verdict);
  if (line.json) {
    json["status"] = n_failed == 0 ? "done" : "stopped";
    fmt::print("{}\n", json.dump());
  }
  return n_failed == 0 ? 0 : 3;
}
} // namespace

// Before any thread is started.
int main(int argc, char **argv)
{
  ligament::core::flush_denormals();
  return run_program(argc, argv,
                     [](const CommandLine &line, int, char **) { return verify(line); });
}
