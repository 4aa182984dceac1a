// Rows, channels and warnings of runs whose time jumps; runs by steps alone know nothing of them.
#include "src/simulation/body_state.h"
#include "src/simulation/recorder.h"
#include "tests/support/small_plate.h"

#include <cmath>
#include <filesystem>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
const std::string pull = R"(/loads=[
  {"boundary": "top", "displacement": [null, 1e-3], "ramp": 1000},
  {"boundary": "bottom", "displacement": [null, 0]}])";
const std::string damped = "/damping/mass=0.01", loading = "/time/loading=static";

/// A plate at rest and its recorder; the looks choose their times.
struct Recorded
{
  Scene scene;
  SmallBody small;
  core::Timers timers;
  RunFolder folder;
  Recorder<2> recorder;
  coupling::StepTime step;

  Recorded(const std::string &path, const std::vector<std::string> &overrides)
      : scene(small_scene(std::vector<std::string>{pull, damped} + overrides)), small(scene),
        folder(make(path)),
        recorder(scene, folder, small.body, *small.log, timers, nullptr, 1000000, false)
  {
    step.dt = small.body.dt;
  }

  static RunFolder make(const std::string &path)
  {
    std::filesystem::remove_all(path);
    RunFolder folder{path};
    folder.create();
    return folder;
  }

  void look(long at)
  {
    step.step = at;
    step.time = double(at) * step.dt;
    auto bodies = small.body.bodies();
    small.body.coupler->compute_forces(bodies, step);
    EXPECT_FALSE(recorder.observe(small.body, step, 0));
  }

  /// Steps from rest.
  void advance(int n)
  {
    auto bodies = small.body.bodies();
    for (; step.step < n; ++step.step, step.time = double(step.step) * step.dt) {
      small.body.coupler->compute_forces(bodies, step);
      small.body.coupler->kick(bodies, step);
      small.body.coupler->drift(bodies, step);
    }
    look(n);
  }

  /// What finish() leaves in the record and in the history.
  RunRecord finish()
  {
    RunRecord record;
    recorder.finish(small.body, step, 0, record);
    return record;
  }
  Table history() const { return read_csv(folder.history()); }
};

// What a channel loses between two rows is in the record; what it gains ends the run there.
TEST(Recorder, TheBalanceIsLookedAtBetweenSparseRows)
{
  const std::vector<std::string> sparse = {"/output/history_interval=100000"};
  Recorded lost("lost", sparse);
  const long ratio = lost.small.body.coupler->step_ratio();
  lost.advance(int(200 * ratio));
  const double kinetic = read_ledger(lost.small.body, lost.step, 0).kinetic();
  ASSERT_GT(kinetic, 0);
  EXPECT_FALSE(lost.recorder.observe(lost.small.body, lost.step, -7 * kinetic));
  lost.look(250 * ratio);
  const EnergyLedger last = read_ledger(lost.small.body, lost.step, 0);
  const double moved = std::max({kinetic, last.kinetic(), last.external_work});
  EXPECT_NEAR(lost.finish().energy_residual.value() * moved / (7 * kinetic), 1, 0.01);
  EXPECT_EQ(lost.history().n_rows(), 2u);

  Recorded gained("gained", sparse);
  gained.advance(int(200 * ratio));
  const auto stop = gained.recorder.observe(gained.small.body, gained.step, 1e3);
  ASSERT_TRUE(stop);
  EXPECT_NE(stop->reason.find("came from nowhere"), std::string::npos) << stop->reason;
}

TEST(RecorderOfPhases, EveryEquilibriumHasARow)
{
  Recorded run("equilibria", {loading, "/output/history_interval=1000"});
  run.recorder.in_static_phase(true);
  for (const long at : {0, 100, 250, 4000})
    run.look(at);
  run.recorder.in_static_phase(false);
  for (long at = 4001; at < 4100; ++at)
    run.look(at); // the next row is due 1000 s later
  run.finish();
  const Table history = run.history();
  EXPECT_EQ(history.raw("step"), (std::vector<double>{0, 100, 250, 4000, 4099}));
  EXPECT_EQ(history.raw("static"), (std::vector<double>{1, 1, 1, 1, 0}));
}

