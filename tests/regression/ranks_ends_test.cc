// How jobs of several ranks end: by signals, guards and errors, with all ranks and a reason.
#include "tests/support/faulty_disk.h"
#include "tests/support/rank_runs.h"

#include <csignal>
#include <thread>

using namespace ligament;
using namespace ligament::tests;

namespace
{
const std::string program = LIGAMENT_PROGRAM;

class RanksEnds : public OnRanks
{
};

/// Ends only when it is asked to.
Json without_end()
{
  Json scene = scene_of(2, "hexagonal", {40, 60});
  pull(scene, 1, 1, 4e-4);
  scene["time"]["duration"] = 1e5;
  return scene;
}

/// Until the run is well under way.
void wait_for_rows(const std::string &run)
{
  const std::string history = run + "/history.csv";
  std::error_code none;
  while (!fs::exists(history, none) || fs::file_size(history, none) < 4000)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

// A signal to the program that users started ends all ranks in good order; they can go on.
TEST_F(RanksEnds, ASignalEndsAllInGoodOrder)
{
  written(without_end(), "scene.json");
  for (const int signal : {SIGTERM, SIGUSR1}) { // schedulers send the second one ahead of an end
    const std::string out = "out_" + std::to_string(signal);
    Process process("exec " + program + " run scene.json -n 2 -o " + out);
    wait_for_rows(out);
    process.send(signal);
    EXPECT_EQ(process.wait().code, 128 + signal);
    EXPECT_EQ(file_json(out + "/run.json")["status"], "interrupted");
    EXPECT_FALSE(newest_checkpoint(out).empty());
  }
}

/// The solvers that run this scene.
std::vector<pid_t> solvers_of(const std::string &scene)
{
  std::vector<pid_t> found;
  std::error_code none;
  for (const auto &entry : fs::directory_iterator("/proc", none)) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != name.npos)
      continue;
    std::string words = file_text(entry.path() / "cmdline");
    words = words.substr(0, words.find(std::string("--quiet"))); // mpirun has no more to say
    if (words.find("ligament-solver") != words.npos && words.find(scene) != words.npos)
      found.push_back(std::stoi(name));
  }
  return found;
}

// Killed, it leaves nobody behind.
TEST_F(RanksEnds, NobodyOutlivesTheProgram)
{
  const std::string name = written(without_end(), "orphans_of_nobody.json");
  Process process("exec " + program + " run " + name + " -n 2 -o out");
  wait_for_rows("out");
  EXPECT_EQ(solvers_of(name).size(), 2u);
  process.send(SIGKILL);
  process.wait();
  for (int k = 0; k < 100 && !solvers_of(name).empty(); ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(solvers_of(name).size(), 0u);
}

// A scheduler may ask any of them.
TEST_F(RanksEnds, ASignalToOneRankEndsAllInGoodOrder)
{
  const std::string name = written(without_end(), "one_is_asked.json");
  Process process("exec " + program + " run " + name + " -n 3 -o out");
  wait_for_rows("out");
  const auto solvers = solvers_of(name);
  ASSERT_EQ(solvers.size(), 3u);
  kill(solvers.back(), SIGTERM);
  EXPECT_EQ(process.wait().code, 128 + SIGTERM);
  EXPECT_EQ(file_json("out/run.json")["status"], "interrupted");
  EXPECT_FALSE(newest_checkpoint("out").empty());
}

// Nor does one rank that is killed leave the others waiting.
TEST_F(RanksEnds, AKilledRankEndsAll)
{
  const std::string name = written(without_end(), "one_is_killed.json");
  Process process("exec " + program + " run " + name + " -n 3 -o out");
  wait_for_rows("out");
  const auto solvers = solvers_of(name);
  ASSERT_EQ(solvers.size(), 3u);
  const auto killed_at = std::chrono::steady_clock::now();
  kill(solvers.back(), SIGKILL);
  const Outcome outcome = process.wait();
  EXPECT_EQ(outcome.code, 128 + SIGKILL);
  for (const char *part : {"a rank was ended by signal 9", "`ligament resume out` goes on"})
    EXPECT_NE(outcome.errors.find(part), std::string::npos) << outcome.errors;
  EXPECT_LT(std::chrono::steady_clock::now() - killed_at, std::chrono::seconds(10)); // documented
  EXPECT_EQ(solvers_of(name).size(), 0u);
  const auto record = file_json("out/run.json");
  EXPECT_EQ(record["status"], "failed");
  EXPECT_NE(std::string(record["reason"]).find("signal 9"), std::string::npos) << record["reason"];
}

// What only the first rank finds ends the others, too.
TEST_F(RanksEnds, AFolderThatCannotBeOneEndsAll)
{
  Json scene = scene_of(2, "hexagonal", {20, 20});
  pull(scene, 1, 1, 4e-4);
  written(scene, "scene.json");
  std::ofstream("out") << "a file";
  const Outcome outcome = run_ligament("run scene.json -n 3 -o out");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.errors.find("out is a file"), std::string::npos) << outcome.errors;
}

