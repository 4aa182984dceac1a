// What of a scene several ranks can't compute together.
#pragma once

#include "src/scene/read_scene.h"

namespace ligament::program
{
/// An error for each part of a sound scene that one process alone can compute; empty: bodies of
/// particles in parts have all that the scene asks for (docs/theory.md section 5.7).
std::vector<core::Diagnostic> refused_on_ranks(const ReadResult &input);
} // namespace ligament::program
