// What the coupler adds to the discrete energy, as a function of the nodes' displacements, in three
// regimes of motion.
#pragma once

#include "coupling/algebra/block_matrix.h"
#include "coupling/operators/interpolated_motion.h"
#include "coupling/operators/rigid_frames.h"
#include "fem/strained_cell.h"

#include <memory>

namespace ligament::coupling
{
template <int dim>
class CoarseEnergy
{
public:
  virtual ~CoarseEnergy() = default;

  /// force -= dE/dU in N for the displacements U (m) of the near nodes; returns E in J. Calling it
  /// again with the same U changes nothing more.
  virtual double subtract_forces(const Nodal<dim> &u, Nodal<dim> &force) const = 0;
  /// The same but for the energy, which may cost more.
  virtual void subtract_only_forces(const Nodal<dim> &u, Nodal<dim> &force) const
  {
    subtract_forces(u, force);
  }
};

/// 1/2 U.K U + g.U (theory.md eqs. (C2), (C26)).
template <int dim>
class LinearCoarseEnergy : public CoarseEnergy<dim>
{
public:
  /// dead_load: g in N, or empty.
  explicit LinearCoarseEnergy(const Eigen::SparseMatrix<double> &stiffness,
                              const Nodal<dim> &dead_load = {})
      : stiffness_(stiffness), dead_load_(dead_load)
  {
  }
  double subtract_forces(const Nodal<dim> &u, Nodal<dim> &force) const override;

private:
  BlockMatrix<dim> stiffness_;
  Nodal<dim> dead_load_;
};

/// 1/2 U_R.K U_R + g.U_R, U_R the displacement in axes that turn with each connected part of the
/// near mesh (theory.md eq. (C13)).
template <int dim>
class CorotatedCoarseEnergy : public CoarseEnergy<dim>
{
public:
  /// dead_load: g in N, or empty. `parts` must live as long.
  CorotatedCoarseEnergy(const Eigen::SparseMatrix<double> &stiffness, const RigidFrames<dim> &parts,
                        const Nodal<dim> &dead_load = {})
      : stiffness_(stiffness), parts_(parts), dead_load_(dead_load)
  {
  }
  double subtract_forces(const Nodal<dim> &u, Nodal<dim> &force) const override;

private:
  BlockMatrix<dim> stiffness_;
  const RigidFrames<dim> &parts_;
  Nodal<dim> dead_load_;
};

/// Cells that turn one by one, minus the discrete energy itself on the interpolated motion, with
/// the patch fit turning part by part (theory.md eq. (C14)); where the force has a law of finite
/// strain, cells obey it (eq. (C31)).
template <int dim>
class NonlinearCoarseEnergy : public CoarseEnergy<dim>
{
public:
  /// `correction`: the patch fit, or empty; dead_load: g in N, or empty. `parts` must live as long.
  NonlinearCoarseEnergy(const Overlap<dim> &overlap, const RigidFrames<dim> &parts,
                        const particles::Particles<dim> &particles,
                        const particles::ParticleForce<dim> &force, const fem::Body<dim> &body,
                        const Eigen::SparseMatrix<double> &correction,
                        const Nodal<dim> &dead_load = {});
  double subtract_forces(const Nodal<dim> &u, Nodal<dim> &force) const override
  {
    return subtract(u, force, true);
  }
  void subtract_only_forces(const Nodal<dim> &u, Nodal<dim> &force) const override
  {
    subtract(u, force, false);
  }

private:
  struct Cell
  {
    std::array<int, fem::n_cell_nodes<dim>> nodes;
    int shape, stiffness; // indices
  };
  void add_cells(const Overlap<dim> &overlap, const fem::Body<dim> &body);
  void add_parts(const Overlap<dim> &overlap, const particles::Particles<dim> &particles,
                 const particles::ParticleForce<dim> &force);
  double subtract(const Nodal<dim> &u, Nodal<dim> &force, bool wants_energy) const;
  double subtract_cells(const Nodal<dim> &u, Nodal<dim> &force, bool wants_energy) const;
  double add_discrete(const Nodal<dim> &u, Nodal<dim> &force, bool wants_energy) const;
  double compute_parts(bool wants_energy) const;
  double add_places(const Nodal<dim> &u, Nodal<dim> &force, bool wants_energy) const;

  std::vector<Cell> cells_;
  std::vector<fem::CellShape<dim>> shapes_;
  std::vector<fem::CellMatrix<dim>> stiffness_;
  std::shared_ptr<const core::HyperelasticLaw<dim>> law_; // null: cells are linear in turned axes
  std::vector<fem::CellMean<dim>> means_;                 // with a law, beside `stiffness_`
  std::vector<InterpolatedMotion<dim>> motions_;          // of members that turn
  /// Of members that don't: the nodes of member k and their shares from shares_begin_[k] on.
  std::vector<int> shares_begin_, share_node_;
  std::vector<double> share_value_;
  std::unique_ptr<CorotatedCoarseEnergy<dim>> correction_; // the fit, and what is left at rest
  std::unique_ptr<particles::PartialForce<dim>> discrete_;
  std::unique_ptr<particles::Particles<dim>> state_; // of the interpolated motion
};
} // namespace ligament::coupling
