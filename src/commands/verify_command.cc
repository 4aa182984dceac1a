#include "src/commands/commands.h"

#include "core/check.h"

namespace ligament::program
{
int verify_command(const CommandLine &)
{
  throw core::InputError("no case");
}
} // namespace ligament::program
