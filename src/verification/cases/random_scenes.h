// Scenes drawn at random, computed and held to what must be true of any.
#pragma once

#include "src/verification/cases.h"

namespace ligament::program
{
/// The scenes of "17" or "1:1000"; InputError for other words. One scene: its files and runs are
/// kept in `folder` ("random_scene_17-out" when it is empty) and its figures printed. Several:
/// results.jsonl in `folder` ("random_scenes-out") grows scene by scene, and what it holds is not
/// computed again.
Case select_random_scenes(const std::string &seeds, const std::string &folder);
} // namespace ligament::program
