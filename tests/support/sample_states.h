// States that tell by a number which they are.
#pragma once

#include "src/output/checkpoints.h"

#include <map>
#include <random>
#include <string>

namespace ligament::tests
{
/// Two files of different sizes, the larger one of several writes.
inline std::map<std::string, core::State> sample_states(int seed)
{
  std::mt19937_64 random(seed);
  core::State body, run;
  std::vector<std::int64_t> keys;
  for (int k = 0; k < 6000; ++k)
    keys.push_back(3 * k + seed);
  core::Table particles(keys);
  for (const char *name : {"x", "y"}) {
    std::vector<std::int64_t> words(keys.size());
    for (std::int64_t &word : words)
      word = std::int64_t(random());
    particles.add(name, words);
  }
  body.emplace("particles", particles);
  core::save_value(run, "run", "energy", 1. / seed);
  return {{"body", body}, {"run", run}};
}

/// What a checkpoint of this number keeps of earlier times: one state that the one before kept,
/// too, and a new one.
inline std::map<std::string, core::State> sample_kept(int seed)
{
  const auto number = [](int k) { return "copy_" + std::to_string(k); };
  return {{number(seed), sample_states(seed + 100).at("body")},
          {number(seed - 1), sample_states(seed + 99).at("body")}};
}

/// The same as a checkpoint takes it.
inline std::vector<program::KeptState> kept_states(int seed)
{
  std::vector<program::KeptState> kept;
  for (const auto &[name, state] : sample_kept(seed))
    kept.push_back({name, [state = state] { return state; }});
  return kept;
}
} // namespace ligament::tests
