// One cell of any convex shape: its map, shares, stiffness, quality, and finding it in a mesh.
#include "core/check.h"
#include "core/extremes.h"
#include "tests/support/distorted_meshes.h"
#include "tests/unit/fem/meshes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace ligament::fem
{
namespace
{
constexpr double lambda = 3, shear = 2;

template <int dim>
Vector<dim> random_place(std::mt19937 &random, double from = 0, double to = 1)
{
  std::uniform_real_distribution<double> uniform(from, to);
  Vector<dim> s;
  for (int k = 0; k < dim; ++k)
    s[k] = uniform(random);
  return s;
}

template <int dim>
CellVectors<dim> box_corners(const Vector<dim> &lower, const Vector<dim> &size)
{
  CellVectors<dim> corners;
  for (int a = 0; a < n_cell_nodes<dim>; ++a)
    corners.col(a) = lower + corner<dim>(size, a);
  return corners;
}

/// Some rotation.
template <int dim>
Eigen::Matrix<double, dim, dim> rotation()
{
  if constexpr (dim == 2)
    return Eigen::Rotation2Dd(0.7).toRotationMatrix();
  else
    return Eigen::AngleAxisd(0.7, Vector<3>(1, -2, 3).normalized()).toRotationMatrix();
}

template <int dim>
void check_map()
{
  std::mt19937 random(2);
  for (int i = 0; i < 200; ++i) {
    const CellVectors<dim> corners = random_corners<dim>(random, 0.2);
    const Vector<dim> s = random_place<dim>(random), x = cell_point<dim>(corners, s);
    const auto found = unit_place<dim>(corners, x);
    ASSERT_TRUE(found);
    EXPECT_LT((*found - s).norm(), 1e-13);
    // u = A x has the gradient A.
    const CellVectors<dim> gradients = shape_gradients_at<dim>(corners, s);
    EXPECT_LT(
        (corners * gradients.transpose() - Eigen::Matrix<double, dim, dim>::Identity()).norm(),
        1e-12);
    EXPECT_LT(gradients.rowwise().sum().norm(), 1e-12);
  }
}

/// Sums over many small parts of the cell: midpoints, of second order.
template <int dim>
void check_shares()
{
  constexpr int n = dim == 2 ? 400 : 60;
  std::mt19937 random(4);
  const CellVectors<dim> corners = random_corners<dim>(random, 0.2);
  Vec<n_cell_nodes<dim>> expected = Vec<n_cell_nodes<dim>>::Zero();
  for (int part = 0; part < std::lround(std::pow(n, dim)); ++part) {
    Vector<dim> s;
    for (int c = 0, rest = part; c < dim; ++c, rest /= n)
      s[c] = (rest % n + 0.5) / n;
    expected +=
        cell_jacobian<dim>(corners, s).determinant() * std::pow(n, -dim) * shape_values_at<dim>(s);
  }
  const auto shares = volume_shares<dim>(corners);
  EXPECT_LT((shares - expected).norm(), 1. / (n * n) * expected.norm());
  EXPECT_GT(shares.minCoeff(), 0);
  EXPECT_GT(shares.maxCoeff() - shares.minCoeff(), 1e-3); // they do differ
}

template <int dim>
void check_stiffness()
{
  const Stiffness<dim> c = isotropic<dim>(lambda, shear);
  Vector<dim> size;
  for (int k = 0; k < dim; ++k)
    size[k] = 0.4 + 0.3 * k;
  const Vector<dim> lower = Vector<dim>::Constant(-0.7);
  const CellMatrix<dim> box = cell_stiffness<dim>(size, c, 0.3);
  const CellMatrix<dim> general = cell_stiffness<dim>(box_corners<dim>(lower, size), c, 0.3);
  EXPECT_LT((general - box).norm(), 1e-14 * box.norm());

  // A turned box is a box for those who turn with it.
  const auto r = rotation<dim>();
  CellMatrix<dim> turn = CellMatrix<dim>::Zero();
  for (int a = 0; a < n_cell_nodes<dim>; ++a)
    turn.template block<dim, dim>(dim * a, dim * a) = r;
  const CellMatrix<dim> turned =
      cell_stiffness<dim>(CellVectors<dim>(r * box_corners<dim>(lower, size)), c, 0.3);
  EXPECT_LT((turned - turn * box * turn.transpose()).norm(), 1e-13 * box.norm());

  // Nothing but rigid motion is free, however the cell is shaped.
  std::mt19937 random(5);
  for (int i = 0; i < 50; ++i) {
    const CellMatrix<dim> k = cell_stiffness<dim>(random_corners<dim>(random, 0.2), c, 1);
    const auto values = Eigen::SelfAdjointEigenSolver<CellMatrix<dim>>(k).eigenvalues();
    constexpr int n_rigid = dim * (dim + 1) / 2;
    EXPECT_LT(values.head(n_rigid).cwiseAbs().maxCoeff(),
              1e-13 * values[dim * n_cell_nodes<dim> - 1]);
    EXPECT_GT(values[n_rigid], 1e-2 * shear);
  }
}

template <int dim>
void check_faces()
{
  std::mt19937 random(6);
  const CellVectors<dim> corners = slant<dim>() * random_corners<dim>(random, 0);
  Vector<dim> sum = Vector<dim>::Zero();
  double volume = 0; // int x . n dA = dim V
  for (int face = 0; face < 2 * dim; ++face) {
    const auto shares = face_shares<dim>(corners, face);
    const Vector<dim> normal = face_normal<dim>(corners, face);
    EXPECT_NEAR(shares.sum(), core::face_area<dim>(face_corners<dim>(corners, face)), 1e-14);
    for (int a = 0; a < n_cell_nodes<dim>; ++a) {
      EXPECT_EQ(shares[a] != 0, (a >> (face / 2) & 1) == face % 2);
      sum += shares[a] * normal;
      volume += shares[a] * normal.dot(corners.col(a)) / dim;
    }
  }
  EXPECT_LT(sum.norm(), 1e-14);
  EXPECT_NEAR(volume, volume_shares<dim>(corners).sum(), 1e-14);
}

template <int dim>
void check_locator(const Mesh<dim> &mesh, const MeshParameters<dim> &p)
{
  const CellLocator<dim> locator(mesh);
  // Outside a face, by its outward normal: the cells' faces must be plane for it (2D, or a map that
  // is affine).
  const auto holds = [&](int cell, const Vector<dim> &x) {
    const CellVectors<dim> corners = cell_corners(mesh, cell);
    for (int face = 0; face < 2 * dim; ++face) {
      const auto outline = face_corners<dim>(corners, face);
      if (face_normal<dim>(corners, face).dot(x - outline[0]) > 1e-9)
        return false;
    }
    return true;
  };
  std::mt19937 random(7);
  int n_inside = 0, n_general = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vector<dim> x =
        p.lower + (p.upper - p.lower).cwiseProduct(random_place<dim>(random, -0.1, 1.1));
    Vector<dim> place;
    const int found = locator.find(x, &place);
    bool any = false;
    for (int cell = 0; cell < mesh.n_cells(); ++cell)
      any = any || holds(cell, x);
    ASSERT_EQ(found >= 0, any);
    if (found < 0)
      continue;
    ++n_inside;
    n_general += !mesh.is_box(found);
    EXPECT_TRUE(holds(found, x));
    EXPECT_LT((cell_point<dim>(cell_corners(mesh, found), place) - x).norm(), 1e-12);
    EXPECT_LT((shape_values(mesh, found, x) - shape_values_at<dim>(place)).norm(), 1e-11);
  }
  EXPECT_GT(n_inside, 100);
  EXPECT_GT(n_general, 100);
  for (int cell = 0; cell < mesh.n_cells(); ++cell)
    for (const int node : mesh.cells[cell])
      EXPECT_GE(locator.find(mesh.nodes[node]), 0);
}

std::string message_of(const Mesh<2> &mesh)
{
  try {
    require_convex(mesh);
  } catch (const core::InputError &error) {
    return error.what();
  }
  return "";
}
} // namespace

