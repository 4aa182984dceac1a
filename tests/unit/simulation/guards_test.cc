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

// More heat than the work that there was to make it of.
TEST(Guards, FlowThatGivesEnergyEndsARun)
{
  const SmallBody small(small_scene());
  EnergyLedger ledger;
  ledger.body.potential_discrete = -1;
  ledger.force.plastic = 6;
  ledger.external_work = 5;
  EXPECT_NEAR(ledger.residual(), 0, 1e-15);
  EXPECT_TRUE(find_broken_balance(ledger, 5, small.body));
  EXPECT_FALSE(find_broken_balance(ledger, 20, small.body)); // loaded faces
  ledger.force.plastic = 0;
  ledger.external_work = -1;
  EXPECT_FALSE(find_broken_balance(ledger, 5, small.body)) << "nothing flows";
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
