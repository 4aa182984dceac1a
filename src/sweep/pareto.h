// Which points of a cost-error diagram are worth choosing.
#pragma once

#include <cstddef>
#include <vector>

namespace ligament::program
{
/// Indices of the points that no other one beats: none has at most the same cost and at most the
/// same error, and less of one of them. By rising cost; of equal points the first one. Points that
/// are not finite take no part.
std::vector<std::size_t> pareto_front(const std::vector<double> &cost,
                                      const std::vector<double> &error);
} // namespace ligament::program
