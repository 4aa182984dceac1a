// Shape functions, strain matrix, cell stiffness, and the cell of a point.
#include "tests/unit/fem/meshes.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace ligament::fem
{
namespace
{
template <int dim>
void check_shape_functions()
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  const Vector<dim> lower = Vector<dim>::Constant(0.4);
  Vector<dim> size, p;
  for (int k = 0; k < dim; ++k) {
    size[k] = 0.5 + 0.25 * k;
    p[k] = lower[k] + size[k] * uniform(random);
  }
  Eigen::Matrix<double, dim, n_cell_nodes<dim>> corners;
  for (int a = 0; a < n_cell_nodes<dim>; ++a)
    for (int k = 0; k < dim; ++k)
      corners(k, a) = lower[k] + (a >> k & 1 ? size[k] : 0.);

  const auto values = shape_values<dim>(lower, size, p);
  EXPECT_NEAR(values.sum(), 1, 1e-15);
  EXPECT_LT((corners * values - p).norm(), 1e-15);
  for (int a = 0; a < n_cell_nodes<dim>; ++a)
    EXPECT_DOUBLE_EQ((shape_values<dim>(lower, size, corners.col(a))[a]), 1);

  // Linear fields have their gradient; a product of coordinates by central differences (exact).
  const auto gradients = shape_gradients<dim>(lower, size, p);
  EXPECT_LT((gradients * corners.transpose() - Eigen::Matrix<double, dim, dim>::Identity()).norm(),
            1e-14);
  for (int k = 0; k < dim; ++k) {
    const Vector<dim> d = 0.1 * Vector<dim>::Unit(k);
    const auto difference =
        ((shape_values<dim>(lower, size, p + d) - shape_values<dim>(lower, size, p - d)) / 0.2)
            .eval();
    EXPECT_LT((gradients.row(k).transpose() - difference).norm(), 1e-14);
  }

  // Strain of u = A x: symmetric part of A, shears doubled.
  Eigen::Matrix<double, dim, dim> a;
  for (int i = 0; i < dim * dim; ++i)
    a.data()[i] = uniform(random);
  const Eigen::Matrix<double, dim, n_cell_nodes<dim>> u = a * corners;
  const Strain<dim> strain =
      strain_matrix<dim>(gradients) * Eigen::Map<const Vec<dim * n_cell_nodes<dim>>>(u.data());
  Strain<dim> expected;
  if constexpr (dim == 2)
    expected << a(0, 0), a(1, 1), a(0, 1) + a(1, 0);
  else
    expected << a(0, 0), a(1, 1), a(2, 2), a(1, 2) + a(2, 1), a(0, 2) + a(2, 0), a(0, 1) + a(1, 0);
  EXPECT_LT((strain - expected).norm(), 1e-14);

  // Energy of that strain; for the hourglass u_0 = x_0 x_1 (local coordinates from the middle) that
  // of pure bending, e_00 = x_1 and no stress s_01, s_11 (3D: e_22 = 0).
  const Stiffness<dim> c = isotropic<dim>(3, 2);
  const double t = 0.7;
  const auto k = cell_stiffness<dim>(size, c, t);
  const Vec<dim * n_cell_nodes<dim>> uv = Eigen::Map<const Vec<dim * n_cell_nodes<dim>>>(u.data());
  const double energy = expected.dot(c * expected) * size.prod() * t;
  EXPECT_NEAR(uv.dot(k * uv), energy, 1e-14 * energy);
  Vec<dim * n_cell_nodes<dim>> hourglass;
  hourglass.setZero();
  for (int i = 0; i < n_cell_nodes<dim>; ++i)
    hourglass[dim * i] =
        (corners(0, i) - lower[0] - size[0] / 2) * (corners(1, i) - lower[1] - size[1] / 2);
  const double moments = (c(0, 0) - c(0, 1) * c(0, 1) / c(1, 1)) * size[1] * size[1] / 12;
  EXPECT_NEAR(hourglass.dot(k * hourglass), moments * size.prod() * t,
              1e-14 * moments * size.prod());
}

/// Eigenvalues of the stiffness of a cell of shear modulus 1, over its volume.
template <int dim>
Eigen::VectorXd eigenvalues(const Vector<dim> &size, double nu)
{
  const Eigen::MatrixXd k = cell_stiffness<dim>(size, isotropic<dim>(2 * nu / (1 - 2 * nu), 1), 1);
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k).eigenvalues() / size.prod();
}

