// Numbers too small for full precision become zero: waves decay into them ahead of their front, and
// arithmetic with them is slow.
#pragma once

namespace ligament::core
{
/// For the calling thread and those that it starts afterwards; nothing where the processor has no
/// such mode.
void flush_denormals();
} // namespace ligament::core
