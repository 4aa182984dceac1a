// Where the two models overlap: its particles, cells and nodes, the weight of the discrete model,
// and the interpolation from nodes to particles.
#pragma once

#include "core/box_union.h"
#include "coupling/scheme.h"
#include "fem/condensed_cell.h"
#include "particles/particle_force.h"

#include <array>
#include <limits>

namespace ligament::coupling
{
/// dim numbers per near node.
template <int dim>
using Nodal = Eigen::Matrix<double, Eigen::Dynamic, dim, Eigen::RowMajor>;

template <int dim>
struct OverlapParameters
{
  core::BoxUnion<dim> zone; // its sides are the edge of the packing; infinite where it reaches
                            // through the specimen
  double length;            // m, L: from the edge of the packing to the inner edge of the mesh
  double spacing;           // m, d
  int transition_cells;     // layers of cells over which the mass goes from consistent to lumped
  /// m; the body repeats itself in the directions where this is not 0: neighbours of the particles
  /// and nodes of the cells at one side of the period are those at its other side.
  std::array<double, 3> period = {};
  WeightShape shape = WeightShape::cubic;
  /// Particles at the edge of the packing, whose cells are not closed, move with the mesh. Without
  /// pads `depth` lies half a spacing outside the outermost centre.
  bool has_pads = true;
  bool lumps_mass = false; // of all near cells: mu = 0
};

/// The overlap of the discrete zone, in one or several pieces, with the mesh (theory.md, "Overlap
/// and weights").
///
/// A point is a distance away from the edge of the packing (core::BoxUnion::distance); s rises from
/// 0 at `depth`, behind which only pad particles lie, to 1 at a `margin` before the mesh ends. The
/// share of the discrete model is a = 3 s^2 - 2 s^3, or another function of s.
template <int dim>
class Overlap
{
public:
  static constexpr int n_cell_nodes = fem::n_cell_nodes<dim>;

  /// Throws core::InputError when pad particles reach out of the mesh or when the overlap is too
  /// thin for them.
  Overlap(const particles::Particles<dim> &particles, const particles::ParticleForce<dim> &force,
          const fem::Mesh<dim> &mesh, const OverlapParameters<dim> &parameters);

  /// Distance of a point from the edge of the packing, in m; negative beyond it.
  double distance_to_edge(const Vector<dim> &x) const;
  /// Relative position s in [0, 1]: 0 at the side of the mesh, 1 at the discrete side.
  double position(const Vector<dim> &x) const;
  /// Share a of the discrete model.
  double weight(const Vector<dim> &x) const;

  /// Overlap particle: a particle inside the mesh.
  struct Member
  {
    int particle;
    bool pad;                                          // moves with the mesh
    bool open;                                         // lacks neighbours beyond the packing
    double weight;                                     // a at its centre
    double position;                                   // s at its centre
    int cell;                                          // index into `cells`
    std::array<int, n_cell_nodes> nodes;               // near nodes of its cell
    Vec<n_cell_nodes> value;                           // Phi: shape functions at its centre
    Eigen::Matrix<double, dim, n_cell_nodes> gradient; // of the shape functions, 1/m
  };

  /// Cell that the coupler takes over: layer 0 holds particles, layers 1, 2, ... the transition.
  struct Cell
  {
    int cell; // in the mesh
    int layer;
    double consistent_share;             // mu: share of the consistent mass
    double size;                         // m, smallest edge
    std::array<int, n_cell_nodes> nodes; // near nodes
    fem::CondensedCell<dim> shape;       // its `nodes` are those of the mesh
  };

  std::vector<Member> members;
  std::vector<Cell> cells;
  std::vector<int> near_nodes;         // mesh node of every near node; hanging nodes are none
  std::vector<char> is_overlap_node;   // per near node: node of a cell of layer 0
  std::vector<int> member_of_particle; // index into members, or -1
  std::vector<int> edge;               // open particles and their neighbours: pads, if there are
  double depth = 0;                    // m
  double margin = 0;    // m: range of the force, or one spacing where it reaches neighbours only
  double cell_size = 0; // m, smallest edge of the overlap's cells
  const fem::Mesh<dim> &mesh;
  const OverlapParameters<dim> parameters;

  int n_nodes() const { return int(near_nodes.size()); }
  /// Ascending.
  std::vector<int> member_particles() const;

  /// Vector from one particle to another or to the nearest of its periodic images, in m.
  Vector<dim> offset(const Vector<dim> &from, const Vector<dim> &to) const;

  /// Shape functions of the nodes of a near cell at x, and their gradients in 1/m.
  Vec<fem::n_cell_nodes<dim>> shape_values(const Cell &cell, const Vector<dim> &x) const;
  Eigen::Matrix<double, dim, fem::n_cell_nodes<dim>> shape_gradients(const Cell &cell,
                                                                     const Vector<dim> &x) const;

  /// 1 - a: what is subtracted of a term of the discrete energy at `location` (m) between these
  /// particles. Only where all of them lie in the overlap, else 0; wholly where one is pad.
  double subtracted_share(const Vector<dim> &location, const std::vector<int> &particles) const;

  /// What the discrete law is told of the edge; the displacement of the mesh's nodes (m) is read
  /// whenever the law asks for its gradient. Both must outlive it.
  particles::CoupledEdge<dim> coupled_edge(const Components<dim> &displacement) const;

  /// Spin of the interpolated motion at a member: 1/2 curl(sum N_a u_a) = sum_a spin(a) u_a.
  static Eigen::Matrix<double, n_spins<dim>, dim> spin_block(const Member &m, int a);

private:
  std::vector<char> find_edge(const particles::Particles<dim> &particles,
                              const particles::ParticleForce<dim> &force);
  void find_members(const particles::Particles<dim> &particles,
                    const particles::ParticleForce<dim> &force);
  void require_width(double range) const;
  void require_closed_surface(const particles::Particles<dim> &particles, double range,
                              const std::vector<int> &open) const;
  void find_cells();
  /// Their shape functions, once the cells are known.
  void place_members(const particles::Particles<dim> &particles);
};

/// 1/2 curl(g . x u) = half_curl(g) u: the spin of a motion u that grows along the gradient g
/// (1/m).
template <int dim>
Eigen::Matrix<double, n_spins<dim>, dim> half_curl(const Vector<dim> &g)
{
  Eigen::Matrix<double, n_spins<dim>, dim> block;
  if constexpr (dim == 2)
    block << -g[1] / 2, g[0] / 2;
  else
    block << 0, -g[2] / 2, g[1] / 2, g[2] / 2, 0, -g[0] / 2, -g[1] / 2, g[0] / 2, 0;
  return block;
}

template <int dim>
Eigen::Matrix<double, n_spins<dim>, dim> Overlap<dim>::spin_block(const Member &m, int a)
{
  return half_curl<dim>(m.gradient.col(a));
}
} // namespace ligament::coupling
