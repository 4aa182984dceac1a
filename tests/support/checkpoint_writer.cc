// A process that writes one checkpoint of sample_states(): FOLDER SEED. Ends with 0, or with 4 when
// the disk refuses.
#include "core/check.h"
#include "tests/support/sample_states.h"

#include <cstdio>
#include <cstdlib>

int main(int argc, char **argv)
{
  using namespace ligament;
  if (argc != 3)
    return 2;
  const int seed = std::atoi(argv[2]);
  program::CheckpointManifest manifest;
  manifest.step = seed;
  try {
    program::Checkpoints(argv[1]).write(manifest, tests::sample_states(seed),
                                        tests::kept_states(seed));
  } catch (const core::EnvironmentError &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 4;
  }
  return 0;
}
