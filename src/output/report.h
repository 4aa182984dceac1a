// The report of a run: one HTML file with pictures, curves and tables in it, printable.
#pragma once

#include <string>
#include <vector>

namespace ligament::program
{
/// Writes report.html into the output folder from the files that lie there and returns its path.
/// `fields` (words of shown_field()) are drawn anew from the states that the run kept and stand in
/// place of its own pictures. InputError when the folder holds no run, or for another word.
std::string write_report(const std::string &run_folder,
                         const std::vector<std::string> &fields = {});
} // namespace ligament::program
