// When energy that comes from nowhere ends a run.
#include "src/simulation/guards.h"
#include "tests/support/small_plate.h"

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
TEST(Guards, EnergyOutOfNothingEndsARun)
{
  const SmallBody small(small_scene());
  EnergyLedger ledger;
  EXPECT_FALSE(find_broken_balance(ledger, 0, small.body));
  ledger.body.potential_far = 1;
  EXPECT_TRUE(find_broken_balance(ledger, 0, small.body));
  EXPECT_FALSE(find_broken_balance(ledger, 10, small.body));
  ledger.body.potential_far = NAN;
  EXPECT_TRUE(find_broken_balance(ledger, 10, small.body));
}

// In the first step of the far field under a traction that has just risen the term of the impulses
// is all there is.
TEST(Guards, ImpulsesOfALoadThatRisesAreNoGain)
{
  const SmallBody small(small_scene());
  EnergyLedger ledger;
  ledger.body.impulses = 1;
  EXPECT_FALSE(find_broken_balance(ledger, 0, small.body));
  ledger.body.kinetic_far = 3; // beside what the impulses explain
  EXPECT_TRUE(find_broken_balance(ledger, 0, small.body));
}
} // namespace
