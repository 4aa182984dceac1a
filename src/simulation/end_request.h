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
  core::Interruption *interruption = nullptr;
  using Time = std::chrono::steady_clock::time_point;
  std::optional<Time> deadline = {}; // of the time loop
  std::optional<Time> limit = {};    // of the run, from when on no picture is begun

  /// The signal that asks; 0: none does.
  int signal() const { return interruption ? interruption->signal() : 0; }
  void hear_of(int signal) const
  {
    if (interruption && signal != 0)
      interruption->hear_of(signal);
  }
  bool is_late() const { return deadline && std::chrono::steady_clock::now() >= *deadline; }
  /// Who asks, in a word; empty: nobody.
  static std::string reason(int signal, bool is_late)
  {
    return signal != 0 ? core::Interruption::name(signal) : is_late ? "--wall-time" : "";
  }
};
} // namespace ligament::program
