// GoogleTests that all ranks of a job run together.
#pragma once

#include "core/ranks.h"

namespace ligament::test
{
/// Those that the test's main() has begun (tests/support/ranks_main.cc).
const core::Ranks &ranks();
/// The same ones, which send what is longer than this in pieces (bytes).
core::Ranks ranks_in_pieces(std::size_t longest);
} // namespace ligament::test