/// From one corner on it is strained beyond all that its law and its steps bear.
Json torn_at_a_corner()
{
  Json scene = scene_of(2, "hexagonal", {30, 40});
  scene["material"]["fracture"] = {{"criterion", "none"}};
  scene["loads"] = {
      {{"boundary", "right"}, {"velocity", {1, nullptr}}, {"ramp", 100}, {"from", 17}},
      {{"boundary", "left"}, {"displacement", {0, nullptr}}}};
  return scene;
}

/// What a guard finds ends all ranks, in the step in which it would end one process. The
/// checkpoints are of sound motion; who goes on from one comes to the same end.
void expect_one_end(const Json &scene, const std::string &words)
{
  const std::string name = written(scene, "guarded.json"),
                    within = "exec timeout -k 5 60 " + program;
  std::vector<nlohmann::json> records;
  for (const int n : {1, 3}) {
    const std::string run = "on_" + std::to_string(n);
    fs::remove_all(run);
    const Outcome outcome =
        run_shell(within + " run " + name + " -n " + std::to_string(n) + " -o " + run);
    EXPECT_EQ(outcome.code, 3) << outcome.errors;
    EXPECT_EQ(solvers_of(name).size(), 0u);
    const auto record = records.emplace_back(file_json(run + "/run.json"));
    EXPECT_EQ(record["status"], "stopped");
    EXPECT_EQ(record["ranks"], n);
    EXPECT_NE(std::string(record["reason"]).find(words), std::string::npos) << record["reason"];
    ASSERT_FALSE(newest_checkpoint(run).empty());
    const auto manifest = file_json(newest_checkpoint(run) + "/manifest.json");
    EXPECT_LT(manifest["step"], record["steps"]);
  }
  for (const char *key : {"reason", "steps", "trusted_until", "external_work", "energy_residual"})
    EXPECT_EQ(records[0][key], records[1][key]) << key;
  const Outcome more = run_shell(within + " resume on_3 -n 2");
  EXPECT_EQ(more.code, 3) << more.errors;
  const auto record = file_json("on_3/run.json");
  EXPECT_EQ(record["reason"], records[0]["reason"]);
  EXPECT_EQ(record["ranks"], 2);
}

TEST_F(RanksEnds, AGuardOfTheEnergyEndsAllInTheSameStep)
{
  expect_one_end(torn_at_a_corner(), "came from nowhere");
}

TEST_F(RanksEnds, AGuardOfTheMotionEndsAllInTheSameStep)
{
  Json scene = torn_at_a_corner();
  scene["output"]["history_interval"] = 1000; // no look at the energy comes first
  expect_one_end(scene, "spacings in one step");
}

// Before the first step: all ranks find the same stable one.
TEST_F(RanksEnds, AStepAboveTheStableOneIsRefusedByAll)
{
  const std::string name = written(halves_that_slide(), "scene.json");
  std::vector<std::string> errors;
  for (const char *n : {"1", "3"}) {
    const Outcome outcome =
        run_ligament("run " + name + " --set /time/step=5 -n " + n + " -o on_" + n);
    EXPECT_EQ(outcome.code, 2);
    errors.push_back(outcome.errors);
  }
  EXPECT_NE(errors[0].find("of the stable step of"), std::string::npos) << errors[0];
  EXPECT_EQ(errors[0], errors[1]);
}

// What a later rank alone finds wrong, while the others wait for it in a message: the job ends,
// when it would have ended had all found it, and 10 s later at most (documented).
TEST_F(RanksEnds, AnErrorOfOneRankEndsAllWithItsReason)
{
  using Clock = std::chrono::steady_clock;
  const std::string name = written(halves_that_slide(), "wrong_on_one.json"),
                    run = program + " run " + name + " -o out", wrong = run + " --set /time/step=5",
                    start = "exec mpirun -q --oversubscribe -n ";
  const auto all_begin = Clock::now();
  EXPECT_EQ(run_shell(start + "3 " + wrong).code, 2);
  const auto alone_begin = Clock::now();
  const Outcome outcome = run_shell(start + "2 " + run + " : -n 1 " + wrong);
  EXPECT_LT(Clock::now() - alone_begin, alone_begin - all_begin + std::chrono::seconds(10));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.errors.find("of the stable step of"), std::string::npos)
      << outcome.errors;
  EXPECT_EQ(solvers_of(name).size(), 0u);
  const auto record = file_json("out/run.json"); // the first rank could not say so
  EXPECT_EQ(record["status"], "failed");
  EXPECT_EQ(std::string(record["reason"]).rfind("rank 2: ", 0), 0u) << record["reason"];
}

