// What keeps results when something goes wrong: locks, signals, reserved room, keys of late errors.
#include "core/disk_reserve.h"
#include "core/files.h"
#include "core/folder_lock.h"
#include "core/input_file.h"
#include "core/interruption.h"
#include "core/keyed_error.h"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <thread>

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace ligament::core;
namespace fs = std::filesystem;

namespace
{
/// Exit code of a process that does this, 128 + signal when one ends it.
int in_a_process(const std::function<int()> &work)
{
  const pid_t id = fork();
  if (id == 0)
    _exit(work());
  int status = 0;
  waitpid(id, &status, 0);
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

TEST(FolderLock, IsOfOneProcessAndEndsWithIt)
{
  fs::remove_all("locked");
  fs::create_directory("locked");
  EXPECT_FALSE(FolderLock::is_held("locked"));
  {
    const FolderLock lock("locked", "run");
    EXPECT_TRUE(FolderLock::is_held("locked"));
    try {
      FolderLock("locked", "run");
      ADD_FAILURE() << "locked twice";
    } catch (const EnvironmentError &error) {
      const std::string text = error.what();
      EXPECT_EQ(text.find("locked: another run is under way in this folder (process " +
                          std::to_string(getpid())),
                0u)
          << text;
    }
  }
  EXPECT_FALSE(FolderLock::is_held("locked"));
  EXPECT_TRUE(fs::is_empty("locked"));
  EXPECT_EQ(in_a_process([] {
              new FolderLock("locked", "run");
              return raise(SIGKILL);
            }),
            128 + SIGKILL);
  EXPECT_FALSE(FolderLock::is_held("locked"));
  const FolderLock again("locked", "run");
}

TEST(FolderLock, MovesWithItsFolder)
{
  for (const char *name : {"moving", "moved"})
    fs::remove_all(name);
  fs::create_directory("moving");
  {
    const FolderLock old("moving", "run");
    fs::rename("moving", "moved");
    fs::create_directory("moving");
    const FolderLock fresh("moving", "run");
    EXPECT_TRUE(FolderLock::is_held("moved"));
  }
  EXPECT_TRUE(fs::is_empty("moving"));
}

TEST(Interruption, SaysLastWordsOrLeavesTheSignalToTheCaller)
{
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    EXPECT_EQ(in_a_process([&] {
                std::signal(signal, SIG_DFL);
                Interruption interruption;
                interruption.end_at_once([](int s) { write_file("words", Interruption::name(s)); });
                kill(getpid(), signal);
                sleep(10);
                return 1;
              }),
              128 + signal);
    EXPECT_EQ(read_file("words"), Interruption::name(signal));
    EXPECT_EQ(in_a_process([&] {
                std::signal(signal, SIG_DFL);
                Interruption interruption;
                interruption.leave_to_caller();
                kill(getpid(), signal);
                for (int k = 0; k < 1000 && interruption.signal() == 0; ++k)
                  std::this_thread::sleep_for(std::chrono::milliseconds(5));
                return interruption.signal();
              }),
              signal);
  }
}

TEST(Interruption, ASecondSignalDoesNotWait)
{
  EXPECT_EQ(in_a_process([] {
              std::signal(SIGTERM, SIG_DFL);
              Interruption interruption;
              interruption.leave_to_caller();
              kill(getpid(), SIGTERM);
              for (int k = 0; k < 1000 && interruption.signal() == 0; ++k)
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
              std::this_thread::sleep_for(1.1 * Interruption::one_wish);
              kill(getpid(), SIGTERM);
              sleep(10);
              return 1;
            }),
            128 + SIGTERM);
}

// GNU `timeout` signals its child and then the group that it is in.
TEST(Interruption, ASecondSignalAtOnceIsTheSameWish)
{
  EXPECT_EQ(in_a_process([] {
              std::signal(SIGTERM, SIG_DFL);
              Interruption interruption;
              interruption.leave_to_caller();
              for (int k = 0; k < 3; ++k) {
                kill(getpid(), SIGTERM);
                std::this_thread::sleep_for(std::chrono::milliseconds(30));
              }
              return interruption.signal() == SIGTERM ? 7 : 1;
            }),
            7);
}

TEST(Interruption, IgnoredSignalsStayIgnored)
{
  EXPECT_EQ(in_a_process([] {
              std::signal(SIGHUP, SIG_IGN);
              Interruption interruption;
              kill(getpid(), SIGHUP);
              std::this_thread::sleep_for(std::chrono::milliseconds(50));
              return 7;
            }),
            7);
}

TEST(DiskReserve, TakesAndGivesRoom)
{
  {
    const DiskReserve reserve("kept", 10000);
    EXPECT_EQ(fs::file_size("kept.reserve"), 10000u);
    EXPECT_TRUE(release_reserve("kept"));
    EXPECT_FALSE(release_reserve("kept"));
    const DiskReserve again("other", 1);
    EXPECT_TRUE(fs::exists("other.reserve"));
  }
  EXPECT_FALSE(fs::exists("other.reserve"));
}

// A limit on the size of files stands for the full disk.
TEST(OutputFile, EndsWithAWholeFlushAndTriesAgain)
{
  EXPECT_EQ(in_a_process([] {
              std::signal(SIGXFSZ, SIG_IGN);
              const auto limit = [](rlim_t bytes) {
                const rlimit l{bytes, RLIM_INFINITY};
                setrlimit(RLIMIT_FSIZE, &l);
              };
              limit(1000);
              OutputFile file("rows", OutputFile::Mode::stream);
              file.write(std::string(899, 'a') + "\n");
              file.flush();
              file.write(std::string(299, 'b') + "\n");
              try {
                file.flush();
                return 1;
              } catch (const EnvironmentError &) {
              }
              if (fs::file_size("rows") != 900)
                return 2;
              limit(2000);
              file.flush();
              return fs::file_size("rows") == 1200 ? 0 : 3;
            }),
            0);
}

TEST(InputFile, SaysWhyItCannotBeRead)
{
  const auto reason = [](const std::string &path) {
    try {
      read_input(path);
    } catch (const EnvironmentError &error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_EQ(reason("."), "it is a folder");
  EXPECT_EQ(reason("not_there"), "there is no such file");
  write_file("input", "text");
  EXPECT_EQ(read_input("input"), "text");
  EXPECT_TRUE(is_named_file("input") && is_named_file("not_there"));
  EXPECT_FALSE(is_named_file("-") || is_named_file("/dev/null"));
}

TEST(KeyedError, TakesTextsApart)
{
  const auto parts = [](const std::string &text) {
    const KeyedError e = keyed(text, "/zone", "think");
    return e.key + "|" + e.message + "|" + e.reason + "|" + e.remedy;
  };
  EXPECT_EQ(parts("too thin"), "/zone|too thin||think");
  EXPECT_EQ(parts("too thin: widen it"), "/zone|too thin||widen it");
  EXPECT_EQ(parts("too thin; widen it"), "/zone|too thin||widen it");
  EXPECT_EQ(parts("too thin: it takes 3 d; widen it"), "/zone|too thin|it takes 3 d|widen it");
  EXPECT_EQ(parts("/time/step: too long; take half"), "/time/step|too long||take half");
  EXPECT_EQ(parts("too thin; raise /coupling/overlap_cells or x"),
            "/coupling/overlap_cells|too thin||raise /coupling/overlap_cells or x");
  EXPECT_EQ(parts("1/2 of a m/s is too much"), "/zone|1/2 of a m/s is too much||think");
}

TEST(KeyedError, KeepsTheKeyThatIsNearest)
{
  try {
    at_key("/outer", "", [] { at_key("/inner", "", [] { throw InputError("wrong; mend it"); }); });
    ADD_FAILURE();
  } catch (const KeyedError &error) {
    EXPECT_EQ(error.key, "/inner");
    EXPECT_EQ(std::string(error.what()), "/inner: wrong; mend it");
  }
  EXPECT_EQ(at_key("/k", "", [] { return 5; }), 5);
}
} // namespace
