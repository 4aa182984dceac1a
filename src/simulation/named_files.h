// The files that a scene names beside its own: a run goes on with what it began with.
#pragma once

#include "src/scene/scene.h"
#include "src/simulation/reference.h"

namespace ligament::program
{
/// Keeps checksums of the body's file and the potential's. Throws core::KeyedError where one is no
/// longer that of the run: its state belongs to another body. Particles from a file lie in the run's
/// own folder.
void keep_named_files(const Scene &scene, Reference &reference);
} // namespace ligament::program
