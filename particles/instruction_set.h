// Which of the compiled instruction sets this processor runs: other ones give other last bits.
#pragma once

#include <string>

namespace ligament::particles
{
/// "AVX2", "AVX3", "SSE2", ...
std::string instruction_set();
} // namespace ligament::particles
