// The far-field mesh as plain arrays: Q1 cells, axis-parallel or of any convex shape, hanging
// nodes, boundary faces.
#pragma once

#include "core/box_union.h"
#include "core/solid.h"
#include "fem/body.h"

#include <array>
#include <memory>
#include <vector>

namespace ligament::fem
{
template <int dim>
inline constexpr int n_cell_nodes = 1 << dim;

/// A hanging node follows its masters: u = sum weight * u(master). Masters are never hanging.
/// Beyond joined sides the jump across each axis comes in addition, times the periods between the
/// node and its masters (fem/join_sides.h).
struct HangingNode
{
  int node;
  std::vector<std::pair<int, double>> masters;
  std::array<double, 3> periods = {};
};

template <int dim>
using CellMatrix = Eigen::Matrix<double, dim * n_cell_nodes<dim>, dim * n_cell_nodes<dim>>;

/// One column per node of a cell.
template <int dim>
using CellVectors = Eigen::Matrix<double, dim, n_cell_nodes<dim>>;

template <int dim>
struct CellFace
{
  int cell;
  int face;     // 2 * axis + (0 lower, 1 upper), axes of the unit cell (fem/cell_map.h)
  int boundary; // side of the specimen; inner_surface<dim>: towards the discrete zone, or free;
                // larger: other named sides
};

template <int dim>
using InnerBox = typename core::BoxUnion<dim>::Box;

/// What to mesh: a box, minus inner boxes that the discrete zone fills alone. They may reach
/// through the specimen (a band), lie inside it (a ring), touch each other or lie apart.
template <int dim>
struct MeshParameters
{
  Vector<dim> lower, upper;         // m, specimen
  std::vector<InnerBox<dim>> inner; // left out; boxes without extent are not
  double cell_size;                 // m, h beside the zone; adapted per direction to fit
  int levels = 0;                   // largest cells have size h 2^levels
  int fine_cells = 0;               // cells of size h on every path out of the inner box
  int cells_per_level = 4;          // then as many cells on each coarser level
  double growth = 1; // above 1: cells grow to that size one by one by this factor, none hangs
  /// The body in the plane, within lower and upper, holes left out; 3D: of a prism along z. Null:
  /// the box.
  std::shared_ptr<const core::Solid<2>> outline;
  double outline_cell_size = 0; // m, along its sides that are no lines of the mesh; 0: h
};

template <int dim>
struct Mesh
{
  std::vector<Vector<dim>> nodes;                        // m
  std::vector<std::array<int, n_cell_nodes<dim>>> cells; // nodes in lexicographic order, x fastest
  std::vector<Vector<dim>> cell_lower;                   // m, lower corner of the bounding box
  std::vector<Vector<dim>> cell_size;                    // m, of the bounding box
  std::vector<int> cell_level;                           // 0: finest
  std::vector<HangingNode> hanging;
  std::vector<CellFace<dim>> boundary_faces;
  /// Per cell whether it is not its bounding box; empty where all are boxes. find_cell_shapes()
  /// fills it (fem/cell_quality.h).
  std::vector<char> general;

  bool is_box(int cell) const { return general.empty() || !general[cell]; }
  int n_nodes() const { return int(nodes.size()); }
  int n_cells() const { return int(cells.size()); }
};

/// Builds the mesh with deal.II (local refinement, hanging nodes). Every section beside or between
/// the faces of inner boxes is filled with whole cells, so sizes differ a little from the ones
/// asked for, within 3/4 and 3/2 in a section of one large cell. Cells grow away from inner boxes
/// along each axis for itself, beside and between them, never over their width. There are no
/// hanging nodes within `fine_cells` cells of the inner box, its border included. Without inner box
/// all cells have size h. Cells and nodes are numbered in rows, x fastest. Throws core::InputError
/// with reason and remedy when a section of the far field is thinner than 3/4 of its largest cells,
/// when the inner box fills the specimen or lies outside, or when parameters are out of range.
///
/// With an outline its long sides along x and y become lines of the mesh where the cells between
/// are not squeezed by that; along all others cells of outline_cell_size follow it
/// (fem/fit_outline.h). A prism gets the same cells all along z.
template <int dim>
Mesh<dim> make_mesh(const MeshParameters<dim> &parameters);

/// Finds the cell of a point in constant time; points on shared faces belong to one of their cells.
template <int dim>
class CellLocator
{
public:
  explicit CellLocator(const Mesh<dim> &mesh);
  /// Cell that contains p (within 1e-10 of its size), or -1. `place`: where in the unit cell.
  int find(const Vector<dim> &p, Vector<dim> *place = nullptr) const;
  /// The cell from which p lies the least way outside, at most `reach` of its size, or -1: a place
  /// on a curved side, which straight edges cut off. Asks all cells.
  int nearest(const Vector<dim> &p, double reach) const;

private:
  const Mesh<dim> &mesh_;
  Vector<dim> lower_, bin_size_;
  std::array<int, dim> n_bins_;
  std::vector<int> bin_start_, bin_cells_;
};

/// Corner a (lexicographic order) of a cell of the given size against its lower one, in m.
template <int dim>
Vector<dim> corner(const Vector<dim> &size, int a)
{
  Vector<dim> x;
  for (int c = 0; c < dim; ++c)
    x[c] = (a >> c & 1) * size[c];
  return x;
}

/// Q1 shape functions at p in the cell (lower, size): N_a, a in lexicographic order.
template <int dim>
Vec<n_cell_nodes<dim>> shape_values(const Vector<dim> &lower, const Vector<dim> &size,
                                    const Vector<dim> &p);

/// Their gradients, one column per shape function, in 1/m.
template <int dim>
Eigen::Matrix<double, dim, n_cell_nodes<dim>>
shape_gradients(const Vector<dim> &lower, const Vector<dim> &size, const Vector<dim> &p);

/// B with strain = B u_cell (Voigt, engineering shears), u_cell node by node.
template <int dim>
Eigen::Matrix<double, n_strains<dim>, dim * n_cell_nodes<dim>>
strain_matrix(const Eigen::Matrix<double, dim, n_cell_nodes<dim>> &gradients);

/// Numbers of strain modes that a cell has to itself.
template <int dim>
inline constexpr int n_cell_modes = dim == 2 ? 4 : 12;

/// Stiffness of an axis-parallel cell of the given size, times the thickness: int (B u + G a).C (B
/// u + G a) at the a that make it least, 2-point Gauss in each direction (theory.md eq. (F8)).
/// Bends without shear and at any Poisson's ratio; uniform strain is exact.
template <int dim>
CellMatrix<dim> cell_stiffness(const Vector<dim> &size, const Stiffness<dim> &c, double thickness);

/// The same of a body, with what the stress of its reference adds (theory.md eq. (C23)).
template <int dim>
CellMatrix<dim> cell_stiffness(const Vector<dim> &size, const Body<dim> &body);

/// dV grad N_a . stress grad N_b, times the unit matrix: what the stress of the reference adds to
/// the stiffness of a cell around a point, dV in m^3.
template <int dim>
CellMatrix<dim> stress_stiffness(const CellVectors<dim> &gradients, const Strain<dim> &stress,
                                 double volume);
} // namespace ligament::fem
