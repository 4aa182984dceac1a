// States on the disk: what is written comes back bit by bit, and no damage goes unnoticed.
#include "core/check.h"
#include "core/files.h"
#include "core/packed_keys.h"
#include "core/state_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <numeric>
#include <random>

namespace
{
using namespace ligament::core;
using Keys = std::vector<std::int64_t>;

constexpr std::int64_t lowest = std::numeric_limits<std::int64_t>::min(),
                       highest = std::numeric_limits<std::int64_t>::max();

State sample()
{
  State state;
  Table particles({-3, -2, -1, 5, 6, 1000000007});
  particles.add("x", std::vector<double>{0., -0., NAN, INFINITY, 5e-324, 1. / 3});
  particles.add("count", std::vector<std::int64_t>{lowest, -1, 0, 1, 2, highest});
  state.emplace("particles", particles);
  Table pairs({1, 2, 1, 3, 1, 9, 4, 0}, 2);
  pairs.add("slip", std::vector<double>{1, 2, 3, 4});
  state.emplace("contacts", pairs);
  state.emplace("searched", Table({7, 8, 8, 9}, 2)); // no columns
  Table none(Keys{});
  none.add("energy", std::vector<double>{});
  state.emplace("broken", none);
  save_value(state, "run", "energy", 0.1);
  return state;
}

std::string what_is_wrong(const std::function<void()> &action)
{
  try {
    action();
  } catch (const InputError &error) {
    return error.what();
  }
  return "nothing";
}

/// What reading says of a file with this content.
std::string wrong_with(const std::string &content)
{
  std::filesystem::remove("damaged.bin"); // some file systems synchronise what is overwritten
  std::ofstream("damaged.bin", std::ios::binary) << content;
  return what_is_wrong([] { read_state_file("damaged.bin"); });
}

TEST(PackedKeys, ComeBack)
{
  std::mt19937_64 random(1);
  const std::vector<Keys> lists = {{},
                                   {0},
                                   {lowest},
                                   {highest},
                                   {lowest, -1, 0, 1, highest - 1, highest},
                                   {127, 128, 129, 16384}};
  for (const Keys &keys : lists)
    EXPECT_EQ(unpack_keys(pack_keys(keys, 1), 1, std::int64_t(keys.size())), keys);
  for (int n_keys = 1; n_keys <= 3; ++n_keys) {
    Keys keys;
    for (int k = 0; k < 3000; ++k)
      keys.push_back(std::int64_t(random()) >> random() % 64);
    EXPECT_EQ(unpack_keys(pack_keys(keys, n_keys), n_keys, 3000 / n_keys), keys) << n_keys;
  }
}

TEST(PackedKeys, RunsTakeNearlyNothing)
{
  Keys keys;
  for (int row = 0; row < 100; ++row)
    for (int k = 0; k < 1000; ++k)
      keys.push_back((std::int64_t(row) << 26) + k);
  EXPECT_LE(pack_keys(keys, 1).size(), 100 * 7u); // 2^26 and 1000 need 4 and 2 bytes of 7 bits
}

TEST(PackedKeys, OtherNumbersOfRowsAreRefused)
{
  const std::string bytes = pack_keys({1, 2, 3, 7, 8}, 1);
  EXPECT_THROW(unpack_keys(bytes, 1, 4), InputError);
  EXPECT_THROW(unpack_keys(bytes, 1, 6), InputError);
  EXPECT_THROW(unpack_keys(bytes, 2, 5), InputError);
  EXPECT_THROW(unpack_keys(std::string(20, char(255)), 1, 5), InputError);
}

TEST(StateFile, BringsBackEveryBit)
{
  for (const State &state : {sample(), State(), State{{"", Table()}}}) {
    const StateFileSum sum = write_state_file("state.bin", state);
    EXPECT_EQ(sum.bytes, std::int64_t(std::filesystem::file_size("state.bin")));
    EXPECT_EQ(read_state_file("state.bin"), state);
    EXPECT_EQ(read_state_file("state.bin", sum), state);
  }
  const std::string first = read_file((write_state_file("a.bin", sample()), "a.bin"));
  write_state_file("b.bin", sample());
  EXPECT_EQ(read_file("b.bin"), first); // equal states are equal files
}

TEST(StateFile, SumsTellStatesApart)
{
  const StateFileSum sum = write_state_file("state.bin", sample());
  EXPECT_TRUE(sum == state_file_sum(sample()));
  State other = sample();
  other.erase("run");
  save_value(other, "run", "energy", std::nextafter(0.1, 1));
  const StateFileSum other_sum = write_state_file("other.bin", other);
  EXPECT_EQ(sum.bytes, other_sum.bytes);
  EXPECT_NE(sum.checksum, other_sum.checksum);
  EXPECT_EQ(what_is_wrong([&] { read_state_file("other.bin", sum); }),
            "other.bin: not the file that was written here");
}

TEST(StateFile, EveryFlippedBitIsNoticed)
{
  write_state_file("whole.bin", sample());
  const std::string whole = read_file("whole.bin");
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string damaged = whole;
    damaged[bit / 8] = char(damaged[bit / 8] ^ (1 << bit % 8));
    ASSERT_EQ(wrong_with(damaged).rfind("damaged.bin: ", 0), 0u) << bit;
  }
}

TEST(StateFile, EveryCutIsNoticed)
{
  write_state_file("whole.bin", sample());
  const std::string whole = read_file("whole.bin");
  for (std::size_t size = 0; size < whole.size(); ++size)
    ASSERT_EQ(wrong_with(whole.substr(0, size)).rfind("damaged.bin: ", 0), 0u) << size;
  EXPECT_EQ(wrong_with(whole + "x").rfind("damaged.bin: cut or damaged: it has ", 0), 0u);
}

TEST(StateFile, SaysWhatIsWrong)
{
  write_state_file("whole.bin", sample());
  const std::string whole = read_file("whole.bin");
  EXPECT_EQ(wrong_with(std::string(1000, '\0')),
            "damaged.bin: not a file of states, or damaged at its beginning");
  std::string other = whole;
  other[8] = 2;
  EXPECT_EQ(wrong_with(other), "damaged.bin: of format 2, this program reads format 1");
  other = whole;
  other[40] ^= 1;
  EXPECT_EQ(wrong_with(other), "damaged.bin: damaged: the checksum of the header is wrong");
  other = whole;
  other[whole.size() - 20] ^= 1;
  EXPECT_EQ(wrong_with(other), "damaged.bin: damaged: the checksum of the content is wrong");
  EXPECT_EQ(what_is_wrong([] { read_state_file("none.bin"); }),
            "cannot read none.bin: No such file or directory");
  EXPECT_EQ(what_is_wrong([] { read_state_file("."); }), "cannot read .: Is a directory");
}

TEST(StateFile, ADiskThatRefusesIsAnEnvironmentError)
{
  EXPECT_THROW(write_state_file("no_such_folder/state.bin", sample()), EnvironmentError);
  EXPECT_THROW(write_state_file("/dev/full", sample()), EnvironmentError);
}
} // namespace
