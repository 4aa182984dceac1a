// Figures of a load curve: peak, stiffness, work.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace ligament::program
{
/// Index of the largest value in the direction of loading, which is the sign of the mean load;
/// empty for an empty or all-zero curve.
std::optional<std::size_t> peak_index(const std::vector<double> &load);

/// Slope of `load` over `displacement` by least squares over the points before the peak whose load
/// lies between 10 % and 50 % of it; stress over mean strain gives Pa. Empty with fewer than three
/// points or no spread.
std::optional<double> fit_stiffness(const std::vector<double> &displacement,
                                    const std::vector<double> &load);

/// Largest magnitude of the residual over the largest external work; empty without work.
std::optional<double> relative_residual(const std::vector<double> &residual,
                                        const std::vector<double> &external_work);
} // namespace ligament::program
