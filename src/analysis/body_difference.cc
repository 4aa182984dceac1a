#include "src/analysis/body_difference.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
/// Above what units and sums of decimals leave, and far below what a figure could show.
constexpr double same_length = 1e-9;

bool differ(double a, double b)
{
  return std::abs(a - b) > same_length * std::max(std::abs(a), std::abs(b));
}

bool differ(const std::vector<double> &a, const std::vector<double> &b)
{
  return !std::equal(a.begin(), a.end(), b.begin(), b.end(),
                     [](double x, double y) { return !differ(x, y); });
}

/// With the digits that make the difference.
std::string metres(double length)
{
  return fmt::format("{:.12g} m", length);
}

std::string metres(const std::vector<double> &lengths)
{
  std::string text;
  for (const double length : lengths)
    text += (text.empty() ? "" : " x ") + metres(length);
  return text;
}

/// A run that was killed in its set-up has no body yet.
bool has_body(const RunRecord &r)
{
  return !r.size.empty();
}
} // namespace

std::vector<std::string> body_differences(const RunRecord &run, const std::string &run_name,
                                          const RunRecord &reference,
                                          const std::string &reference_name)
{
  std::vector<std::string> notes;
  const auto note = [&](const char *key, const std::string &a, const std::string &b,
                        const char *consequence) {
    notes.push_back(fmt::format("{}: {} in {}, {} in {}: {}", key, a, run_name, b, reference_name,
                                consequence));
  };
  if (run.dimension != reference.dimension) {
    note("dimension", std::to_string(run.dimension), std::to_string(reference.dimension),
         "no crack path or fields to compare, and loads and energies are of different bodies");
    return notes;
  }
  if (!has_body(run) || !has_body(reference))
    return notes;
  if (run.plane != reference.plane)
    note("plane", run.plane, reference.plane,
         "stiffness, energies and loads differ by that already");
  if (run.dimension == 2 && differ(run.thickness, reference.thickness))
    note("thickness", metres(run.thickness), metres(reference.thickness),
         "loads and energies are of different bodies");
  if (differ(run.size, reference.size))
    note("specimen size", metres(run.size), metres(reference.size),
         "all figures are of different bodies");
  return notes;
}
} // namespace ligament::program