// The first rank alone writes what is kept from near the peak, while others send more of it.
TEST_F(RanksEnds, ADiskThatRefusesTheLastFilesIsAFailedRun)
{
  const std::string name = written(halves_that_slide(), "scene.json"),
                    out = fs::absolute("out").string();
  const Outcome outcome = run_shell(
      "exec env FAULTY_DISK_FOLDER=" + out + "/snapshot_0 FAULTY_DISK_ACTION=fail_on" +
      " FAULTY_DISK_CALL=1 FAULTY_DISK_ERROR=" + std::to_string(ENOSPC) + " " + with_faulty_disk() +
      "timeout -k 5 60 " + program + " run " + name + " -n 3 -o " + out);
  EXPECT_EQ(outcome.code, 4) << outcome.errors;
  const auto record = file_json("out/run.json");
  EXPECT_EQ(record["status"], "failed");
  EXPECT_NE(std::string(record["reason"]).find("snapshot_0"), std::string::npos)
      << record["reason"];
  for (const char *file : {"out/snapshot_1.bin", "out/snapshot_2.bin", "out/broken_bonds.csv"})
    EXPECT_TRUE(fs::exists(file)) << file;
}

// What comes through a pipe only one rank can read.
TEST_F(RanksEnds, ASceneOnStandardInputIsRefused)
{
  Json scene = scene_of(2, "hexagonal", {20, 20});
  pull(scene, 1, 1, 4e-4);
  written(scene, "scene.json");
  ASSERT_EQ(run_ligament("run scene.json -o done").code, 0);
  for (const std::string &how :
       {"mpirun -q -n 2 --oversubscribe " + program + " run - -o out",
        program + " run - -n 2 -o out", program + " resume done -n 2 --scene -"})
  {
    const Outcome outcome = run_shell("exec timeout -k 5 60 " + how + " < scene.json");
    EXPECT_EQ(outcome.code, 2) << how;
    EXPECT_NE(outcome.errors.find("reach the first rank alone"), std::string::npos)
        << outcome.errors;
  }
}

/// A small body that is soon computed.
std::string soon_done()
{
  Json scene = scene_of(2, "hexagonal", {20, 20});
  pull(scene, 1, 1, 4e-4);
  return written(scene, "scene.json");
}

// It belongs to the next command of a script.
TEST_F(RanksEnds, StandardInputIsLeftAlone)
{
  soon_done();
  std::ofstream("lines") << "one\ntwo\n";
  const Outcome outcome =
      run_shell("(" + program + " run scene.json -n 2 -o out && cat > rest) < lines");
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_EQ(file_text("rest"), "one\ntwo\n");
}

// mpirun itself says nothing then.
TEST_F(RanksEnds, AnMpirunThatCannotStartRanksIsAMatterOfTheEnvironment)
{
  soon_done();
  const Outcome outcome =
      run_shell("TMPDIR=/proc exec " + program + " run scene.json -n 2 -o out --json");
  EXPECT_EQ(outcome.code, 4);
  EXPECT_NE(outcome.errors.find("TMPDIR, or /tmp, can be written"), std::string::npos)
      << outcome.errors;
  EXPECT_EQ(outcome.json()["status"], "failed");
}

// One number of ranks counts, and all of them compute together.
TEST_F(RanksEnds, RanksThatAreNotWhatWasAskedForAreRefused)
{
  soon_done();
  ASSERT_EQ(run_ligament("run scene.json -o done").code, 0);
  const std::string start = "exec timeout -k 5 60 mpirun -q --oversubscribe -n ",
                    run = program + " run scene.json -o out";
  struct Case
  {
    std::string line;
    int code;
    std::string error;
  };
  for (const Case &c :
       {Case{start + "1 " + run + " -n 2", 2, "does not start another one"},
        Case{start + "1 " + program + " resume done -n 2", 2, "does not start another one"},
        Case{start + "2 " + run + " -n 3", 2, "has started 2 ranks"},
        Case{"SLURM_STEP_NUM_TASKS=4 exec " + run, 4, "of which Open MPI finds 1"}})
  {
    const Outcome outcome = run_shell(c.line);
    EXPECT_EQ(outcome.code, c.code) << c.line;
    EXPECT_NE(outcome.errors.find(c.error), std::string::npos) << outcome.errors;
    EXPECT_FALSE(fs::exists("out")) << c.line;
  }
  EXPECT_EQ(run_shell(start + "2 " + run + " -n 2").code, 0);
}

