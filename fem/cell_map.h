// The map from the unit cell [0, 1]^dim to a cell of any convex shape, and what follows from it.
#pragma once

#include "core/part.h"
#include "fem/mesh.h"

#include <optional>

namespace ligament::fem
{
/// Corners of a cell in lexicographic order, in m.
template <int dim>
CellVectors<dim> cell_corners(const Mesh<dim> &mesh, int cell);

template <int dim>
Vector<dim> cell_centre()
{
  return Vector<dim>::Constant(0.5);
}

/// Q1 shape functions at s in the unit cell.
template <int dim>
Vec<n_cell_nodes<dim>> shape_values_at(const Vector<dim> &s);

/// Their derivatives by s, one column per shape function.
template <int dim>
CellVectors<dim> shape_slopes_at(const Vector<dim> &s);

/// x(s) = sum N_a(s) x_a, in m.
template <int dim>
Vector<dim> cell_point(const CellVectors<dim> &corners, const Vector<dim> &s);

/// dx_i/ds_j in m.
template <int dim>
Eigen::Matrix<double, dim, dim> cell_jacobian(const CellVectors<dim> &corners,
                                              const Vector<dim> &s);

/// Gradients of the shape functions in space at s, in 1/m.
template <int dim>
CellVectors<dim> shape_gradients_at(const CellVectors<dim> &corners, const Vector<dim> &s);

/// s with x(s) = p, by Newton's method; nothing where p lies too far outside for it.
template <int dim>
std::optional<Vector<dim>> unit_place(const CellVectors<dim> &corners, const Vector<dim> &p);

/// Shape functions at a place of a cell of the mesh, and their gradients in 1/m.
template <int dim>
Vec<n_cell_nodes<dim>> shape_values(const Mesh<dim> &mesh, int cell, const Vector<dim> &p);
template <int dim>
CellVectors<dim> shape_gradients(const Mesh<dim> &mesh, int cell, const Vector<dim> &p);
/// The gradients at the centre of the unit cell.
template <int dim>
CellVectors<dim> centre_gradients(const Mesh<dim> &mesh, int cell);

/// int N_a dV in m^dim (area in 2D): shares of the corners in the cell, exact.
template <int dim>
Vec<n_cell_nodes<dim>> volume_shares(const CellVectors<dim> &corners);
template <int dim>
Vec<n_cell_nodes<dim>> volume_shares(const Mesh<dim> &mesh, int cell);
template <int dim>
double cell_volume(const Mesh<dim> &mesh, int cell);

/// Stiffness of any convex cell times the thickness, theory.md eq. (F11): that of a box where the
/// corners are those of one.
template <int dim>
CellMatrix<dim> cell_stiffness(const CellVectors<dim> &corners, const Stiffness<dim> &c,
                               double thickness);
/// The same of a body, with what the stress of its reference adds (theory.md eq. (C23)).
template <int dim>
CellMatrix<dim> cell_stiffness(const CellVectors<dim> &corners, const Body<dim> &body);
/// Of a cell of the mesh.
template <int dim>
CellMatrix<dim> cell_stiffness(const Mesh<dim> &mesh, int cell, const Body<dim> &body);

/// Local numbers of the nodes of a face, in lexicographic order.
template <int dim>
std::array<int, n_cell_nodes<dim> / 2> face_nodes(int face)
{
  std::array<int, n_cell_nodes<dim> / 2> nodes{};
  int n = 0;
  for (int a = 0; a < n_cell_nodes<dim>; ++a)
    if ((a >> (face / 2) & 1) == face % 2)
      nodes[n++] = a;
  return nodes;
}

/// Its corners in turn. Twisted faces in 3D stand for what lies between them.
template <int dim>
core::FaceCorners<dim> face_corners(const CellVectors<dim> &corners, int face);

/// int N_a dA over a face in m^(dim-1), 0 for corners off it; exact for plane faces.
template <int dim>
Vec<n_cell_nodes<dim>> face_shares(const CellVectors<dim> &corners, int face);

/// Unit normal that points out of the cell, of a twisted face the mean one.
template <int dim>
Vector<dim> face_normal(const CellVectors<dim> &corners, int face);
} // namespace ligament::fem
