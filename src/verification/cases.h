// The built-in verification cases: what they are called, what they measure, what must hold.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace ligament::program
{
/// One measured figure beside its bound. How each is defined and computed: docs/verification.md.
struct Result
{
  enum class Bound
  {
    at_most,
    at_least
  };

  std::string name; // "<case>/<what>"
  double value;
  double must;
  std::optional<double> aim;
  Bound bound = Bound::at_most;

  /// Of figures that stand for many scenes: `value` is what 99 % of them don't exceed.
  struct Spread
  {
    int n, n_failing;
    double median, tenth, nine_tenths, worst;
    std::vector<int> worst_seeds; // the worst first
  };
  std::optional<Spread> spread = {};

  /// "must" holds; a value that is not a number fails.
  bool passed() const { return bound == Bound::at_most ? value <= must : value >= must; }
};

struct Case
{
  std::string name; // also the first part of the names of its figures
  std::string text; // one line
  bool slow;        // runs with --full, or when it is asked for by its whole name
  std::function<std::vector<Result>()> run;
};

// Each list stands in the file of its name.
std::vector<Case> moduli_cases();
std::vector<Case> patch_cases();
std::vector<Case> rotation_cases();
std::vector<Case> regime_cases();
std::vector<Case> coarse_mass_cases();
std::vector<Case> drift_cases();
std::vector<Case> critical_step_cases();
std::vector<Case> wave_cases();
std::vector<Case> scheme_cases();
std::vector<Case> wave_bench_cases();
std::vector<Case> absorbing_cases();
std::vector<Case> absorbing_steady_cases();
std::vector<Case> kirsch_cases();
std::vector<Case> beam_cases();
std::vector<Case> cantilever_cases();
std::vector<Case> stability_cases();
std::vector<Case> contrast_cases();
std::vector<Case> compression_cases();
std::vector<Case> toughness_cases();
std::vector<Case> toughness_3d_cases();
std::vector<Case> toughness_mixed_cases();
std::vector<Case> random_scene_cases();
std::vector<Case> lab_gauges_cases();

/// All cases in the order in which they are printed.
std::vector<Case> all_cases();

/// The cases that `name` asks for: all when it is empty, else the case of that name, else those
/// whose names begin with it; slow ones when `full`, or when the whole name is given. Throws
/// core::InputError with the list of cases when there is none.
std::vector<Case> select_cases(const std::string &name, bool full);
} // namespace ligament::program
