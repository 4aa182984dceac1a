// Parts of sides: what of a face they hold, exactly.
#include "core/part.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace ligament;
using namespace ligament::core;

namespace
{
constexpr double inf = std::numeric_limits<double>::infinity();

TEST(Part, ClipsSegments)
{
  const FaceCorners<2> face = {{-1, 2}, {3, 2}};
  EXPECT_EQ(Part<2>().clip(face), face);
  const auto box = Part<2>::box({-inf, -inf}, {0.5, inf});
  EXPECT_DOUBLE_EQ(face_area<2>(box.clip(face)), 1.5);
  EXPECT_DOUBLE_EQ(face_centroid<2>(box.clip(face))[0], -0.25);
  EXPECT_TRUE(Part<2>::box({-inf, 2.1}, {0.5, inf}).clip(face).empty()) << "beside the side";
  EXPECT_TRUE(Part<2>::box({4, -inf}, {5, inf}).clip(face).empty());
  const auto disc = Part<2>::ball({0, 1}, std::sqrt(2.)); // meets the side from -1 to 1
  EXPECT_NEAR(face_area<2>(disc.clip(face)), 2, 1e-15);
  EXPECT_NEAR(face_centroid<2>(disc.clip(face))[0], 0, 1e-15);
  EXPECT_TRUE(Part<2>::ball({0, 0}, 1).clip(face).empty());
}

TEST(Part, ClipsInclinedSegments)
{
  const FaceCorners<2> face = {{0, 0}, {4, 3}}; // length 5
  EXPECT_EQ(Part<2>().clip(face), face);
  const auto box = Part<2>::box({0.8, -inf}, {inf, 1.5}).clip(face);
  EXPECT_NEAR(face_area<2>(box), 1.5, 1e-15); // from (0.8, 0.6) to (2, 1.5)
  EXPECT_NEAR((face_centroid<2>(box) - Vector<2>(1.4, 1.05)).norm(), 0, 1e-15);
  EXPECT_TRUE(Part<2>::box({3, -inf}, {inf, 2}).clip(face).empty());
  const auto disc = Part<2>::ball({4. - 0.6, 3. + 0.8}, std::sqrt(2.)); // 1 off the end
  EXPECT_NEAR(face_area<2>(disc.clip(face)), 1, 1e-14) << "from 1 before the end on";
  EXPECT_NEAR((disc.clip(face)[1] - face[1]).norm(), 0, 0) << "the end itself, not its neighbour";
  EXPECT_NEAR(face_area<2>(Part<2>::ball({2, 1.5}, 0.5).clip(face)), 1, 1e-14);
  EXPECT_TRUE(Part<2>::ball({0, 3}, 2.3).clip(face).empty()) << "2.4 away";
}

TEST(Part, TakesInclinedFacesByTheirCentroid)
{
  const FaceCorners<3> face = {{0, 0, 0}, {1, 0, 1}, {1, 1, 1}, {0, 1, 0}};
  EXPECT_EQ(Part<3>::box({-inf, -inf, 0.4}, {inf, inf, inf}).clip(face), face);
  EXPECT_TRUE(Part<3>::box({-inf, -inf, 0.6}, {inf, inf, inf}).clip(face).empty());
  EXPECT_EQ(Part<3>::ball({0.5, 0.5, 0.5}, 0.1).clip(face), face);
}

TEST(Part, ClipsPolygons)
{
  const FaceCorners<3> face = {{0, 0, 5}, {4, 0, 5}, {4, 2, 5}, {0, 2, 5}};
  const auto box = Part<3>::box({1, 0.5, -inf}, {inf, 1, inf});
  EXPECT_DOUBLE_EQ(face_area<3>(box.clip(face)), 1.5);
  EXPECT_NEAR((face_centroid<3>(box.clip(face)) - Vector<3>(2.5, 0.75, 5)).norm(), 0, 1e-15);
  const auto ball = Part<3>::ball({2, 1, 5.3}, 0.5); // a disc of radius 0.4
  EXPECT_NEAR(face_area<3>(ball.clip(face)), M_PI * 0.16, 1e-15);
  EXPECT_NEAR((face_centroid<3>(ball.clip(face)) - Vector<3>(2, 1, 5)).norm(), 0, 1e-15);
}

// Cells tile a side: what a part takes of them must be what it takes of the whole.
TEST(Part, PiecesOfATiledSideAddUp)
{
  const FaceCorners<3> left = {{0, 0, 0}, {1.3, 0, 0}, {0.9, 2, 0}, {0, 2, 0}},
                       right = {{1.3, 0, 0}, {4, 0, 0}, {4, 2, 0}, {0.9, 2, 0}};
  for (const auto &part :
       {Part<3>::ball({1, 1, 0}, 0.7), Part<3>::box({0.3, 0.2, -1}, {2, 1.7, 1})}) {
    double sum = 0;
    Vector<3> moment = Vector<3>::Zero();
    for (const auto &face : {left, right}) {
      const auto piece = part.clip(face);
      sum += face_area<3>(piece);
      moment += face_area<3>(piece) * face_centroid<3>(piece);
    }
    const auto whole = part.clip(side_corners<3>({0, 0, 0}, {4, 2, 1}, 4));
    EXPECT_NEAR(sum, face_area<3>(whole), 1e-14);
    EXPECT_NEAR((moment / sum - face_centroid<3>(whole)).norm(), 0, 1e-14);
  }
}

TEST(Part, HoldsWhatLiesInside)
{
  EXPECT_TRUE(Part<2>().holds({7, 7}, 0));
  EXPECT_TRUE(Part<2>::box({0, -inf}, {1, inf}).holds({1 + 1e-12, 3}, 1e-9));
  EXPECT_FALSE(Part<2>::box({0, -inf}, {1, inf}).holds({1.1, 3}, 1e-9));
  EXPECT_TRUE(Part<3>::ball({0, 0, 0}, 1).holds({0.5, 0.5, 0.5}, 0));
  EXPECT_FALSE(Part<3>::ball({0, 0, 0}, 1).holds({0.7, 0.7, 0.7}, 0));
}
} // namespace