TEST(GeneralCell, has_places_and_gradients_of_linear_fields)
{
  check_map<2>();
  check_map<3>();
}
TEST(GeneralCell, shares_its_volume_among_its_corners)
{
  check_shares<2>();
  check_shares<3>();
}
TEST(GeneralCell, is_a_box_where_it_has_its_shape_and_keeps_rigid_motion_free)
{
  check_stiffness<2>();
  check_stiffness<3>();
}
TEST(GeneralCell, has_faces_that_close)
{
  check_faces<2>();
  check_faces<3>();
}

TEST(GeneralCell, is_found_by_its_points)
{
  const auto p = incommensurate(ring<2>());
  check_locator(distorted(make_mesh(p), 0.2), p);
  const auto solid = incommensurate(ring<3>());
  const auto mesh = make_mesh(solid);
  check_locator(mapped(mesh, [](const Vector<3> &x) -> Vector<3> { return slant<3>() * x; }),
                solid);
}

TEST(GeneralCell, tells_boxes_from_others)
{
  const auto mesh = make_mesh(ring<2>());
  auto same = mesh;
  find_cell_shapes(same);
  EXPECT_TRUE(same.general.empty());
  for (int cell = 0; cell < mesh.n_cells(); ++cell) {
    EXPECT_LT((same.cell_lower[cell] - mesh.cell_lower[cell]).norm(), 1e-14);
    EXPECT_LT((same.cell_size[cell] - mesh.cell_size[cell]).norm(), 1e-14);
  }
  const auto some = distorted(mesh, 0.2, 1, [](const Vector<2> &x) { return x[0] > 1; });
  int n_general = 0;
  for (int cell = 0; cell < mesh.n_cells(); ++cell) {
    n_general += !some.is_box(cell);
    const bool is_left = mesh.cell_lower[cell][0] + mesh.cell_size[cell][0] < 1;
    EXPECT_TRUE(!is_left || some.is_box(cell));
  }
  EXPECT_GT(n_general, 50);
}

