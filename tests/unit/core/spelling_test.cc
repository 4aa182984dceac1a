#include "core/parameters/spelling.h"

#include <gtest/gtest.h>

using namespace ligament::core;

TEST(Spelling, EditDistanceCountsEditsAndSwaps)
{
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("abc", "abc"), 0);
  EXPECT_EQ(edit_distance("abc", "abd"), 1);   // replaced
  EXPECT_EQ(edit_distance("abc", "abcd"), 1);  // inserted
  EXPECT_EQ(edit_distance("abc", "bc"), 1);    // deleted
  EXPECT_EQ(edit_distance("abcd", "acbd"), 1); // swapped
  EXPECT_EQ(edit_distance("widht", "width"), 1);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
}

TEST(Spelling, NearestWordIsNearOrNothing)
{
  const std::vector<std::string> words = {"overlap_width", "overlap_cells", "solver"};
  EXPECT_EQ(nearest_word("overlap_widht", words), "overlap_width");
  EXPECT_EQ(nearest_word("overlap", words), "overlap_width"); // a beginning
  EXPECT_EQ(nearest_word("slver", words), "solver");
  EXPECT_EQ(nearest_word("temperature", words), "");
  EXPECT_EQ(nearest_word("cell_width", {"levels", "cell_size"}), "cell_size"); // a relative
  EXPECT_EQ(nearest_word("overlap_temperature", words), "");                   // of two
  EXPECT_EQ(did_you_mean("temperature", words), "");
  EXPECT_EQ(did_you_mean("slver", words), ", did you mean \"solver\"?");
}

TEST(Spelling, Lists)
{
  EXPECT_EQ(listed({"a"}), "\"a\"");
  EXPECT_EQ(listed({"a", "b", "c"}), "\"a\", \"b\" or \"c\"");
}
