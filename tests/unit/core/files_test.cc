// Files: complete or untouched, and a full disk is noticed.
#include "core/files.h"

#include "core/check.h"
#include "core/log.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

using namespace ligament::core;

namespace
{
std::string message_of(const std::function<void()> &action)
{
  try {
    action();
  } catch (const EnvironmentError &error) {
    return error.what();
  }
  return "no error";
}

TEST(OutputFile, ReturnsWhatWasWritten)
{
  // Pieces below and above the size of the buffer.
  const std::string large(200000, 'x');
  OutputFile file("round_trip.txt");
  file.write("small,");
  file.write(large);
  file.write(",end");
  file.commit();
  EXPECT_EQ(read_file("round_trip.txt"), "small," + large + ",end");
}

TEST(OutputFile, TargetStaysAsItWasWithoutCommit)
{
  write_file("atomic.txt", "old");
  {
    OutputFile file("atomic.txt");
    file.write(std::string(100000, 'n'));
    file.flush();
    EXPECT_EQ(read_file("atomic.txt"), "old");
  }
  EXPECT_EQ(read_file("atomic.txt"), "old");
  EXPECT_FALSE(std::filesystem::exists("atomic.txt.part"));
  write_file("atomic.txt", "new");
  EXPECT_EQ(read_file("atomic.txt"), "new");
  EXPECT_FALSE(std::filesystem::exists("atomic.txt.part"));
}

TEST(OutputFile, StreamCanBeReadWhileItGrowsAndAppendContinuesIt)
{
  {
    OutputFile file("stream.txt", OutputFile::Mode::stream);
    file.write("a");
    file.flush();
    EXPECT_EQ(read_file("stream.txt"), "a");
    file.write("b");
  }
  {
    OutputFile file("stream.txt", OutputFile::Mode::append);
    file.write("c");
  }
  EXPECT_EQ(read_file("stream.txt"), "abc");
  OutputFile again("stream.txt", OutputFile::Mode::stream);
  EXPECT_EQ(read_file("stream.txt"), "");
}

// /dev/full refuses every byte with "No space left on device".
TEST(OutputFile, FullDiskIsNoticed)
{
  for (const std::size_t size : {std::size_t(10), std::size_t(1) << 20}) {
    const std::string message =
        message_of([&] { write_file("/dev/full", std::string(size, 'x')); });
    EXPECT_NE(message.find("/dev/full"), std::string::npos) << message;
    EXPECT_NE(message.find("No space left"), std::string::npos) << message;
  }
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full")) << "a device was replaced";
}

TEST(OutputFile, MissingFolderIsNamed)
{
  const std::string message = message_of([] { write_file("no/such/folder/f", "x"); });
  EXPECT_NE(message.find("no/such/folder/f"), std::string::npos) << message;
  EXPECT_NE(message_of([] { read_file("no_such_file"); }), "no error");
  EXPECT_NE(message_of([] { read_file("."); }), "no error");
}

TEST(Log, LinesArriveAtOnceWithLevelAndMessage)
{
  std::filesystem::remove("run.log");
  Log log("run.log");
  log.info("{} particles", 42);
  log.warning("thin overlap");
  const std::string text = read_file("run.log");
  const auto info = text.find("info    42 particles\n"),
             warning = text.find("warning thin overlap\n");
  EXPECT_NE(info, std::string::npos) << text;
  EXPECT_NE(warning, std::string::npos) << text;
  EXPECT_LT(info, warning);
  EXPECT_EQ(message_of([] { Log("/dev/full").info("a log less costs no run"); }), "no error");
  Log().info("goes nowhere");
}

TEST(CutFile, TakesOffWhatFollows)
{
  write_file("cut.txt", "0123456789");
  cut_file("cut.txt", 10);
  EXPECT_EQ(read_file("cut.txt"), "0123456789");
  cut_file("cut.txt", 4);
  EXPECT_EQ(read_file("cut.txt"), "0123");
  EXPECT_THROW(cut_file("cut.txt", 5), InputError);
  EXPECT_EQ(read_file("cut.txt"), "0123");
  EXPECT_THROW(cut_file("no_such_file.txt", 0), InputError);
}
} // namespace
