// Orientations follow their spins exactly, at any angle per step.
#include "particles/turn_orientations.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <vector>

namespace ligament::particles
{
TEST(TurnOrientations, ExactForAConstantSpin)
{
  // On both sides of where the series ends, vectors with both kinds, and a rest.
  const std::vector<double> angles = {0,     1e-9,  1e-4, 0.01, 0.0199, 0.0201, 0.1,
                                      1.,    3.,    1e-6, 0.5,  0.002,  0.003,  0.004,
                                      0.005, 0.006, 2.,   1e-3, 1e-5};
  const int n = int(angles.size());
  const double dt = 0.25;
  const Eigen::Vector3d axis = Eigen::Vector3d(1, -2, 0.5).normalized();
  const Eigen::Quaterniond start(
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.2, 0.3, -1).normalized()));
  std::vector<double> q[4], w[3];
  for (const double angle : angles) {
    for (int c = 0; c < 3; ++c)
      w[c].push_back(angle / dt * axis[c]);
    q[0].push_back(start.w()), q[1].push_back(start.x());
    q[2].push_back(start.y()), q[3].push_back(start.z());
  }
  turn_orientations({q[0].data(), q[1].data(), q[2].data(), q[3].data()},
                    {w[0].data(), w[1].data(), w[2].data()}, dt, n);
  for (int i = 0; i < n; ++i) {
    const Eigen::Quaterniond expected =
        Eigen::Quaterniond(Eigen::AngleAxisd(angles[i], axis)) * start;
    const double round_off = 1e-15;
    EXPECT_NEAR(q[0][i], expected.w(), round_off) << angles[i];
    EXPECT_NEAR(q[1][i], expected.x(), round_off) << angles[i];
    EXPECT_NEAR(q[2][i], expected.y(), round_off) << angles[i];
    EXPECT_NEAR(q[3][i], expected.z(), round_off) << angles[i];
  }
}
} // namespace ligament::particles
