// The run of a scene in its open folder, from the start or from a checkpoint.
#pragma once

#include "core/interruption.h"
#include "core/ranks.h"
#include "src/output/checkpoints.h"
#include "src/output/open_run.h"
#include "src/scene/read_scene.h"
#include "src/simulation/end_request.h"

#include <functional>

namespace ligament::program
{
/// What the record says before the body is built.
RunRecord first_record(const Scene &scene, const core::Ranks &ranks);

struct RunOptions
{
  EndRequest end_request;
  Checkpoint *from = nullptr;       // where it goes on; its states are used up
  int rebuild_interval = 0;         // see Simulation::rebuild_every; 0: never
  core::Ranks ranks = {};           // that compute it together
  bool in_pieces = false;           // each writes the fields of its particles
  bool json = false;                // an end during the set-up prints an object, too
  /// Of the first rank: what of an older run makes way, once all ranks have set up.
  std::function<void()> make_way = {};
};

/// The scene of a run, which stays where it goes on until that has been set up.
void write_resolved(const ReadResult &input, const RunFolder &folder);

/// With checkpoints; what stops it is in its record, and warnings in its log.
RunRecord simulate(const ReadResult &input, const std::vector<std::string> &warnings, OpenRun &run,
                   core::Interruption &interruption, const RunOptions &options);

/// The same on all ranks but the first, which write nothing. Returns what a rank ends with.
int follow(const ReadResult &input, const RunFolder &folder, core::Interruption &interruption,
           const RunOptions &options);
} // namespace ligament::program
