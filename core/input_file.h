// Inputs as users name them: a file, a pipe, or "-" for standard input.
#pragma once

#include <string>

namespace ligament::core
{
/// True for a file on a disk: it lies in a folder and can be read twice. Standard input ("-"),
/// pipes and devices are none.
bool is_named_file(const std::string &path);

/// The whole input, read to its end. Throws EnvironmentError with the reason alone, such as "it is a
/// folder".
std::string read_input(const std::string &path);
} // namespace ligament::core
