#include "src/verification/cases.h"

namespace ligament::program
{
std::vector<Case> dynamic_cases()
{
  return {};
}
} // namespace ligament::program
