// GoogleTests that all ranks of a job run together.
#pragma once

#include "core/ranks.h"

namespace ligament::test
{
/// Those that the test's main() has begun (tests/support/ranks_main.cc).
const core::Ranks &ranks();
} // namespace ligament::test