TEST(GeneralCell, has_a_quality)
{
  CellVectors<2> corners = box_corners<2>({0, 0}, {2, 1});
  EXPECT_DOUBLE_EQ(scaled_jacobian<2>(corners), 1);
  EXPECT_DOUBLE_EQ(worst_angle<2>(corners), 90);
  corners(0, 2) += 1; // upper corners to the right: a parallelogram of 45 degrees
  corners(0, 3) += 1;
  EXPECT_NEAR(scaled_jacobian<2>(corners), std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(worst_angle<2>(corners), 135, 1e-12);
  corners.col(3) = Vector<2>(0.9, 0.4); // turned in
  EXPECT_LT(scaled_jacobian<2>(corners), 0);
  EXPECT_GT(worst_angle<2>(corners), 180);
  const CellVectors<3> slanted = slant<3>() * box_corners<3>({0, 0, 0}, {1, 1, 1});
  const Eigen::Matrix3d edges = slant<3>().colwise().normalized();
  EXPECT_NEAR(scaled_jacobian<3>(slanted), edges.determinant(), 1e-14);
  double least_cosine = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < i; ++j)
      keep_smallest(least_cosine, -std::abs(edges.col(i).dot(edges.col(j))));
  EXPECT_NEAR(worst_angle<3>(slanted), std::acos(least_cosine) * 180 / M_PI, 1e-12);
}

TEST(GeneralCell, is_refused_with_its_place_where_it_is_not_convex)
{
  Mesh<2> mesh;
  mesh.nodes = {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {2, 0}, {2, 1}};
  mesh.cells = {{0, 1, 2, 3}, {1, 4, 3, 5}};
  mesh.nodes[5] = {1.52, 0.5}; // between its neighbours (2, 0) and (1, 1), hardly outside
  find_cell_shapes(mesh);
  ASSERT_TRUE(mesh.is_box(0));
  ASSERT_FALSE(mesh.is_box(1));
  const std::string text = message_of(mesh);
  EXPECT_NE(text.find("(1.38, 0.375) m"), std::string::npos) << text;
  EXPECT_NE(text.find("177."), std::string::npos) << text;
  mesh.nodes[5] = {1.8, 0.8};
  find_cell_shapes(mesh);
  EXPECT_EQ(message_of(mesh), "");

  Mesh<3> solid;
  for (int a = 0; a < 8; ++a)
    solid.nodes.push_back(corner<3>({1, 1, 1}, a));
  solid.cells = {{0, 1, 2, 3, 4, 5, 6, 7}};
  solid.nodes[7] = {0.7, 0.7, 0.7};
  find_cell_shapes(solid);
  EXPECT_NO_THROW(require_convex(solid));
  solid.nodes[7] = {0.65, 0.65, 0.65}; // behind the plane of its three neighbours
  find_cell_shapes(solid);
  EXPECT_THROW(require_convex(solid), core::InputError);
}
} // namespace ligament::fem
