// Hands over to the programs beside this one that compute: they take long to load, and to build.
#pragma once

#include <string>

namespace ligament::program
{
/// Path of the solver, beside this program. Throws core::EnvironmentError where it cannot be
/// started.
std::string solver_path();

/// Replaces this process by the solver with the same arguments; returns only by an exception.
/// Throws core::EnvironmentError when the solver cannot be started.
[[noreturn]] void start_solver(int argc, char *const *argv);

/// The same by the program of the verification cases.
[[noreturn]] void start_verification(int argc, char *const *argv);

/// Lets standard input of this process, and of the solver that replaces it, hold this text: what
/// came through a pipe can be read only once. Throws core::EnvironmentError.
void refill_standard_input(const std::string &text);

/// How many processes mpirun or srun has started beside this one, by the variables that they set; 1
/// without them.
int launched_ranks();
/// Their names, for messages.
std::string launch_variables();

/// Throws core::InputError where mpirun or srun has started several for a command that needs one.
void require_one_rank(const std::string &command);
} // namespace ligament::program
