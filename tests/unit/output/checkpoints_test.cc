// Checkpoints: what is written comes back; two are kept; nothing damaged is ever used.
#include "core/check.h"
#include "core/files.h"
#include "core/folders.h"
#include "src/output/checkpoints.h"
#include "tests/support/sample_states.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <random>

using namespace ligament;
using namespace ligament::program;
using tests::kept_states;
using tests::sample_kept;
using tests::sample_states;
namespace fs = std::filesystem;

namespace
{
using Names = std::vector<std::string>;

class CheckpointsTest : public testing::Test
{
protected:
  void SetUp() override
  {
    fs::remove_all(folder);
    fs::remove_all(copy);
  }

  /// Checkpoints 1 .. n with the states of these numbers.
  void write(int n)
  {
    for (int k = 1; k <= n; ++k)
      write_one(k);
  }
  void write_one(int k)
  {
    CheckpointManifest manifest;
    manifest.step = k;
    checkpoints.write(manifest, sample_states(k), kept_states(k));
  }
  /// The seed of the states that are found; 0: none. Wrong states fail.
  int newest(Names *passed_over = nullptr)
  {
    const FoundCheckpoint found = checkpoints.newest_good();
    if (passed_over)
      *passed_over = found.passed_over;
    if (!found.checkpoint)
      return 0;
    const int seed = int(found.checkpoint->manifest.step);
    EXPECT_EQ(found.checkpoint->states, sample_states(seed));
    EXPECT_EQ(found.checkpoint->kept, sample_kept(seed));
    return seed;
  }
  static std::string file(int number, const std::string &name)
  {
    return "checkpoints/checkpoint_00000" + std::to_string(number) + "/" + name;
  }

