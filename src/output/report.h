// The report of a run: one HTML file with pictures, curves and tables in it, printable.
#pragma once

#include <string>

namespace ligament::program
{
/// Writes report.html from the files of the run into `folder`, which is made if need be, and returns
/// its path. InputError when the first folder holds no run, EnvironmentError when the disk refuses.
std::string write_report(const std::string &run_folder, const std::string &folder);
inline std::string write_report(const std::string &run_folder)
{
  return write_report(run_folder, run_folder);
}
} // namespace ligament::program
