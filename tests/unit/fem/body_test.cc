// Cells of bodies that are anisotropic or bear a stress in the reference, and how fast waves leave
// them.
#include "fem/body.h"

#include "fem/cell_map.h"
#include "tests/support/distorted_meshes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <random>

namespace ligament::fem
{
namespace
{
template <int dim>
using Matrix = Eigen::Matrix<double, dim, dim>;

/// A_iJkL of theory.md eq. (C23), written out.
template <int dim>
double gradient_stiffness(const Body<dim> &body, int i, int j, int k, int l)
{
  return body.stiffness(voigt_index<dim>(i, j), voigt_index<dim>(k, l)) +
         (i == k ? body.stress[voigt_index<dim>(j, l)] : 0);
}

template <int dim>
Body<dim> some_body(std::mt19937 &random)
{
  std::uniform_real_distribution<double> uniform(-1, 1);
  Body<dim> body;
  const Stiffness<dim> m = Stiffness<dim>::NullaryExpr([&] { return uniform(random); });
  body.stiffness = m * m.transpose() + 2 * Stiffness<dim>::Identity();
  body.stress = Strain<dim>::NullaryExpr([&] { return 0.1 * uniform(random); });
  body.density = 1.7;
  body.thickness = dim == 2 ? 0.6 : 1;
  return body;
}

// Any displacement gradient has the energy 1/2 H : A : H, in boxes and in other cells.
template <int dim>
void check_gradients()
{
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 20; ++trial) {
    const auto body = some_body<dim>(random);
    const Matrix<dim> h = Matrix<dim>::NullaryExpr([&] { return uniform(random); });
    double density = 0;
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        for (int k = 0; k < dim; ++k)
          for (int l = 0; l < dim; ++l)
            density += h(i, j) * gradient_stiffness(body, i, j, k, l) * h(k, l);
    const Vector<dim> size = Vector<dim>::LinSpaced(0.8, 1.3);
    CellVectors<dim> box;
    for (int a = 0; a < n_cell_nodes<dim>; ++a)
      box.col(a) = corner<dim>(size, a);
    const CellVectors<dim> general = random_corners<dim>(random, 0.2);
    const auto energy = [&](const CellMatrix<dim> &k, const CellVectors<dim> &corners) {
      const CellVectors<dim> u = h * corners;
      const Eigen::Map<const Vec<dim * n_cell_nodes<dim>>> flat(u.data());
      return flat.dot(k * flat);
    };
    const double of_box = density * size.prod() * body.thickness,
                 of_general = density * volume_shares<dim>(general).sum() * body.thickness;
    EXPECT_NEAR(energy(cell_stiffness<dim>(size, body), box), of_box, 1e-12);
    EXPECT_NEAR(energy(cell_stiffness<dim>(box, body), box), of_box, 1e-12);
    EXPECT_NEAR(energy(cell_stiffness<dim>(general, body), general), of_general, 1e-12);
  }
}

TEST(Body, EveryDisplacementGradientHasItsEnergy)
{
  check_gradients<2>();
  check_gradients<3>();
}

// Squares of the root's eigenvalues, by a way of their own.
TEST(Body, WavesLeaveWithTheRootOfTheAcousticTensor)
{
  std::mt19937 random(5);
  for (int axis = 0; axis < 2; ++axis) {
    const auto body = some_body<2>(random);
    Matrix<2> acoustic;
    for (int i = 0; i < 2; ++i)
      for (int k = 0; k < 2; ++k)
        acoustic(i, k) = gradient_stiffness(body, i, axis, k, axis) / body.density;
    const double root_of_determinant = std::sqrt(acoustic.determinant());
    const Matrix<2> root = (acoustic + root_of_determinant * Matrix<2>::Identity()) /
                           std::sqrt(acoustic.trace() + 2 * root_of_determinant);
    EXPECT_LT((normal_wave_speeds(body, axis) - root.diagonal()).norm(), 1e-14);
  }
}

// A cubic crystal with a face diagonal along x.
TEST(Body, WaveSpeedsOfACrystalAlongAFaceDiagonal)
{
  const double c11 = 168, c12 = 121, c44 = 75; // copper, GPa
  Body<3> body;
  body.density = 1;
  body.stiffness.setZero();
  const double in_plane = (c11 + c12) / 2 + c44;
  body.stiffness(0, 0) = body.stiffness(1, 1) = in_plane;
  body.stiffness(2, 2) = c11;
  body.stiffness(0, 1) = body.stiffness(1, 0) = (c11 + c12) / 2 - c44;
  body.stiffness(3, 3) = body.stiffness(4, 4) = c44;
  body.stiffness(5, 5) = (c11 - c12) / 2;
  const Vector<3> speeds = normal_wave_speeds(body, 0);
  EXPECT_DOUBLE_EQ(speeds[0], std::sqrt(in_plane));
  EXPECT_DOUBLE_EQ(speeds[1], std::sqrt((c11 - c12) / 2));
  EXPECT_DOUBLE_EQ(speeds[2], std::sqrt(c44));
}
} // namespace
} // namespace ligament::fem
