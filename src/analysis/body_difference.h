// In what the bodies of two runs differ, so that their figures are not of one problem.
#pragma once

#include "src/output/run_record.h"

#include <string>
#include <vector>

namespace ligament::program
{
/// One note per key: dimension, plane, thickness, specimen size. Across dimensions nothing but that
/// is said: the other keys mean something else there. The names are those of the runs.
std::vector<std::string> body_differences(const RunRecord &run, const std::string &run_name,
                                          const RunRecord &reference,
                                          const std::string &reference_name);
} // namespace ligament::program
