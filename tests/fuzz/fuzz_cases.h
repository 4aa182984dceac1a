// Many cases, one after the other, each from a seed of its own that is named where it fails.
#pragma once

#include "tests/fuzz/draw.h"

#include <functional>

namespace ligament::fuzz
{
/// Runs `one_case` with the seeds that follow from `first_seed`: n of them, or with
/// LIGAMENT_FUZZ_SEED that one alone. Stops at the first case that fails. Whatever escapes as an
/// exception is a failure. A case that crashes or takes more than 20 s of processor time ends the
/// process, once its seed is written.
void run_cases(std::uint64_t first_seed, int n, const std::function<void(Draw &)> &one_case);

/// The same for a time: `seconds`, or those of LIGAMENT_FUZZ_SECONDS, with other seeds each day.
void run_cases_for(double seconds, const std::function<void(Draw &)> &one_case);

/// Writes what is read now, to be shown where the case fails.
void note_document(const std::string &text);

/// Writes a file for as long as it lives.
class File
{
public:
  File(std::string name, const std::string &text);
  ~File();
  File(const File &) = delete;
  File &operator=(const File &) = delete;
  const std::string &name() const { return name_; }

private:
  const std::string name_;
};
} // namespace ligament::fuzz
