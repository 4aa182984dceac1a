#include "packings/voronoi_cell.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace
{
using namespace ligament;
using packings::VoronoiCell;

TEST(VoronoiCell, ACornerCutOffACubeIsATetrahedron)
{
  // x + y + z <= 2 takes the corner (1, 1, 1) with legs of length 1 off the cube of side 2.
  VoronoiCell<3> cell(1, 7, 1e-13);
  EXPECT_DOUBLE_EQ(cell.volume(), 8);
  cell.clip(Vector<3>::Constant(1 / std::sqrt(3.)), 2 / std::sqrt(3.), 8);
  EXPECT_NEAR(cell.volume(), 8 - 1. / 6, 1e-14);
  EXPECT_NEAR(cell.max_radius(), std::sqrt(3.), 1e-15);
  double cube = 0;
  for (const auto &face : cell.faces())
    if (face.id == 8) {
      EXPECT_NEAR(face.area, std::sqrt(3.) / 2, 1e-15);
      EXPECT_NEAR((face.centroid - Vector<3>::Constant(2. / 3)).norm(), 0, 1e-15);
    } else
      cube += face.area;
  EXPECT_NEAR(cube, 6 * 4 - 3 * 0.5, 1e-14);
}

TEST(VoronoiCell, PlanesThatOnlyTouchDoNotCut)
{
  VoronoiCell<2> cell(1, 0, 1e-13);
  EXPECT_FALSE(cell.is_cut_by(Vector<2>(1, 1).normalized(), std::sqrt(2.)));
  EXPECT_FALSE(cell.is_cut_by(Vector<2>(1, 0), 1 - 1e-14));
  EXPECT_TRUE(cell.is_cut_by(Vector<2>(1, 0), 1 - 1e-12));
  cell.clip(Vector<2>(1, 0), 1 - 1e-14, 1);
  for (const auto &face : cell.faces())
    EXPECT_EQ(face.id, 0);
  cell.clip(Vector<2>(-1, 0), -2, 1);
  EXPECT_TRUE(cell.is_empty());
  EXPECT_EQ(cell.volume(), 0);
}

/// Random cuts, many of them through corners of the cell: sum S n = 0, sum S x (x) n = V I.
template <int dim>
void check_random_cuts(int n_cells)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < n_cells; ++trial) {
    VoronoiCell<dim> cell(1, 0, 1e-13);
    for (int n = 1; n < 20; ++n) {
      Vector<dim> normal;
      for (int a = 0; a < dim; ++a)
        normal[a] = uniform(random);
      normal.normalize();
      double distance = 0.6 + 0.2 * uniform(random);
      if (n % 2)
        distance = std::max(0.3, normal.dot(cell.vertices()[n % cell.vertices().size()]));
      cell.clip(normal, distance, n);
    }
    Vector<dim> surface = Vector<dim>::Zero();
    Eigen::Matrix<double, dim, dim> moment = Eigen::Matrix<double, dim, dim>::Zero();
    for (const auto &face : cell.faces()) {
      surface += face.area * face.normal;
      moment += face.area * face.centroid * face.normal.transpose();
    }
    moment -= cell.volume() * Eigen::Matrix<double, dim, dim>::Identity();
    // Corners are true to the tolerance 1e-13.
    EXPECT_LT(surface.norm(), 1e-12);
    EXPECT_LT(moment.norm(), 1e-12);
  }
}

TEST(VoronoiCell, StaysClosed)
{
  check_random_cuts<2>(300);
  check_random_cuts<3>(300);
}
} // namespace
