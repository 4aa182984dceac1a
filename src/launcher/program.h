// What the programs share: exit codes, and how mistakes and exceptions are told.
#pragma once

#include "core/diagnostic.h"
#include "src/launcher/command_line.h"

#include <functional>

namespace ligament::program
{
enum class ExitCode
{
  done = 0,
  wrong_input = 2,
  stopped_by_guard = 3, // or about a run that is not complete
  bad_environment = 4
};

using Dispatch = std::function<int(const CommandLine &line, int argc, char **argv)>;
/// What follows when `dispatch` threw something, after that was told.
using OnFailure = std::function<void(const std::string &message, int exit_code)>;

/// The main function of a program: reads the command line, calls `dispatch`, and turns what that
/// throws into a message on standard error, with --json into an object on standard output too, and
/// into the exit code. A standard output that takes nothing is told, too.
int run_program(int argc, char **argv, const Dispatch &dispatch, const OnFailure &on_failure = {});

/// Prints all errors of an input file and returns the exit code for wrong input.
int refuse(const CommandLine &line, const std::string &file,
           const std::vector<core::Diagnostic> &errors,
           const std::vector<core::Diagnostic> &warnings = {});
} // namespace ligament::program