// Its text of the commit is changed, in place.
TEST_F(RanksEnds, ARankOfAnotherBuildIsRefused)
{
  soon_done();
  const std::string solver = (fs::path(program).parent_path() / "ligament-solver").string(),
                    version = run_ligament("--version").output,
                    commit = version.substr(version.find("commit ") + 7, 8);
  std::string other = file_text(solver);
  int n_found = 0;
  for (auto at = other.find(commit); at != other.npos; at = other.find(commit, at + 1), ++n_found)
    other.replace(at, commit.size(), "00000000");
  if (n_found == 0)
    GTEST_SKIP() << "the program doesn't hold \"" << commit << "\" in one piece";
  std::ofstream("other", std::ios::binary) << other;
  fs::permissions("other", fs::perms::owner_all);
  const Outcome outcome =
      run_shell("exec timeout -k 5 60 mpirun -q --oversubscribe -n 2 " + solver +
                " run scene.json -o out : -n 1 ./other run scene.json -o out");
  EXPECT_EQ(outcome.code, 4);
  for (const std::string part : {"ranks are unlike", "commit 00000000", "one kind of processor"})
    EXPECT_NE(outcome.errors.find(part), std::string::npos) << outcome.errors;
  EXPECT_FALSE(fs::exists("out"));
}

// Two ranks that share a core: were those that wait to keep it, each message would take a time
// slice of the system, some milliseconds; it takes as long as the other one computes.
TEST_F(RanksEnds, ARankThatWaitsMakesRoom)
{
  Json scene = scene_of(2, "hexagonal", {20, 20});
  pull(scene, 1, 1, 4e-6);
  scene["time"]["duration"] = 1000;
  scene["output"] = {{"history_interval", 500}, {"checkpoint_interval", "never"}};
  const std::string run =
      " taskset -c 0 " + program + " run " + written(scene, "scene.json") + " -o ";
  ASSERT_EQ(run_shell("exec" + run + "on_1").code, 0);
  ASSERT_EQ(run_shell("exec mpirun -q --oversubscribe -n 2" + run + "on_2").code, 0);
  const auto record = file_json("on_2/run.json");
  EXPECT_GT(record["steps"], 1000);
  const double one = file_json("on_1/run.json")["wall_seconds"], two = record["wall_seconds"];
  EXPECT_LT(two, one + 3e-3 * double(record["steps"])) << one;
}

// A state that is kept for pictures is damaged where one rank reads it: all do without.
TEST_F(RanksEnds, WhatOneRankHasLostIsLostForAll)
{
  written(halves_that_slide(), "scene.json");
  ASSERT_EQ(run_ligament("run scene.json -n 2 --set /time/duration=120 -o out").code, 0);
  fs::create_directory("elsewhere");
  fs::copy("out", "elsewhere/out", fs::copy_options::recursive);
  int n_kept = 0;
  for (const auto &entry : fs::directory_iterator("elsewhere/out/checkpoints"))
    if (entry.path().filename().string().rfind("kept_", 0) == 0) {
      std::ofstream(entry.path()) << "damaged";
      ++n_kept;
    }
  ASSERT_GT(n_kept, 0);
  const std::string resume = program + " resume out --set /time/duration=160";
  const Outcome outcome = run_shell("exec timeout -k 5 60 mpirun -q --oversubscribe -n 1 " +
                                    resume + " : -n 1 -wdir elsewhere " + resume);
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_NE(outcome.errors.find("another rank cannot read the kept state"), std::string::npos)
      << outcome.errors;
  EXPECT_EQ(file_json("out/run.json")["status"], "done");
}

// A parent that ignores the end of its children hands that on.
TEST_F(RanksEnds, WhoeverIgnoresTheEndOfChildren)
{
  Json scene = scene_of(2, "hexagonal", {20, 20});
  pull(scene, 1, 1, 4e-4);
  written(scene, "scene.json");
  const Outcome outcome = // perl-base is part of every Debian
      run_shell("exec timeout -k 5 60 perl -e '$SIG{CHLD} = \"IGNORE\"; exec @ARGV' " + program +
                " run scene.json -n 2 -o out");
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
}
} // namespace