// Behind a long jump, rows come at their interval: those jumped over are not made up for.
TEST(RecorderOfPhases, RowsThatTimeJumpedOverAreGone)
{
  Recorded run("jumped", {loading, "/output/history_interval=20"});
  run.look(0);
  const int per_row = int(std::ceil(20 / run.step.dt - 1e-6));
  const long jump = 100000;
  for (long at = jump; at <= jump + 3 * per_row; ++at)
    run.look(at);
  run.recorder.sync();
  EXPECT_EQ(run.history().raw("step"),
            (std::vector<double>{0, double(jump), double(jump + per_row),
                                 double(jump + 2 * per_row), double(jump + 3 * per_row)}));
}

// A break takes microseconds of a scene of seconds: 2000 rows in all would miss it.
TEST(RecorderOfPhases, StepsHaveARowEveryFiftyOfTheFarField)
{
  const std::vector<std::string> long_scene = {"/time/duration=1e6", "/output/history_interval=0",
                                               "/coupling/step_ratio=2"};
  Recorded run("steps", std::vector<std::string>{loading} + long_scene);
  for (long at = 0; at <= 200; at += 2)
    run.look(at);
  run.recorder.sync();
  EXPECT_EQ(run.history().raw("step"), (std::vector<double>{0, 100, 200}));

  Recorded dynamic("dynamic_steps", long_scene);
  for (long at = 0; at <= 200; at += 2)
    dynamic.look(at);
  dynamic.recorder.sync();
  EXPECT_EQ(dynamic.history().raw("step"), (std::vector<double>{0}));
}

// What settling took is what the other channels lack: the residual stays where it was.
TEST(RecorderOfPhases, SettlingIsAChannel)
{
  Recorded run("settled", {loading});
  run.look(0);
  const double before = read_ledger(run.small.body, run.step, 0).residual();
  run.small.body.settled = 2.5;
  const EnergyLedger ledger = read_ledger(run.small.body, run.step, 0);
  EXPECT_DOUBLE_EQ(ledger.residual() - before, 2.5);
  run.finish();
  EXPECT_EQ(run.history().column("settled", "J").back(), 2.5);

  Recorded dynamic("not_settled", {});
  dynamic.look(0);
  dynamic.finish();
  EXPECT_FALSE(dynamic.history().has("settled"));
  EXPECT_FALSE(dynamic.history().has("static"));
}

TEST(RecorderOfPhases, WarnsOfSettlingAboveTwoPercentOfTheWork)
{
  for (const double share : {0.019, 0.021, -0.021}) {
    SCOPED_TRACE(share);
    Recorded run("warned", {loading});
    run.advance(100);
    const double work = read_ledger(run.small.body, run.step, 0).external_work;
    ASSERT_GT(work, 0);
    run.small.body.settled = share * work;
    const RunRecord record = run.finish();
    ASSERT_EQ(record.warnings.size(), std::abs(share) > 0.02 ? 1u : 0u);
    if (!record.warnings.empty()) {
      const char *const remedy = share > 0 ? "/damping or absorbing sides" : "give slower loads";
      EXPECT_NE(record.warnings[0].text.find(remedy), std::string::npos);
      EXPECT_EQ(record.warnings[0].energy, share * work);
    }
  }
}

TEST(RecorderOfPhases, TheStateOfTheBodyHasWhatSettlingTook)
{
  SmallBody one(small_scene()), other(small_scene());
  one.body.settled = 1.25;
  give_state(take_state(one.body), other.body);
  EXPECT_EQ(other.body.settled, 1.25);
}

TEST(RecorderOfPhases, GoesOnInsideAStaticPhase)
{
  Recorded run("begun", {loading});
  run.recorder.in_static_phase(true);
  run.look(0);
  core::State state;
  run.recorder.save(state);
  Recorded again("begun_again", {loading});
  again.recorder.load(state, {}, again.small.body, 0);
  again.look(1);
  again.recorder.sync();
  EXPECT_EQ(again.history().raw("static"), (std::vector<double>{1}));
}
} // namespace
