// Figures of a load curve: peak, stiffness, work.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace ligament::program
{
/// A load below this share of its maximum has fallen: what comes later are rebounds.
constexpr double fallen_share = 0.1;

/// Whether the specimen has been let go rather than broken: its displacement or strain is back
/// below half of what it was `then`, at the largest load. Cycles of a test are no falls.
bool is_let_go(double extension, double then);

/// Number of values up to which the load is one: before it first falls below 10 % of the largest
/// magnitude so far, in whose direction it is measured, while the specimen is not let go.
/// Magnitudes below 10 % of the largest of all are noise and don't count. All values when it never
/// falls.
/// @param extension displacement or strain of each row against the first, NaN where unknown; may
///   be empty
std::size_t loading_rows(const std::vector<double> &load,
                         const std::vector<double> &extension = {});

/// Index of the largest magnitude of the first `n_rows` values; empty when none is above 0.
std::optional<std::size_t> largest_index(const std::vector<double> &load, std::size_t n_rows);

/// Of the whole loading, see loading_rows().
inline std::optional<std::size_t> peak_index(const std::vector<double> &load,
                                             const std::vector<double> &extension = {})
{
  return largest_index(load, loading_rows(load, extension));
}

/// Slope of `load` over `displacement` by least squares over the first rise of the load from 10 %
/// to 50 % of load[peak]; stress over mean strain gives Pa. Empty with fewer than three points,
/// without spread, or when the line misses the points by more than 2 % of the largest load among
/// them in the mean square.
std::optional<double> fit_stiffness(const std::vector<double> &displacement,
                                    const std::vector<double> &load, std::size_t peak);
inline std::optional<double> fit_stiffness(const std::vector<double> &displacement,
                                           const std::vector<double> &load)
{
  const auto peak = peak_index(load);
  return peak ? fit_stiffness(displacement, load, *peak) : std::nullopt;
}
} // namespace ligament::program