/// Nothing but rigid motions costs nothing, and of all the others only the change of volume grows
/// without bound when the body becomes incompressible.
template <int dim>
void check_spectrum()
{
  constexpr int n_rigid = dim + n_spins<dim>;
  for (const double nu : {-0.5, 0., 0.3, 0.45, 0.49, 0.4999})
    for (const double slender : {1., 0.2}) {
      SCOPED_TRACE(testing::Message() << "nu " << nu << ", slender " << slender);
      Vector<dim> size = Vector<dim>::Ones();
      size[0] = slender;
      const Eigen::VectorXd e = eigenvalues<dim>(size, nu);
      EXPECT_LT(e.head(n_rigid).cwiseAbs().maxCoeff(), 1e-13 * e[e.size() - 1]);
      EXPECT_GT(e[n_rigid], 0.01);
      EXPECT_LT(e[e.size() - 2], 3 * 2 / (slender * slender)); // 2 G times B^2
    }
}

template <int dim>
void check_locator(const MeshParameters<dim> &p)
{
  const Mesh<dim> mesh = make_mesh(p);
  const CellLocator<dim> locator(mesh);
  const auto holds = [&](int c, const Vector<dim> &x) {
    const Vector<dim> s = (x - mesh.cell_lower[c]).cwiseQuotient(mesh.cell_size[c]);
    return s.minCoeff() >= -1e-10 && s.maxCoeff() <= 1 + 1e-10;
  };
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-0.1, 1.1);
  int n_inside = 0;
  for (int i = 0; i < 500; ++i) {
    Vector<dim> x;
    for (int k = 0; k < dim; ++k)
      x[k] = p.lower[k] + (p.upper[k] - p.lower[k]) * uniform(random);
    int expected = -1;
    for (int c = 0; c < mesh.n_cells(); ++c)
      if (holds(c, x))
        expected = c;
    EXPECT_EQ(locator.find(x), expected);
    n_inside += expected >= 0;
  }
  EXPECT_GT(n_inside, 100);
  for (int c = 0; c < mesh.n_cells(); ++c)
    for (const int node : mesh.cells[c]) // on shared corners and on the specimen's sides
    {
      const int found = locator.find(mesh.nodes[node]);
      ASSERT_GE(found, 0);
      EXPECT_TRUE(holds(found, mesh.nodes[node]));
    }
  EXPECT_EQ(locator.find(Vector<dim>::Constant(NAN)), -1);
  EXPECT_EQ(locator.find(Vector<dim>::Constant(1e300)), -1);
  EXPECT_EQ(locator.find((p.inner[0].lower + p.inner[0].upper) / 2), -1);
}
} // namespace

TEST(Q1Cell, shape_functions_and_stiffness_in_2d)
{
  check_shape_functions<2>();
}
TEST(Q1Cell, shape_functions_and_stiffness_in_3d)
{
  check_shape_functions<3>();
}

TEST(Q1Cell, bends_and_keeps_its_volume_without_locking_in_2d)
{
  check_spectrum<2>();
}
TEST(Q1Cell, bends_and_keeps_its_volume_without_locking_in_3d)
{
  check_spectrum<3>();
}

TEST(CellLocator, agrees_with_looking_at_all_cells)
{
  check_locator(ring<2>());
  check_locator(incommensurate(ring<2>()));
  check_locator(incommensurate(band<3>()));
}
} // namespace ligament::fem
