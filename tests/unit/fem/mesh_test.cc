// The mesh: what it covers, how it is graded, what is refused.
#include "core/check.h"
#include "tests/unit/fem/meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace ligament::fem
{
namespace
{
template <int dim>
double box_volume(const Vector<dim> &lower, const Vector<dim> &upper)
{
  return (upper - lower).cwiseMax(0.).prod();
}

/// Largest distance in one direction of the box [lower, upper] from the inner box, in m.
template <int dim>
double distance(const MeshParameters<dim> &p, const Vector<dim> &lower, const Vector<dim> &upper)
{
  return (p.inner[0].lower - upper).cwiseMax(lower - p.inner[0].upper).cwiseMax(0.).maxCoeff();
}

template <int dim>
void check_volume_and_surface(const MeshParameters<dim> &p)
{
  const Mesh<dim> mesh = make_mesh(p);
  double volume = 0;
  for (const auto &h : mesh.cell_size)
    volume += h.prod();
  const double expected =
      box_volume<dim>(p.lower, p.upper) -
      box_volume<dim>(p.lower.cwiseMax(p.inner[0].lower), p.upper.cwiseMin(p.inner[0].upper));
  EXPECT_NEAR(volume, expected, 1e-12 * expected);

  // Gauss: the integral of x_k n_k over the surface is the volume, so no face is missing.
  Vector<dim> gauss = Vector<dim>::Zero();
  std::set<int> boundaries;
  for (const auto &f : mesh.boundary_faces) {
    const int k = f.face / 2;
    const auto &h = mesh.cell_size[f.cell];
    const double x = mesh.nodes[mesh.cells[f.cell][f.face % 2 ? n_cell_nodes<dim> - 1 : 0]][k];
    gauss[k] += (f.face % 2 ? x : -x) * h.prod() / h[k];
    boundaries.insert(f.boundary);
    if (f.boundary != inner_surface<dim>) {
      EXPECT_EQ(f.boundary, f.face);
      EXPECT_EQ(x, f.face % 2 ? p.upper[k] : p.lower[k]);
    }
  }
  for (int k = 0; k < dim; ++k)
    EXPECT_NEAR(gauss[k], expected, 1e-12 * expected);
  EXPECT_EQ(boundaries.size(), 2u * dim + 1);
}

template <int dim>
void check_grading(const MeshParameters<dim> &p)
{
  const Mesh<dim> mesh = make_mesh(p);
  const double h = p.cell_size, small = 1e-9 * h;
  int coarsest = 0;
  for (int c = 0; c < mesh.n_cells(); ++c) {
    const int level = mesh.cell_level[c];
    coarsest = std::max(coarsest, level);
    const Vector<dim> upper = mesh.cell_lower[c] + mesh.cell_size[c];
    for (int k = 0; k < dim; ++k)
      EXPECT_NEAR(mesh.cell_size[c][k], std::ldexp(h, level), small);
    for (int a = 0; a < n_cell_nodes<dim>; ++a)
      for (int k = 0; k < dim; ++k)
        EXPECT_NEAR(mesh.nodes[mesh.cells[c][a]][k], a >> k & 1 ? upper[k] : mesh.cell_lower[c][k],
                    small);
    // Cells of level l begin behind the fine cells and cells_per_level cells of each level between.
    double begin = level > 0 ? p.fine_cells * h : 0;
    for (int l = 1; l < level; ++l)
      begin += p.cells_per_level * std::ldexp(h, l);
    EXPECT_GE(distance<dim>(p, mesh.cell_lower[c], upper), begin - small);
  }
  EXPECT_EQ(coarsest, p.levels);

  std::set<int> hanging;
  for (const auto &node : mesh.hanging)
    hanging.insert(node.node);
  EXPECT_FALSE(hanging.empty());
  for (const auto &node : mesh.hanging) {
    const Vector<dim> &x = mesh.nodes[node.node];
    EXPECT_GT(distance<dim>(p, x, x), p.fine_cells * h + small) << "hanging in the fine region";
    double sum = 0;
    Vector<dim> interpolated = Vector<dim>::Zero();
    for (const auto &[master, weight] : node.masters) {
      EXPECT_EQ(hanging.count(master), 0u);
      sum += weight;
      interpolated += weight * mesh.nodes[master];
    }
    EXPECT_NEAR(sum, 1., 1e-15);
    EXPECT_LT((interpolated - x).norm(), small);
  }
}

template <int dim>
void check_hanging_nodes_are_complete(const MeshParameters<dim> &p)
{
  // A node is hanging exactly when it lies on a cell without being one of its nodes.
  const Mesh<dim> mesh = make_mesh(p);
  std::set<int> expected, hanging;
  for (int c = 0; c < mesh.n_cells(); ++c)
    for (int i = 0; i < mesh.n_nodes(); ++i) {
      const Vector<dim> s = (mesh.nodes[i] - mesh.cell_lower[c]).cwiseQuotient(mesh.cell_size[c]);
      if (s.minCoeff() > -1e-9 && s.maxCoeff() < 1 + 1e-9 &&
          std::count(mesh.cells[c].begin(), mesh.cells[c].end(), i) == 0)
        expected.insert(i);
    }
  for (const auto &node : mesh.hanging)
    hanging.insert(node.node);
  EXPECT_EQ(hanging, expected);
}

template <int dim>
std::string message(const MeshParameters<dim> &p)
{
  try {
    make_mesh(p);
  } catch (const core::InputError &e) {
    return e.what();
  }
  return "accepted";
}

bool contains(const std::string &text, const std::string &part)
{
  return text.find(part) != std::string::npos;
}
} // namespace

TEST(Mesh, covers_the_box_minus_the_inner_box)
{
  check_volume_and_surface(band<2>());
  check_volume_and_surface(ring<2>());
  check_volume_and_surface(ring<3>());
  check_volume_and_surface(incommensurate(band<2>()));
  check_volume_and_surface(incommensurate(ring<2>()));
  check_volume_and_surface(incommensurate(band<3>()));
  check_volume_and_surface(incommensurate(ring<3>()));
}

TEST(Mesh, is_graded_in_2d)
{
  check_grading(band<2>());
  check_grading(ring<2>());
}

TEST(Mesh, is_graded_in_3d)
{
  check_grading(band<3>());
  check_grading(ring<3>());
}

namespace
{
/// Away from the inner box: fine cells of size h, then each larger than the one before by at most
/// the factor, never beyond the largest. Over its width all cells have the size that fits.
template <int dim>
void check_growth(MeshParameters<dim> p)
{
  p.growth = 1.25;
  p.levels = 2;
  const Mesh<dim> mesh = make_mesh(p);
  EXPECT_TRUE(mesh.hanging.empty());
  const double h = p.cell_size, small = 1e-9 * h;
  std::array<std::map<double, double>, dim> size_at; // by the lower end
  for (int c = 0; c < mesh.n_cells(); ++c)
    for (int k = 0; k < dim; ++k)
      size_at[k].emplace(std::round(mesh.cell_lower[c][k] / small), mesh.cell_size[c][k]);
  for (int k = 0; k < dim; ++k)
    for (const bool upper : {false, true}) {
      const double end = upper ? p.inner[0].upper[k] : p.inner[0].lower[k];
      if (upper ? end >= p.upper[k] : end <= p.lower[k])
        continue;
      std::vector<double> sizes; // outwards
      for (const auto &[low, size] : size_at[k])
        if (upper ? low * small > end - h / 2 : low * small < end - h / 2)
          sizes.push_back(size);
      if (!upper)
        std::reverse(sizes.begin(), sizes.end());
      ASSERT_GT(int(sizes.size()), p.fine_cells);
      for (int i = 0; i < int(sizes.size()); ++i) {
        if (i < p.fine_cells) {
          EXPECT_NEAR(sizes[i], h, small);
        } else {
          EXPECT_GT(sizes[i], sizes[i - 1] * (1 - 1e-12));
        }
        if (i > 0) {
          EXPECT_LT(sizes[i], sizes[i - 1] * (p.growth + 1e-12));
        }
        EXPECT_LE(sizes[i], 4 * h + small);
      }
      EXPECT_GT(sizes.back(), 1.2 * h);
    }
}
} // namespace

TEST(Mesh, grows_away_from_the_inner_box)
{
  for (const auto &p : {band<2>(), ring<2>(), incommensurate(ring<2>())})
    check_growth(p);
  for (const auto &p : {band<3>(), ring<3>()})
    check_growth(p);
  auto p = incommensurate(ring<2>());
  p.growth = 1.2;
  check_volume_and_surface(p);
}

// Between two inner boxes cells grow from both.
TEST(Mesh, grows_between_inner_boxes)
{
  auto p = band<2>();
  p.growth = 1.2;
  p.fine_cells = 2;
  p.upper[1] = 6;
  p.inner.push_back(p.inner[0]);
  p.inner[1].lower[1] = p.upper[1] - 1;
  p.inner[1].upper[1] = p.upper[1];
  const Mesh<2> mesh = make_mesh(p);
  std::map<double, double> sizes;
  for (int c = 0; c < mesh.n_cells(); ++c)
    if (mesh.cell_lower[c][1] > p.inner[0].upper[1] - 0.01)
      sizes.emplace(mesh.cell_lower[c][1], mesh.cell_size[c][1]);
  auto back = sizes.rbegin();
  for (const auto &[low, size] : sizes)
    EXPECT_NEAR(size, (back++)->second, 1e-12);
  EXPECT_NEAR(sizes.begin()->second, p.cell_size, 1e-12);
  EXPECT_GT(std::next(sizes.begin(), sizes.size() / 2)->second, 2 * p.cell_size);
}

TEST(Mesh, knows_all_hanging_nodes)
{
  check_hanging_nodes_are_complete(ring<2>());
  auto p = ring<3>();
  p.cell_size = 0.2;
  p.levels = 1;
  p.fine_cells = 0;
  check_hanging_nodes_are_complete(p);
}

TEST(Mesh, without_inner_box_is_uniform)
{
  auto p = box<2>({1, 0.52}, 0.1);
  p.levels = 3;
  const auto mesh = make_mesh(p);
  EXPECT_EQ(mesh.n_cells(), 10 * 5);
  EXPECT_EQ(mesh.n_nodes(), 11 * 6);
  EXPECT_TRUE(mesh.hanging.empty());
  EXPECT_DOUBLE_EQ(mesh.cell_size[0][1], 0.52 / 5);
  // Rows: nodes and cells are numbered along x first.
  EXPECT_EQ(mesh.cells[3], (std::array<int, 4>{{3, 4, 14, 15}}));
  p.growth = 1.2; // away from what?
  EXPECT_EQ(make_mesh(p).n_cells(), 10 * 5);
}

// Cells that grow are counted as they are.
TEST(Mesh, growing_cells_fill_large_bodies)
{
  auto p = box<2>({20000, 20000}, 1);
  p.inner = {{{-10, -10}, {10, 10}}};
  p.lower = {-10000, -10000};
  p.upper = {10000, 10000};
  p.levels = 12;
  p.growth = 1.3;
  EXPECT_LT(make_mesh(p).n_cells(), 40000);
}

TEST(Mesh, refuses_what_cannot_be_meshed)
{
  auto thin = band<2>();
  thin.upper[1] = thin.inner[0].upper[1] + 0.2; // half a base cell
  EXPECT_TRUE(contains(message(thin), "use at most 1 levels")) << message(thin);
  thin.upper[1] = thin.inner[0].upper[1] + 0.05;
  EXPECT_TRUE(contains(message(thin), "use smaller cells")) << message(thin);

  auto full = band<2>();
  full.inner[0].lower[1] = full.lower[1];
  full.inner[0].upper[1] = full.upper[1];
  EXPECT_TRUE(contains(message(full), "fills the whole specimen"));

  auto outside = ring<3>();
  outside.inner[0].lower[2] += 100;
  outside.inner[0].upper[2] += 100;
  EXPECT_TRUE(contains(message(outside), "outside the specimen"));

  auto bad = ring<2>();
  bad.cell_size = NAN;
  EXPECT_TRUE(contains(message(bad), "cell size"));
  bad = ring<2>();
  bad.upper[0] = bad.lower[0];
  EXPECT_TRUE(contains(message(bad), "no extent in x"));
  bad = ring<2>();
  bad.cells_per_level = 0;
  EXPECT_TRUE(contains(message(bad), "cells per level"));
  bad = ring<2>();
  bad.growth = 0.9;
  EXPECT_TRUE(contains(message(bad), "cells grow by 0.9"));
  bad = box<2>({1, 1}, 1e-6);
  EXPECT_TRUE(contains(message(bad), "more than 1e8 cells"));
}
} // namespace ligament::fem
