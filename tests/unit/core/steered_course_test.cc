// A steered course: no jump where it turns, an integral that is exact, all copies alike.
#include "core/check.h"
#include "core/time_function.h"

#include <gtest/gtest.h>

using namespace ligament::core;

namespace
{
TEST(SteeredCourse, RunsStraightFromCornerToCorner)
{
  SteeredCourse course;
  EXPECT_EQ(course.value(3), 0);
  course.turn(1, 0.5);
  course.turn(3, -0.25);
  // 0 to 1, then to 1 at 3, then down; the area under it by hand.
  EXPECT_DOUBLE_EQ(course.value(3), 1);
  EXPECT_DOUBLE_EQ(course.value(2), 0.5);
  EXPECT_DOUBLE_EQ(course.value(5), 0.5);
  EXPECT_DOUBLE_EQ(course.integral(3), 1);
  EXPECT_DOUBLE_EQ(course.integral(2), 0.25);
  EXPECT_DOUBLE_EQ(course.integral(5), 1 + 2 * 0.75);
  EXPECT_DOUBLE_EQ(course.rate(2.5), 0.5);
  EXPECT_DOUBLE_EQ(course.rate(3.5), -0.25);
  EXPECT_THROW(course.turn(2, 1), std::exception);
}

TEST(SteeredCourse, CopiesOfALoadFollowTheSame)
{
  const TimeFunction load{Steered()}, copy = load;
  ASSERT_NE(load.steered(), nullptr);
  EXPECT_EQ(copy.steered(), load.steered());
  load.steered()->turn(0, 2);
  EXPECT_DOUBLE_EQ(copy.value(0.5), 1);
  EXPECT_FALSE(copy.is_ramp());
  EXPECT_EQ(TimeFunction(Ramp{1}).steered(), nullptr);
}

TEST(SteeredCourse, GoesOnFromItsState)
{
  SteeredCourse course, other;
  course.turn(0.1, 0.3);
  course.turn(0.7, -1.1);
  State state;
  course.save(state, "course");
  other.load(state, "course");
  for (const double t : {0.3, 0.69, 0.7, 1.3}) {
    EXPECT_EQ(other.value(t), course.value(t));
    EXPECT_EQ(other.integral(t), course.integral(t));
  }
}
} // namespace
