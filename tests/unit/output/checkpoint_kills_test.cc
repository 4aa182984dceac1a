// A checkpoint under way: killed behind any of its calls of the system, or refused by the disk at
// any of them. The newest good one is then that before or the new one, never another, never none.
#include "core/files.h"
#include "src/output/checkpoints.h"
#include "tests/support/faulty_disk.h"
#include "tests/support/program.h"
#include "tests/support/sample_states.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <filesystem>

using namespace ligament;
using namespace ligament::program;
namespace fs = std::filesystem;

namespace
{
const std::string folder = fs::absolute("kills/checkpoints"), before = fs::absolute("kills_before");

/// Checkpoint 3 onto 1 and 2, by a process of its own; its exit code.
int write_with_fault(const std::string &variables)
{
  return tests::run_shell("FAULTY_DISK_FOLDER=" + folder + " " + variables + " " +
                          tests::with_faulty_disk() + "exec " + LIGAMENT_CHECKPOINT_WRITER + " " +
                          folder + " 3")
      .code;
}

void start_again()
{
  fs::remove_all(folder);
  fs::copy(before, folder, fs::copy_options::recursive);
}

/// Which states are found, 0: none.
int newest()
{
  const auto found = Checkpoints(folder).newest_good();
  if (!found.checkpoint)
    return 0;
  const int seed = int(found.checkpoint->manifest.step);
  EXPECT_EQ(found.checkpoint->states, tests::sample_states(seed));
  EXPECT_EQ(found.checkpoint->kept, tests::sample_kept(seed));
  EXPECT_TRUE(found.passed_over.empty()) << found.passed_over[0];
  return seed;
}

class CheckpointKills : public testing::TestWithParam<std::string>
{
protected:
  static void SetUpTestSuite()
  {
    fs::remove_all("kills");
    fs::remove_all(before);
    fs::create_directories("kills");
    for (int k = 1; k <= 2; ++k) {
      CheckpointManifest manifest;
      manifest.step = k;
      Checkpoints(before).write(manifest, tests::sample_states(k), tests::kept_states(k));
    }
    start_again();
    ASSERT_EQ(write_with_fault("FAULTY_DISK_COUNT=count"), 0);
    n_calls = std::atoi(tests::file_text("count").c_str());
    ASSERT_EQ(newest(), 3);
    // At least: folders, three files with open, write, sync and rename, removal of three files.
    ASSERT_GE(n_calls, 2 + 3 * 4 + 4);
  }
  static int n_calls;
};
int CheckpointKills::n_calls = 0;

/// A process that is whole again goes on with what it finds.
void expect_that_the_next_one_works()
{
  const bool both_are_the_same = newest() == 3; // then they keep two, not three
  EXPECT_EQ(write_with_fault(""), 0);
  EXPECT_EQ(newest(), 3);
  int n = 0;
  for ([[maybe_unused]] const auto &entry : fs::directory_iterator(folder))
    ++n;
  EXPECT_EQ(n, 2 + (both_are_the_same ? 2 : 3));
}

TEST_P(CheckpointKills, BehindAnyCall)
{
  int n_old = 0, n_new = 0;
  for (int call = 1; call <= n_calls; ++call) {
    start_again();
    ASSERT_EQ(write_with_fault("FAULTY_DISK_ACTION=" + GetParam() +
                               " FAULTY_DISK_CALL=" + std::to_string(call)),
              99)
        << call;
    const int seed = newest();
    EXPECT_TRUE(seed == 2 || seed == 3) << "call " << call << ": " << seed;
    (seed == 2 ? n_old : n_new)++;
    expect_that_the_next_one_works();
  }
  EXPECT_GT(n_old, 12);
  EXPECT_GT(n_new, 4);
}

INSTANTIATE_TEST_SUITE_P(Processes, CheckpointKills, testing::Values("kill", "tear"));

class CheckpointRefusals : public CheckpointKills
{
};

TEST_P(CheckpointRefusals, AtAnyCallAreToldAndLeaveTheOneBefore)
{
  for (int call = 1; call <= n_calls; ++call)
    for (const char *action : {"fail", "fail_on"}) {
      start_again();
      ASSERT_EQ(write_with_fault(std::string("FAULTY_DISK_ACTION=") + action +
                                 " FAULTY_DISK_CALL=" + std::to_string(call) +
                                 " FAULTY_DISK_ERROR=" + GetParam()),
                4)
          << action << " " << call;
      const int seed = newest();
      EXPECT_TRUE(seed == 2 || seed == 3) << action << " " << call << ": " << seed;
      Checkpoints(folder).remove_newer_than(2);
      EXPECT_EQ(newest(), 2);
      expect_that_the_next_one_works();
    }
}

INSTANTIATE_TEST_SUITE_P(Disks, CheckpointRefusals,
                         testing::Values(std::to_string(ENOSPC), std::to_string(EIO)));
} // namespace
