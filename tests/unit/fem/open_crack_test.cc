// Cracks as doubled nodes: what comes apart, what holds, what is refused.
#include "algebra/conjugate_gradients.h"
#include "core/check.h"
#include "core/extremes.h"
#include "fem/fem_solver.h"
#include "fem/open_crack.h"
#include "tests/support/distorted_meshes.h"
#include "tests/unit/fem/meshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace ligament::fem
{
namespace
{
constexpr double lambda = 3, shear = 2;

Body<2> body()
{
  return {isotropic<2>(lambda, shear), 0.5, 1};
}

Mesh<2> plate(double width = 2, double height = 1)
{
  return make_mesh(box<2>({width, height}, 0.1));
}

/// Largest force of the cells for the displacement u(x, where the node's cells lie).
template <typename Motion>
double largest_force(const Mesh<2> &mesh, Motion &&motion)
{
  std::vector<Vector<2>> towards(mesh.n_nodes(), Vector<2>::Zero());
  for (int cell = 0; cell < mesh.n_cells(); ++cell)
    for (const int node : mesh.cells[cell])
      towards[node] += cell_corners(mesh, cell).rowwise().mean() - mesh.nodes[node];
  FemSolver<2> solver(mesh, body(), {});
  for (int i = 0; i < mesh.n_nodes(); ++i)
    set<2>(solver.displacement, i, motion(mesh.nodes[i], towards[i]));
  solver.compute_forces(0);
  double largest = 0;
  for (const auto &f : solver.force)
    for (const double x : f)
      keep_largest(largest, std::abs(x));
  return largest;
}

/// Both sides of the line y = `height` move as bodies of their own.
double force_of_halves(const Mesh<2> &mesh, double height)
{
  return largest_force(mesh, [&](const Vector<2> &x, const Vector<2> &towards) -> Vector<2> {
    const double above = x[1] + 1e-3 * towards[1] - height;
    return above > 0 ? Vector<2>(0.2 - 0.3 * x[1], 0.5 + 0.3 * x[0]) : Vector<2>(-0.1, 0);
  });
}

std::string message_of(Mesh<2> mesh, const std::vector<Vector<2>> &line)
{
  const Mesh<2> before = mesh;
  try {
    open_crack(mesh, line);
  } catch (const core::InputError &error) {
    EXPECT_EQ(mesh.n_nodes(), before.n_nodes());
    EXPECT_EQ(mesh.cells, before.cells);
    EXPECT_EQ(mesh.boundary_faces.size(), before.boundary_faces.size());
    return error.what();
  }
  return "";
}

TEST(OpenCrack, DoublesTheNodesOfItsFlanksAndKeepsTheTip)
{
  Mesh<2> mesh = plate();
  const int n = mesh.n_nodes(), n_faces = int(mesh.boundary_faces.size());
  open_crack(mesh, {{-0.3, 0.5}, {0.7, 0.5}}); // from outside: seven edges
  EXPECT_EQ(mesh.n_nodes(), n + 7);
  EXPECT_EQ(int(mesh.boundary_faces.size()), n_faces + 14);
  for (int a = 0; a < mesh.n_cells(); ++a)
    for (int b = 0; b < mesh.n_cells(); ++b) {
      const bool across = mesh.cell_lower[a][1] > 0.45 && mesh.cell_lower[b][1] < 0.45;
      for (const int node : mesh.cells[a])
        for (const int other : mesh.cells[b])
          EXPECT_FALSE(across && node == other && mesh.nodes[node][0] < 0.69);
    }
  // Inside the plate both tips stay.
  Mesh<2> inside = plate();
  open_crack(inside, {{0.5, 0.5}, {1.1, 0.5}});
  EXPECT_EQ(inside.n_nodes(), n + 5);
  // Of one edge nothing comes apart.
  Mesh<2> one = plate();
  open_crack(one, {{0.5, 0.5}, {0.6, 0.5}});
  EXPECT_EQ(one.n_nodes(), n);
}

TEST(OpenCrack, PartsAPlateThatItCrosses)
{
  Mesh<2> mesh = plate();
  const double held = force_of_halves(mesh, 0.4);
  open_crack(mesh, {{0, 0.4}, {2, 0.4}});
  EXPECT_EQ(mesh.n_nodes(), plate().n_nodes() + 21);
  EXPECT_GT(held, 0.1);
  EXPECT_LT(force_of_halves(mesh, 0.4), 1e-14);
  // Between it and the upper side a second one, then a third across that: four pieces.
  open_crack(mesh, {{1, 0.4}, {1, 1}});
  open_crack(mesh, {{0, 0.7}, {2.5, 0.7}});
  std::vector<int> piece(mesh.n_nodes());
  for (int i = 0; i < mesh.n_nodes(); ++i)
    piece[i] = i;
  for (int sweep = 0; sweep < 100; ++sweep)
    for (const auto &cell : mesh.cells) {
      int least = piece[cell[0]];
      for (const int node : cell)
        least = std::min(least, piece[node]);
      for (const int node : cell)
        piece[node] = least;
    }
  EXPECT_EQ(std::set<int>(piece.begin(), piece.end()).size(), 5u);
}

TEST(OpenCrack, DoesNotFeelTensionAlongIt)
{
  Mesh<2> mesh = mapped(
      distorted(plate(), 0.2, 1, [](const Vector<2> &x) { return std::abs(x[1] - 0.5) > 0.05; }),
      [](const Vector<2> &x) -> Vector<2> { return slant<2>() * x; });
  const Vector<2> from = slant<2>() * Vector<2>(0.4, 0.5), to = slant<2>() * Vector<2>(1.3, 0.5);
  const Vector<2> along = (to - from).normalized(), across(-along[1], along[0]);
  // Uniaxial stress along the crack.
  const double contraction = lambda / (lambda + 2 * shear);
  const Eigen::Matrix2d gradient =
      along * along.transpose() - contraction * across * across.transpose();
  open_crack(mesh, {from, to});
  FemSolver<2> solver(mesh, body(), {});
  for (int i = 0; i < mesh.n_nodes(); ++i)
    set<2>(solver.displacement, i, Vector<2>(gradient * mesh.nodes[i]));
  solver.compute_forces(0);
  int n_flank = 0;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const Vector<2> x = mesh.nodes[i] - from;
    if (std::abs(across.dot(x)) < 1e-9 && along.dot(x) > -1e-9 &&
        along.dot(x) < (to - from).norm() + 1e-9)
    {
      ++n_flank;
      EXPECT_LT(get(solver.force, i).norm(), 1e-13);
    }
  }
  EXPECT_EQ(n_flank, 10 + 8);
}

TEST(OpenCrack, CrossesStepsBetweenCellSizes)
{
  Mesh<2> mesh = make_mesh(ring<2>()); // the line y = 0 belongs to cells of all sizes
  ASSERT_FALSE(mesh.hanging.empty());
  open_crack(mesh, {{-2.8, 0}, {-0.4, 0}});
  EXPECT_GT(force_of_halves(mesh, 0), 0.01) << "the other side of the ring holds";
  open_crack(mesh, {{0.8, 0}, {2.8, 0}});
  EXPECT_LT(force_of_halves(mesh, 0), 1e-13);
  const FemSolver<2> solver(mesh, body(), {});
  double mass = 0;
  for (const double m : solver.lumped_mass())
    mass += m;
  double volume = 0;
  for (int cell = 0; cell < mesh.n_cells(); ++cell)
    volume += cell_volume(mesh, cell);
  EXPECT_NEAR(mass, 0.5 * volume, 1e-12 * mass);
}

TEST(OpenCrack, BendsWithItsPolyline)
{
  Mesh<2> mesh = plate();
  open_crack(mesh, {{0, 0.3}, {0.8, 0.3}, {0.8, 1}}); // cuts a corner off: 8 + 7 edges
  EXPECT_EQ(mesh.n_nodes(), plate().n_nodes() + 16);
  const auto force = largest_force(mesh, [](const Vector<2> &x, const Vector<2> &towards) {
    const Vector<2> inside = x + 1e-3 * towards;
    return inside[0] < 0.8 && inside[1] > 0.3 ? Vector<2>(-0.3, 0.2) : Vector<2>(0, 0);
  });
  EXPECT_LT(force, 1e-14);
}

TEST(OpenCrack, IsRefusedWithItsPlaceWhereItLeavesTheEdges)
{
  const Mesh<2> mesh = plate();
  const std::string bent = message_of(mesh, {{0, 0.5}, {0.8, 0.5}, {1.2, 0.7}});
  EXPECT_NE(bent.find("leaves the edges of the cells at (0.8, 0.5) m"), std::string::npos) << bent;
  EXPECT_NE(message_of(mesh, {{0, 0.45}, {1, 0.45}}), "");
  EXPECT_NE(message_of(mesh, {{0, 0.5}, {0.85, 0.5}}).find("at (0.8, 0.5) m"), std::string::npos);
  EXPECT_NE(message_of(mesh, {{0, 0.5}}), "");
  const Mesh<2> graded = make_mesh(ring<2>());
  const HangingNode &h = graded.hanging.front();
  const std::string step =
      message_of(graded, {graded.nodes[h.masters[0].first], graded.nodes[h.masters[1].first]});
  EXPECT_NE(step.find("along a step between cell sizes"), std::string::npos) << step;
}

TEST(OpenCrack, FlanksHaveNamesOfTheirOwn)
{
  const Mesh<2> whole = plate();
  Mesh<2> mesh = whole;
  open_crack(mesh, {{0, 0.5}, {0.7, 0.5}});
  const auto before = node_names<2>(whole, {0, 0}, {2, 1}),
             after = node_names<2>(mesh, {0, 0}, {2, 1});
  for (int i = 0; i < whole.n_nodes(); ++i) {
    const Vector<2> &x = whole.nodes[i];
    const bool on_flank = std::abs(x[1] - 0.5) < 1e-9 && x[0] < 0.69;
    EXPECT_TRUE(on_flank || before.name(i) == after.name(i));
  }
  // The same names whichever copy is the first: cells in another order.
  Mesh<2> turned = whole;
  std::reverse(turned.cells.begin(), turned.cells.end());
  std::reverse(turned.cell_lower.begin(), turned.cell_lower.end());
  for (auto &face : turned.boundary_faces)
    face.cell = turned.n_cells() - 1 - face.cell;
  open_crack(turned, {{0, 0.5}, {0.7, 0.5}});
  const auto names = node_names<2>(turned, {0, 0}, {2, 1});
  for (int cell = 0; cell < mesh.n_cells(); ++cell)
    for (int a = 0; a < 4; ++a)
      EXPECT_EQ(after.name(mesh.cells[cell][a]),
                names.name(turned.cells[mesh.n_cells() - 1 - cell][a]));
}

/// Energy of a strip, 8 x 1, whose long sides are drawn apart by 1, with a crack from the left.
double energy_of_strip(double length)
{
  Mesh<2> mesh = plate(8, 1);
  open_crack(mesh, {{0, 0.5}, {length, 0.5}});
  FemSolver<2> far(mesh, body(), {});
  const int n = mesh.n_nodes();
  const auto is_held = [&](int i) { return std::abs(mesh.nodes[i][1] - 0.5) > 0.499; };
  const auto apply = [&](const Eigen::VectorXd &x, Eigen::VectorXd &y) {
    Components<2> u, f;
    for (int c = 0; c < 2; ++c) {
      u[c].assign(x.data() + c * n, x.data() + (c + 1) * n);
      f[c].assign(n, 0.);
    }
    far.subtract_stiffness(u, f);
    y.resize(2 * n);
    for (int i = 0; i < 2 * n; ++i)
      y[i] = is_held(i % n) ? 0 : -f[i / n][i % n];
  };
  Eigen::VectorXd held = Eigen::VectorXd::Zero(2 * n), right, x;
  for (int i = 0; i < n; ++i)
    if (is_held(i))
      held[n + i] = mesh.nodes[i][1] - 0.5;
  apply(held, right);
  right = -right;
  const auto keep = [](Eigen::VectorXd &) {};
  const auto copy = [](const Eigen::VectorXd &r, Eigen::VectorXd &z) { z = r; };
  algebra::conjugate_gradients(apply, copy, keep, keep, right, x, 1e-11 * right.norm(), 20 * n);
  x += held;
  for (int c = 0; c < 2; ++c)
    far.displacement[c].assign(x.data() + c * n, x.data() + (c + 1) * n);
  return far.potential_energy();
}

// Far from the ends a crack that grows by a cell frees the energy that a cell's width of the strip
// ahead had, whatever the cells: C11/2. What the free end ahead adds falls exponentially.
TEST(OpenCrack, FreesTheEnergyOfTheStripAhead)
{
  const auto error = [](double length) {
    const double freed = energy_of_strip(length) - energy_of_strip(length + 0.1);
    return std::abs(freed / (0.1 * (lambda + 2 * shear) / 2) - 1);
  };
  const double far = error(3.5), near = error(4.5), nearer = error(5.5);
  EXPECT_LT(far, 1e-3);
  EXPECT_LT(far, near / 4);
  EXPECT_NEAR(std::log(nearer / near), std::log(near / far), 0.2); // the same factor again
}
} // namespace
} // namespace ligament::fem
