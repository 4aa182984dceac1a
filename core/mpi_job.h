// The ranks of an MPI job: the one place that knows MPI's calls.
#pragma once

#include "core/ranks.h"

namespace ligament::core
{
/// Begins MPI and ends it. A process that is one by itself needs none.
class MpiJob
{
public:
  /// Ranks that wait for a message let other processes run meanwhile. Throws core::EnvironmentError
  /// where MPI doesn't start.
  MpiJob();
  ~MpiJob();
  MpiJob(const MpiJob &) = delete;
  MpiJob &operator=(const MpiJob &) = delete;

  /// All of the job. They may be used as long as it lives. MPI counts in ints: longer messages are
  /// sent in pieces of so many bytes.
  Ranks ranks(std::size_t longest_piece = 1 << 30) const;
};
} // namespace ligament::core