  const std::string folder = "checkpoints", copy = "checkpoints_whole";
  const Checkpoints checkpoints = Checkpoints(folder);
};

TEST_F(CheckpointsTest, BringBackWhatWasWritten)
{
  CheckpointManifest manifest;
  manifest.step = 123456789012;
  manifest.time = 1. / 3;
  manifest.dt = 5e-324;
  manifest.wall_seconds = 0.1;
  manifest.version = "1.2.3";
  manifest.commit = "abc+changes";
  manifest.instructions = "AVX2";
  manifest.scene = {{"title", "\xc3\xa4 \"x\"\n"}, {"time", {{"duration", 1e-300}}}};
  manifest.positions = {{"history.csv", 17}, {"run.log", 0}};
  checkpoints.write(manifest, sample_states(1));
  const auto found = checkpoints.newest_good();
  ASSERT_TRUE(found.checkpoint);
  EXPECT_TRUE(found.passed_over.empty());
  const CheckpointManifest &read = found.checkpoint->manifest;
  EXPECT_EQ(read.number, 1);
  EXPECT_EQ(read.step, manifest.step);
  EXPECT_EQ(read.time, manifest.time);
  EXPECT_EQ(read.dt, manifest.dt);
  EXPECT_EQ(read.wall_seconds, manifest.wall_seconds);
  EXPECT_EQ(read.version, manifest.version);
  EXPECT_EQ(read.commit, manifest.commit);
  EXPECT_EQ(read.instructions, manifest.instructions);
  EXPECT_EQ(read.scene, manifest.scene);
  EXPECT_EQ(read.positions, manifest.positions);
  EXPECT_EQ(found.checkpoint->states, sample_states(1));
}

TEST_F(CheckpointsTest, TwoAreKept)
{
  EXPECT_EQ(newest(), 0);
  for (int k = 1; k <= 4; ++k) {
    write_one(k);
    EXPECT_EQ(newest(), k);
  }
  EXPECT_EQ(core::folder_entries(folder),
            (Names{"checkpoint_000003", "checkpoint_000004", "kept_copy_2.bin", "kept_copy_3.bin",
                   "kept_copy_4.bin"}));
  EXPECT_EQ(core::folder_entries(folder + "/checkpoint_000004"),
            (Names{"body.bin", "manifest.json", "run.bin"}));
}

TEST_F(CheckpointsTest, WhatIsUnfinishedIsIgnoredAndRemovedByTheNextOne)
{
  write(2);
  fs::copy(file(2, ""), folder + "/checkpoint_000003.tmp");
  fs::create_directory(folder + "/checkpoint_000004"); // without manifest
  std::ofstream(folder + "/checkpoint_000004/body.bin") << "x";
  std::ofstream(folder + "/notes.txt") << "somebody's";
  std::ofstream(folder + "/kept_copy_9.bin") << "of the unfinished one";
  EXPECT_EQ(newest(), 2);
  write_one(3);
  EXPECT_EQ(core::folder_entries(folder),
            (Names{"checkpoint_000002", "checkpoint_000003", "kept_copy_1.bin", "kept_copy_2.bin",
                   "kept_copy_3.bin", "notes.txt"}));
  EXPECT_EQ(newest(), 3);
}

TEST_F(CheckpointsTest, NewerOnesCanBeGivenUp)
{
  write(3);
  checkpoints.remove_newer_than(2);
  EXPECT_EQ(newest(), 2);
  write_one(3);
  EXPECT_EQ(core::folder_entries(folder),
            (Names{"checkpoint_000002", "checkpoint_000003", "kept_copy_1.bin", "kept_copy_2.bin",
                   "kept_copy_3.bin"}));
}

TEST_F(CheckpointsTest, WriteWhatTheyKeepOnce)
{
  write(1);
  int n_taken = 0;
  std::vector<KeptState> kept = kept_states(2); // the one before keeps one of them
  for (KeptState &state : kept)
    state.take = [&n_taken, take = state.take] {
      ++n_taken;
      return take();
    };
  CheckpointManifest manifest;
  manifest.step = 2;
  checkpoints.write(manifest, sample_states(2), kept);
  EXPECT_EQ(n_taken, 1);
  EXPECT_EQ(newest(), 2);
}

TEST_F(CheckpointsTest, DoWithoutALostReference)
{
  const core::State reference = sample_states(9).at("run");
  CheckpointManifest manifest;
  manifest.reference = checkpoints.write_reference(reference);
  checkpoints.write(manifest, sample_states(1));
  checkpoints.write(manifest, sample_states(1));
  checkpoints.write(manifest, sample_states(1));
  auto found = checkpoints.newest_good();
  ASSERT_TRUE(found.checkpoint);
  EXPECT_EQ(found.checkpoint->reference, reference);
  EXPECT_EQ(found.checkpoint->reference_lost, "");
  checkpoints.write_reference(sample_states(8).at("run")); // another one
  found = checkpoints.newest_good();
  ASSERT_TRUE(found.checkpoint && found.passed_over.empty());
  EXPECT_EQ(found.checkpoint->states, sample_states(1));
  EXPECT_TRUE(found.checkpoint->reference.empty());
  EXPECT_NE(found.checkpoint->reference_lost.find("checkpoints/reference.bin: "),
            std::string::npos);
}

/// What may happen to a file between two runs.
struct Damage
{
  std::string name;
  std::function<void(const std::string &file, const std::string &older)> do_it;
};

void rewrite(const std::string &file, const std::string &content)
{
  fs::remove(file); // some file systems synchronise what is overwritten
  std::ofstream(file, std::ios::binary) << content;
}

std::vector<Damage> all_damages()
{
  std::vector<Damage> damages = {{"deleted", [](auto &file, auto &) { fs::remove(file); }},
                                 {"emptied", [](auto &file, auto &) { rewrite(file, ""); }},
                                 {"swapped", [](auto &file, auto &older) {
                                    fs::rename(file, "swapped");
                                    fs::rename(older, file);
                                    fs::rename("swapped", older);
                                  }}};
  std::mt19937_64 random(7);
  for (int k = 0; k < 64; ++k)
    damages.push_back({"bit " + std::to_string(k), [place = random()](auto &file, auto &) {
                         std::string content = core::read_file(file);
                         const std::size_t bit = place % (8 * content.size());
                         content[bit / 8] = char(content[bit / 8] ^ (1 << bit % 8));
                         rewrite(file, content);
                       }});
  for (int k = 0; k < 16; ++k)
    damages.push_back({"cut " + std::to_string(k), [place = random()](auto &file, auto &) {
                         const std::string content = core::read_file(file);
                         rewrite(file, content.substr(0, place % content.size()));
                       }});
  return damages;
}

// A file that is swapped damages both checkpoints: then there is none, and never a wrong one.
TEST_F(CheckpointsTest, DamageOfAnyFileIsFoundAndTheOlderOneUsed)
{
  write(2);
  fs::rename(folder, copy);
  for (const std::string name : {"body.bin", "run.bin", "manifest.json"})
    for (const Damage &damage : all_damages()) {
      fs::remove_all(folder);
      fs::copy(copy, folder, fs::copy_options::recursive);
      damage.do_it(file(2, name), file(1, name));
      Names passed_over;
      ASSERT_EQ(newest(&passed_over), damage.name == "swapped" ? 0 : 1)
          << name << " " << damage.name;
      ASSERT_EQ(passed_over.size(), damage.name == "swapped" ? 2u : 1u);
      EXPECT_NE(passed_over[0].find(file(2, name)), std::string::npos) << passed_over[0];
    }
}

// Where only the newest one names what is lost the older one is used; where both do, a run goes on
// from the newest without it.
TEST_F(CheckpointsTest, DoWithoutLostCopies)
{
  write(2);
  fs::rename(folder, copy);
  for (const std::string name : {"copy_2", "copy_1"})
    for (const Damage &damage : all_damages()) {
      fs::remove_all(folder);
      fs::copy(copy, folder, fs::copy_options::recursive);
      const std::string file = folder + "/kept_" + name + ".bin";
      damage.do_it(file, folder + "/kept_copy_0.bin");
      const auto found = checkpoints.newest_good();
      ASSERT_TRUE(found.checkpoint);
      const auto seed = found.checkpoint->manifest.step;
      const bool all_lose = name == "copy_1" || damage.name == "swapped";
      EXPECT_EQ(seed, all_lose ? 2 : 1) << name << " " << damage.name;
      EXPECT_EQ(found.checkpoint->states, sample_states(int(seed)));
      auto left = sample_kept(int(seed));
      if (all_lose)
        left.erase(name);
      EXPECT_EQ(found.checkpoint->kept, left);
      const Names &told = all_lose ? found.checkpoint->kept_lost : found.passed_over;
      ASSERT_EQ(told.size(), 1u);
      EXPECT_NE(told[0].find(file), std::string::npos) << told[0];
    }
}

TEST_F(CheckpointsTest, AFileOfTheOlderOneIsNotUsed)
{
  write(2);
  for (const std::string name : {"body.bin", "run.bin", "manifest.json"}) {
    fs::remove_all(copy);
    fs::copy(folder, copy, fs::copy_options::recursive);
    fs::copy(file(1, name), file(2, name), fs::copy_options::overwrite_existing);
    Names passed_over;
    EXPECT_EQ(newest(&passed_over), 1) << name;
    fs::remove_all(folder);
    fs::rename(copy, folder);
  }
  fs::remove_all(file(2, ""));
  fs::rename(file(1, ""), "checkpoints/checkpoint_000002");
  EXPECT_EQ(newest(), 0); // a folder under another's name
}
} // namespace
