// The dress of the HTML pages: one file each, no scripts, fit for print.
#pragma once

#include <string>
#include <vector>

namespace ligament::program
{
/// A whole page around `body`; the title is escaped, the body is not.
std::string html_page(const std::string &title, const std::string &body);

/// A table with the first column to the left and numbers to the right; all texts are escaped.
std::string html_table(const std::vector<std::string> &head,
                       const std::vector<std::vector<std::string>> &rows);
} // namespace ligament::program
