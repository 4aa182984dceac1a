// What may ask a run to end before its time: a signal, or a limit of wall time.
#pragma once

#include "core/interruption.h"

#include <chrono>
#include <optional>
#include <string>

namespace ligament::program
{
struct EndRequest
{
  const core::Interruption *interruption = nullptr;
  std::optional<std::chrono::steady_clock::time_point> deadline = {}; // of the time loop

  /// Who asks, in a word; empty: nobody.
  std::string reason() const
  {
    if (interruption && interruption->signal() != 0)
      return core::Interruption::name(interruption->signal());
    if (deadline && std::chrono::steady_clock::now() >= *deadline)
      return "--wall-time";
    return {};
  }
};
} // namespace ligament::program
