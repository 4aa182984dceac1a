// What is kept is found again to the last bit; what is damaged, foreign or out of reach is not
// used.
#include "src/simulation/toughness_cache.h"

#include "core/files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <thread>
#include <unistd.h>

namespace ligament::program::testing
{
namespace fs = std::filesystem;

struct ToughnessCacheTest : ::testing::Test
{
  ToughnessCacheTest() { fs::remove_all(folder); }
  ~ToughnessCacheTest() override { fs::remove_all(folder); }

  double ask(const ToughnessCache &cache, const std::string &key, double answer)
  {
    return cache.factor(key, [&] {
      ++n_found;
      return answer;
    });
  }

  const std::string folder =
      (fs::temp_directory_path() / ("ligament_cache_" + std::to_string(getpid()))).string();
  int n_found = 0;
};

TEST_F(ToughnessCacheTest, FindsOnceAndKeepsEveryBit)
{
  const double c = std::sqrt(0.7);
  EXPECT_EQ(ask(ToughnessCache(folder + "/a/b"), "hexagonal 0", c), c);
  EXPECT_EQ(ask(ToughnessCache(folder + "/a/b"), "hexagonal 0", 1.), c);
  EXPECT_EQ(n_found, 1);
  EXPECT_EQ(ask(ToughnessCache(folder + "/a/b"), "hexagonal 1", 2.), 2.);
}

TEST_F(ToughnessCacheTest, DamagedAndForeignFilesAreReplaced)
{
  const ToughnessCache cache(folder);
  for (const char *content : {"", "key", "key\n", "key\nnan\n", "key\n-1\n", "other\n0.5\n"}) {
    fs::create_directories(folder);
    core::write_file(cache.path("key"), content);
    n_found = 0;
    EXPECT_EQ(ask(cache, "key", 0.8), 0.8) << content;
    EXPECT_EQ(ask(cache, "key", 0.9), 0.8);
    EXPECT_EQ(n_found, 1);
  }
}

TEST_F(ToughnessCacheTest, WithoutAPlaceToKeepItIsFoundEveryTime)
{
  core::write_file(folder, "a file where the folder should be");
  for (const std::string &place : {folder, folder + "/below", std::string()}) {
    n_found = 0;
    EXPECT_EQ(ask(ToughnessCache(place), "key", 0.8), 0.8);
    EXPECT_EQ(ask(ToughnessCache(place), "key", 0.9), 0.9);
    EXPECT_EQ(n_found, 2);
  }
}

TEST_F(ToughnessCacheTest, RunsAtTheSameTimeReadWholeFilesOnly)
{
  std::vector<std::thread> runs;
  std::array<double, 8> got{};
  for (std::size_t k = 0; k < got.size(); ++k)
    runs.emplace_back([&, k] {
      for (int i = 0; i < 50; ++i)
        got[k] = ToughnessCache(folder).factor("key", [] { return 0.875; });
    });
  for (auto &run : runs)
    run.join();
  for (const double c : got)
    EXPECT_EQ(c, 0.875);
}
} // namespace ligament::program::testing
