// The built-in verification cases hold; the list finds them by name.
#include "core/check.h"
#include "src/verification/cases/stability.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

namespace ligament::program
{
namespace
{
TEST(Result, ComparesInItsDirectionAndRefusesNan)
{
  Result most{"a", 1, 1, {}};
  EXPECT_TRUE(most.passed());
  most.value = 1.01;
  EXPECT_FALSE(most.passed());
  most.value = NAN;
  EXPECT_FALSE(most.passed());
  Result least{"a", 1, 1, {}, Result::Bound::at_least};
  EXPECT_TRUE(least.passed());
  least.value = 0.99;
  EXPECT_FALSE(least.passed());
  least.value = NAN;
  EXPECT_FALSE(least.passed());
}

TEST(Cases, AreFoundByNameAndPrefix)
{
  std::set<std::string> names;
  for (const auto &c : all_cases())
    EXPECT_TRUE(names.insert(c.name).second) << c.name;
  for (const auto &c : select_cases("", false))
    EXPECT_FALSE(c.slow) << c.name;
  EXPECT_EQ(select_cases("", true).size(), names.size());

  ASSERT_EQ(select_cases("drift_long", false).size(), 1u);
  EXPECT_TRUE(select_cases("drift_long", false)[0].slow);
  for (const auto &c : select_cases("patch_", true))
    EXPECT_EQ(c.name.rfind("patch_", 0), 0u);
  EXPECT_LT(select_cases("patch_", false).size(), select_cases("patch_", true).size());
  for (const auto &c : select_stability(false))
    EXPECT_EQ(c.name.find("_long"), std::string::npos) << c.name;
  EXPECT_LT(select_stability(false).size(), select_stability(true).size());
  EXPECT_THROW(select_cases("nothing", false), core::InputError);
  EXPECT_THROW(select_cases("patch_ring_3", false), core::InputError); // only a slow one
}

class VerifyCase : public testing::TestWithParam<const char *>
{
};

TEST_P(VerifyCase, Holds)
{
  for (const auto &c : select_cases(GetParam(), false)) {
    const auto results = c.run();
    EXPECT_FALSE(results.empty()) << c.name;
    for (const auto &result : results)
      EXPECT_TRUE(result.passed())
          << result.name << ": " << result.value << ", must " << result.must;
  }
}

INSTANTIATE_TEST_SUITE_P(Default, VerifyCase,
                         testing::Values("moduli", "rotation", "patch_band_2d", "patch_ring_2d",
                                         "patch_band_3d", "critical_step", "drift", "drift_3d",
                                         "decay", "lab_shapes", "lab_kirsch", "lab_periodic",
                                         "lab_ring_short"));

/// What the trust card shows, but for what docs/verification.md lists as missed, which may not get
/// worse than it says there.
TEST(VerifyCase, SlowDefaultSetHolds)
{
  const std::map<std::string, double> missed = {{"atoms_strain/lennard_jones/nodes_5", 3.25e-3}};
  for (const auto &c : select_cases("", false)) {
    const auto results = c.run();
    EXPECT_FALSE(results.empty()) << c.name;
    for (const auto &result : results)
      if (const auto known = missed.find(result.name); known != missed.end())
        EXPECT_LE(result.value, known->second) << result.name;
      else
        EXPECT_TRUE(result.passed())
            << result.name << ": " << result.value << ", must " << result.must;
  }
}
} // namespace
} // namespace ligament::program
