// The pictures of a run: its kept states, each in the chosen fields.
#pragma once

#include "src/drawing/field_view.h"
#include "src/output/run_folder.h"
#include "src/output/run_record.h"

#include <chrono>
#include <optional>

namespace ligament::program
{
using PictureTime = std::chrono::steady_clock::time_point;

/// One picture per field and state, pictures/STATE_FIELD.png: all states of a field with the same
/// range of colours, all with this factor on displacements. A disk that refuses is an
/// EnvironmentError, or with `missing` a reason there for each picture that is not to be had; none
/// is begun after `until`.
std::vector<PictureEntry>
write_pictures(const RunFolder &folder, const std::vector<const BodyState *> &states,
               const std::vector<std::string> &fields, int dimension, double magnification,
               std::vector<std::string> *missing = nullptr, std::optional<PictureTime> until = {});

/// The same of a run that has ended, in the folder `target`: the states that it kept, with its
/// magnification.
std::vector<PictureEntry> write_pictures(const RunFolder &folder, const RunRecord &record,
                                         const std::vector<std::string> &fields,
                                         const RunFolder &target);

/// A state that the run kept, from its files; InputError when one is missing or damaged.
BodyState read_state(const RunFolder &folder, const StateEntry &entry);
} // namespace ligament::program
