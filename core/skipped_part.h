// A part of the program that a run does not need, and why: what log and record say of it.
#pragma once

#include <string>

namespace ligament::core
{
struct SkippedPart
{
  std::string what, why;
};
} // namespace ligament::core
