// A figure of a body that has blown up is no figure.
#include "core/extremes.h"

#include <gtest/gtest.h>

namespace ligament
{
namespace
{
TEST(Extremes, AreNoNumberOnceOneValueIsNone)
{
  double largest = 0, smallest = 10;
  for (const double value : {5., 3., 7., 1e-15}) {
    keep_largest(largest, value);
    keep_smallest(smallest, value);
  }
  EXPECT_EQ(largest, 7);
  EXPECT_EQ(smallest, 1e-15);
  for (const double value : {double(NAN), 1e-15, 1e3}) {
    keep_largest(largest, value);
    keep_smallest(smallest, value);
  }
  EXPECT_TRUE(std::isnan(largest));
  EXPECT_TRUE(std::isnan(smallest));
}
} // namespace
} // namespace ligament
