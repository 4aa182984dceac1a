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
} // namespace
