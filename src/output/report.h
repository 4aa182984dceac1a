// The report of a run: one HTML file with pictures, curves and tables in it, printable.
#pragma once

#include <string>

namespace ligament::program
{
/// Writes report.html into the output folder from the files that lie there and returns its path.
/// InputError when the folder holds no run.
std::string write_report(const std::string &run_folder);
} // namespace ligament::program
