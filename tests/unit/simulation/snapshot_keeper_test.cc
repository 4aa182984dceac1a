// Motions at exactly the common times, whatever the steps of the run.
#include "src/simulation/snapshot_keeper.h"
#include "tests/support/small_plate.h"

#include <filesystem>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
double cubic(double t)
{
  return 0.3 - 2 * t + 5 * t * t - 1.7 * t * t * t;
}
double cubic_rate(double t)
{
  return -2 + 10 * t - 5.1 * t * t;
}

TEST(SnapshotKeeper, CubicMotionsAreExactBetweenTwoLooks)
{
  for (const int ratio : {1, 2, 4, 8}) {
    const double dt = 0.1 / ratio, t0 = 0.7, t1 = 0.8;
    const auto at = [&](double t) {
      return Motion<2>{
          t, {{{cubic(t)}, {-cubic(t)}}}, {{{cubic_rate(t - dt / 2)}, {-cubic_rate(t - dt / 2)}}}};
    };
    const double t = 0.733;
    const auto m = between(at(t0), at(t1), dt, t);
    EXPECT_EQ(m.time, t);
    EXPECT_NEAR(m.displacement[0][0], cubic(t), 1e-13);
    EXPECT_NEAR(m.displacement[1][0], -cubic(t), 1e-13);
    EXPECT_NEAR(m.velocity[0][0], cubic_rate(t), 1e-12);
  }
}

TEST(SnapshotKeeper, KeepsTheLastCommonTimesThatAreWanted)
{
  SmallBody small(small_scene());
  auto &state = small.body.zone->state;
  SnapshotKeeper<2> keeper;
  coupling::StepTime step{0, 0, 0.5};
  const double last_wanted = 150;
  for (; step.time < 200; ++step.step, step.time += step.dt) {
    for (double &u : state.displacement[0])
      u = 3 * step.time;
    for (double &v : state.velocity[0])
      v = 3;
    keeper.look(small.body, step, step.dt, step.time < last_wanted);
  }
  const RunFolder folder{"keeper"};
  folder.create();
  for (const auto &file : folder.snapshots())
    std::filesystem::remove(file);
  keeper.write(small.body, folder);
  const int last = common_time_index(last_wanted);
  for (int k = 0; k < 3; ++k) {
    const Snapshot s = read_snapshot(folder.snapshots()[k]);
    EXPECT_EQ(s.time, common_time(last - k));
    EXPECT_NEAR(s.displacement[0], 3 * s.time, 1e-10);
    EXPECT_NEAR(s.velocity[0], 3, 1e-10);
    EXPECT_EQ(s.reference[0], state.reference[0][0]);
  }
}

// Steps, a jump of equilibria 10 s apart, and steps again: what is kept lies on the motion of all.
TEST(SnapshotKeeper, JumpsInTimeAreFilledInProportion)
{
  SmallBody small(small_scene());
  auto &state = small.body.zone->state;
  const RunFolder folder{"jumps"};
  folder.create();
  coupling::StepTime step{0, 0, 0.5};
  SnapshotKeeper<2> keeper;
  const auto look = [&](double time, bool is_static, bool wanted = true) {
    step.time = time;
    step.step = long(time / step.dt);
    for (double &u : state.displacement[0])
      u = 3 * time;
    for (double &v : state.velocity[0])
      v = 3;
    if (is_static)
      keeper.look_at_equilibrium(small.body, step, wanted);
    else
      keeper.look(small.body, step, step.dt, wanted);
  };
  const auto expect_kept = [&](double until) {
    for (const auto &file : folder.snapshots())
      std::filesystem::remove(file);
    keeper.write(small.body, folder);
    const int last = common_time_index(until);
    for (int k = 0; k < 3; ++k) {
      const Snapshot s = read_snapshot(folder.snapshots()[k]);
      EXPECT_EQ(s.time, common_time(last - k));
      EXPECT_NEAR(s.displacement[0], 3 * s.time, 1e-10);
      EXPECT_NEAR(s.velocity[0], 3, 1e-10);
    }
  };
  for (double time = 0; time <= 100; time += 10)
    look(time, true);
  expect_kept(100);
  for (double time = 100; time <= 110; time += step.dt) // the first one again, as steps begin
    look(time, false);
  expect_kept(110);
  for (const double time : {110., 111., 150., 200.})
    look(time, true);
  expect_kept(200);
  for (double time = 205; time <= 220; time += step.dt) // without the state in which they begin
    look(time, false);
  expect_kept(220);

  // Steps begin where an equilibrium was looked at just before a common time.
  const double due = common_time(common_time_index(220) + 2);
  look(220.5, true);
  look(due - 0.1, true);
  for (double time = due - 0.1; time < due + 3; time += step.dt)
    look(time, false);
  expect_kept(due + 3);

  // What nobody wanted is not made up behind the jump.
  look(300, true, false);
  const double after = 400;
  for (double time = after; time < after + 2; time += step.dt)
    look(time, false);
  keeper.write(small.body, folder);
  EXPECT_LE(read_snapshot(folder.snapshots()[0]).time, 300);
}
} // namespace
