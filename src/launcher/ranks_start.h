// Starts the solver on several ranks of this machine, and stays as their parent.
#pragma once

#include "src/launcher/command_line.h"

namespace ligament::program
{
/// Runs the solver with the same arguments as line.ranks ranks under mpirun, and waits. Signals
/// that ask this process to end (SIGINT, SIGTERM, SIGHUP, SIGUSR1) reach the ranks as SIGUSR1,
/// which mpirun hands on: they end in good order; a second one ends them at once. Should this
/// process be killed, so are they. Returns the exit code of the ranks, 128 + signal where they
/// ended for one; says why where that has left nobody to say so. Throws core::EnvironmentError
/// where mpirun can't be started or ends by itself.
int run_on_ranks(const CommandLine &line, int argc, char *const *argv);
} // namespace ligament::program
