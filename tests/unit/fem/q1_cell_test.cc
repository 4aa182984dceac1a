// Shape functions, strain matrix, cell stiffness, and the cell of a point.
#include "tests/unit/fem/meshes.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <algorithm>

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

/// Appends the eigenvalues of a symmetric matrix.
void append(std::vector<double> &values, const Eigen::MatrixXd &m)
{
  const Eigen::VectorXd e = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(m).eigenvalues();
  values.insert(values.end(), e.begin(), e.end());
}

/// The same from formulas. By the parities of the cell its motions fall apart: in axes xi from -1
/// to 1 stretches u_k = xi_k; shears; bending u_k = xi_k xi_m about a plane m = 0, whose layers
/// take the strain across them that costs least; in 3D twists u_k = xi_l xi_m, of which nothing is
/// relieved, and u_k = xi_0 xi_1 xi_2, whose strain kk sheds its change of volume. The square of
/// each xi has the mean 1/3.
template <int dim>
Eigen::VectorXd expected_eigenvalues(const Vector<dim> &size, double nu)
{
  const double lambda = 2 * nu / (1 - 2 * nu), corners = n_cell_nodes<dim>;
  const Vector<dim> rate = 2 * size.cwiseInverse(); // of xi over x
  const Eigen::MatrixXd rates = rate * rate.transpose();
  const auto normal_stiffness = [](int n, double diagonal, double other) {
    return Eigen::MatrixXd(Eigen::MatrixXd::Constant(n, n, other) +
                           (diagonal - other) * Eigen::MatrixXd::Identity(n, n));
  };
  std::vector<double> values(dim + n_spins<dim>, 0.);
  append(values, normal_stiffness(dim, lambda + 2, lambda).cwiseProduct(rates) / corners);
  for (int k = 0; k < dim; ++k)
    for (int l = 0; l < k; ++l)
      values.push_back((rates(k, k) + rates(l, l)) / corners);
  for (int m = 0; m < dim; ++m) {
    const double relieved = lambda - lambda * lambda / (lambda + 2);
    Eigen::VectorXd others(dim - 1);
    for (int k = 0, n = 0; k < dim; ++k)
      if (k != m)
        others[n++] = rate[k];
    append(values, normal_stiffness(dim - 1, relieved + 2, relieved)
                           .cwiseProduct(Eigen::MatrixXd(others * others.transpose())) /
                       (3 * corners));
  }
  if constexpr (dim == 3) {
    Eigen::Matrix3d shears; // kl of the twists k, l
    shears << 0, rate[2], rate[1], rate[2], 0, rate[0], rate[1], rate[0], 0;
    append(values, shears.transpose() * shears / (3 * corners));
    for (int k = 0; k < 3; ++k)
      values.push_back((4. / 3 * rates(k, k) + rates.trace() - rates(k, k)) / (9 * corners));
  }
  std::sort(values.begin(), values.end());
  return Eigen::Map<const Eigen::VectorXd>(values.data(), long(values.size()));
}

/// Nothing but rigid motions costs nothing, and of all the others only the change of volume grows
/// without bound when the body becomes incompressible.
template <int dim>
void check_spectrum()
{
  for (const double nu : {-0.5, 0., 0.3, 0.45, 0.49, 0.4999})
    for (const double slender : {1., 0.2}) {
      SCOPED_TRACE(testing::Message() << "nu " << nu << ", slender " << slender);
      Vector<dim> size = Vector<dim>::Ones();
      size[0] = slender;
      const Eigen::VectorXd e = eigenvalues<dim>(size, nu);
      EXPECT_LT((e - expected_eigenvalues<dim>(size, nu)).cwiseAbs().maxCoeff(),
                1e-12 * e[e.size() - 1]);
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

TEST(CellLocator, finds_what_lies_a_little_outside)
{
  const Mesh<2> mesh = make_mesh(ring<2>());
  const CellLocator<2> locator(mesh);
  for (const int c : {0, mesh.n_cells() - 1}) {
    const Vector<2> &size = mesh.cell_size[c], x = mesh.cell_lower[c] + 0.3 * size;
    EXPECT_EQ(locator.nearest(x, 0.1), c);
  }
  Vector<2> lower = mesh.nodes[0];
  for (const auto &node : mesh.nodes)
    lower = lower.cwiseMin(node);
  const int corner = locator.find(lower);
  const Vector<2> size = mesh.cell_size[corner];
  EXPECT_EQ(locator.find(lower - 0.05 * size), -1);
  EXPECT_EQ(locator.nearest(lower - 0.05 * size, 0.1), corner);
  EXPECT_EQ(locator.nearest(lower - 0.2 * size, 0.1), -1);
}
} // namespace ligament::fem
