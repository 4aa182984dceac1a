// Jobs beside the computation: in order, all done, errors come back to the caller.
#include "core/background_writer.h"

#include "core/check.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

using namespace ligament::core;

namespace
{
/// Holds a job at its start until the test lets it go.
struct Gate
{
  std::atomic<bool> open = false;
  void pass() const
  {
    while (!open)
      std::this_thread::yield();
  }
};

TEST(BackgroundWriter, JobsRunInOrderBesideTheCaller)
{
  std::vector<int> done;
  Gate gate;
  BackgroundWriter writer;
  writer.submit([&] {
    gate.pass();
    done.push_back(0);
  });
  // The caller is here although the first job stands at the gate.
  gate.open = true;
  for (int i = 1; i < 100; ++i)
    writer.submit([&done, i] { done.push_back(i); });
  writer.wait();
  ASSERT_EQ(done.size(), 100u);
  for (int i = 0; i < 100; ++i)
    EXPECT_EQ(done[i], i);
}

// One at work, one waiting: a third must not be taken, or copies pile up faster than the disk
// takes them.
TEST(BackgroundWriter, TheThirdJobWaits)
{
  Gate gate;
  std::atomic<bool> third_is_taken = false;
  BackgroundWriter writer;
  writer.submit([&] { gate.pass(); });
  writer.submit([] {});
  std::thread caller([&] {
    writer.submit([] {});
    third_is_taken = true;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_FALSE(third_is_taken);
  gate.open = true;
  caller.join();
  EXPECT_TRUE(third_is_taken);
}

TEST(BackgroundWriter, ErrorsReachTheCallerOnce)
{
  BackgroundWriter writer;
  bool later = false;
  writer.submit([] { throw EnvironmentError("disk full"); });
  EXPECT_THROW(writer.wait(), EnvironmentError);
  writer.submit([&] { later = true; });
  writer.wait();
  EXPECT_TRUE(later);
}

// One at work and one waiting when the end comes.
TEST(BackgroundWriter, EndsWithAllJobsDone)
{
  int done = 0;
  Gate gate;
  std::thread opener;
  {
    BackgroundWriter writer;
    writer.submit([&] {
      gate.pass();
      ++done;
    });
    writer.submit([&] { ++done; });
    opener = std::thread([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      gate.open = true;
    });
  }
  opener.join();
  EXPECT_EQ(done, 2);
}
} // namespace
