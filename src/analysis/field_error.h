// Error norms between the particles of two runs.
#pragma once

#include "src/output/snapshot.h"

#include <cstdint>
#include <optional>

namespace ligament::program
{
/// Relative to the second snapshot: |difference|_2/|value|_2 and largest difference over largest
/// value, over the particles whose reference positions agree within 1e-3 d (equal positions, not
/// equal numbers: a zone and the whole specimen number their particles differently).
struct FieldError
{
  std::int64_t matched = 0;
  std::optional<double> displacement, displacement_max;
  std::optional<double> velocity, velocity_max;
};
FieldError field_error(const Snapshot &run, const Snapshot &reference);
} // namespace ligament::program
