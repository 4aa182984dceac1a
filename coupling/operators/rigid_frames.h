// The connected parts of the near mesh, each with the rotation of its mean motion. Where the body
// repeats itself along an axis, parts turn about that axis alone.
#pragma once

#include "core/polar_rotation.h"
#include "coupling/operators/transfer.h"
#include "coupling/regime.h"

namespace ligament::coupling
{
template <int dim>
class RigidFrames
{
public:
  explicit RigidFrames(const Overlap<dim> &overlap);

  /// A part in its present motion; displacements U of the near nodes in m.
  struct Frame
  {
    core::PolarRotation<dim> rotation; // of the least-squares gradient
    Vector<dim> translation;           // m, mean displacement
  };
  std::vector<Frame> frames(const Nodal<dim> &u) const;

  /// Of a torque on a part, what turns it.
  Spin<dim> turning(const Spin<dim> &torque) const { return torque.cwiseProduct(free_spin_); }

  NearMotion<dim> largest_motion(const Nodal<dim> &u) const;

  std::vector<std::vector<int>> nodes; // near nodes of each part
  Nodal<dim> position;                 // m, of the nodes from the centre of their part
  Nodal<dim> gradient;                 // 1/m: the gradient of a motion x is sum x_i (x) g_i

private:
  struct Cell
  {
    int part;
    std::array<int, fem::n_cell_nodes<dim>> nodes;
    Eigen::Matrix<double, dim, fem::n_cell_nodes<dim>> gradient; // at the centre, 1/m
    Vector<dim> centre;                                          // m
  };
  std::vector<Cell> cells_;
  Vector<dim> free_;    // per axis 1, 0 where the body repeats itself along it
  Spin<dim> free_spin_; // 1, 0 about axes that would turn such an axis
};
} // namespace ligament::coupling
