// Steps of a run and where it stands.
#pragma once

#include "coupling/coupler.h"

namespace ligament::program
{
struct Clock
{
  coupling::StepTime now;
  long n_steps = 0;

  bool is_at_end() const { return now.step >= n_steps; }
  void advance(long steps = 1)
  {
    now.step += steps;
    now.time = double(now.step) * now.dt;
  }
};
} // namespace ligament::program
