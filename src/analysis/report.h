// The report of a run: one HTML file with pictures, curves and tables in it, printable.
#pragma once

#include <string>
#include <vector>

namespace ligament::program
{
/// Writes report.html from the files of the run into `target`, which is made if need be (empty: the
/// folder of the run), and returns its path. `fields` (words of shown_field()) are drawn anew from
/// the states that the run kept and stand in place of its own pictures. InputError when the first
/// folder holds no run, or for another word; EnvironmentError when the disk refuses.
std::string write_report(const std::string &run_folder, const std::vector<std::string> &fields = {},
                         const std::string &target = "");
} // namespace ligament::program
