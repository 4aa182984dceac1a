// Meshes whose cells are moved out of shape: at random inside, or all by one map.
#pragma once

#include "fem/cell_map.h"
#include "fem/cell_quality.h"

#include <algorithm>
#include <random>

namespace ligament::fem
{
template <int dim>
void place_hanging_nodes(Mesh<dim> &mesh)
{
  for (const auto &h : mesh.hanging) {
    mesh.nodes[h.node].setZero();
    for (const auto &[master, weight] : h.masters)
      mesh.nodes[h.node] += weight * mesh.nodes[master];
  }
}

/// Nodes off the boundary whose place `moves` wants move by up to `share` of the smallest cell
/// there, in each direction.
template <int dim, typename Moves>
Mesh<dim> distorted(Mesh<dim> mesh, double share, unsigned seed, Moves &&moves)
{
  std::vector<double> size(mesh.n_nodes(), 1e300);
  for (int cell = 0; cell < mesh.n_cells(); ++cell)
    for (const int node : mesh.cells[cell])
      size[node] = std::min(size[node], mesh.cell_size[cell].minCoeff());
  for (const auto &face : mesh.boundary_faces)
    for (const int a : face_nodes<dim>(face.face))
      size[mesh.cells[face.cell][a]] = 0;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-share, share);
  for (int i = 0; i < mesh.n_nodes(); ++i)
    for (int k = 0; k < dim; ++k) {
      const double step = uniform(random) * size[i];
      if (moves(mesh.nodes[i]))
        mesh.nodes[i][k] += step;
    }
  place_hanging_nodes(mesh);
  find_cell_shapes(mesh);
  return mesh;
}

template <int dim>
Mesh<dim> distorted(const Mesh<dim> &mesh, double share, unsigned seed = 1)
{
  return distorted(mesh, share, seed, [](const Vector<dim> &) { return true; });
}

template <int dim, typename Map>
Mesh<dim> mapped(Mesh<dim> mesh, Map &&map)
{
  for (auto &x : mesh.nodes)
    x = map(x);
  place_hanging_nodes(mesh);
  find_cell_shapes(mesh);
  return mesh;
}

/// Maps that shear and turn: boxes become equal parallelograms or parallelepipeds.
template <int dim>
Eigen::Matrix<double, dim, dim> slant()
{
  Eigen::Matrix<double, dim, dim> a = Eigen::Matrix<double, dim, dim>::Identity();
  a(0, 1) = 0.4;
  a(1, 0) = -0.1;
  if (dim == 3) {
    a(2, 0) = 0.2;
    a(1, dim - 1) = -0.3;
  }
  return a;
}

/// A unit cell moved out of shape.
template <int dim>
CellVectors<dim> random_corners(std::mt19937 &random, double share)
{
  std::uniform_real_distribution<double> uniform(-share, share);
  CellVectors<dim> corners;
  for (int a = 0; a < n_cell_nodes<dim>; ++a)
    for (int k = 0; k < dim; ++k)
      corners(k, a) = (a >> k & 1) * (1 + 0.5 * k) + uniform(random);
  return corners;
}
} // namespace ligament::fem
