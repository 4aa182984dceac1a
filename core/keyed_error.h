// A mistake in the input that only the set-up sees, told like those that reading finds.
#pragma once

#include "core/check.h"

namespace ligament::core
{
/// What a Diagnostic needs but the place, which follows from the key (core/diagnostic.h).
struct KeyedError : InputError
{
  KeyedError(std::string key, std::string message, std::string reason, std::string remedy);
  std::string key; // JSON pointer
  std::string message, reason, remedy;
};

/// Takes a text apart that the lower layers wrote, who know no scene: "finding: reason; remedy",
/// "finding; remedy" or "finding: remedy", perhaps behind "/key: ". Without that the key is the
/// first one that the text names, else the one given here, as is the remedy where the text has
/// none.
KeyedError keyed(const std::string &text, const std::string &key, const std::string &remedy);

/// Calls f(); a mistake in there is about this key unless it names another one.
template <typename F>
auto at_key(const std::string &key, const std::string &remedy, F &&f)
{
  try {
    return f();
  } catch (const KeyedError &) {
    throw;
  } catch (const InputError &error) {
    throw keyed(error.what(), key, remedy);
  }
}
} // namespace ligament::core
