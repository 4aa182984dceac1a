// The motion of the overlap's particles that the mesh cannot carry, and what particles and mesh
// hand each other in a step.
#pragma once

#include "core/thermal_noise.h"
#include "coupling/algebra/scalar_matrix.h"
#include "coupling/member_batches.h"
#include "coupling/nodal_sums.h"
#include "coupling/operators/coarse_projection.h"
#include "coupling/overlap_part.h"

#include <functional>

namespace ligament::coupling
{
/// w of theory.md eq. (C1) with its damper, and the pads, which have none.
///
/// Of several ranks each keeps w of the cells that hold a particle of its own: all members of these
/// are at hand and stepped. All make the same calls.
template <int dim>
class FineMotion
{
public:
  /// damping: 1 - exp(-c_f dt) for a member's position s in [0, 1]. Starts with w = 0. On several
  /// ranks `here` is the overlap at hand (overlap_at_hand()); core::InputError where a cell's
  /// members are not all there.
  FineMotion(const OverlapView<dim> &whole, const OverlapView<dim> &here,
             const std::function<double(double)> &damping, Solver solver,
             const core::Ranks &ranks = {});

  /// force += Phi^T f + Psi_pad^T T_pad, in N.
  void add_forces(const particles::Particles<dim> &particles, Nodal<dim> &force) const;

  /// theory.md eq. (C19), what the mesh carries not yet taken out; adds forces as above.
  void begin_kick(const particles::Particles<dim> &particles, double dt, Nodal<dim> &force);
  /// Once V is known: takes out what the mesh carries, v = Phi V + w; pads also turn with the mesh.
  void finish_kick(const Nodal<dim> &coarse, particles::Particles<dim> &particles);

  /// w of the particles' velocities: v - Phi V less what the mesh carries of it; then as
  /// write_velocities.
  void take_velocities(const Nodal<dim> &coarse, particles::Particles<dim> &particles);
  /// v = Phi V + w; pads also turn with the mesh.
  void write_velocities(const Nodal<dim> &coarse, particles::Particles<dim> &particles);

  /// Motions of bodies at rest, without touching w: v = Phi V + w, w being v - Phi V less what the
  /// mesh carries of it.
  void expand(const Nodal<dim> &coarse, particles::Particles<dim> &particles) const;
  /// The transpose: forces of particles and near nodes become those on v and V.
  void restrict_forces(particles::Particles<dim> &particles, Nodal<dim> &force) const;

  void scale(double factor);

  /// From now on exchange_heat() acts; kept: exp(-c_f dt) for a member's position s. For a motion
  /// without damper.
  void join_bath(const Overlap<dim> &overlap, const std::function<double(double)> &kept);
  bool has_bath() const { return !kept_.empty(); }
  /// Friction and its noise, theory.md eq. (C28), as if half-way through the kick by dt that was
  /// last, to be called after finish_kick(); thermal_energy: kT in J. Streams 0 and 1 of the noise.
  void exchange_heat(double thermal_energy, const core::ThermalNoise &noise, double dt,
                     const Nodal<dim> &coarse, particles::Particles<dim> &particles);
  /// What the bath has taken so far, less what it has given, in J.
  double bath_energy() const { return bath_energy_; }
  void reset_bath_energy() { bath_energy_ = 0; }
  /// Free components of w: those of the members that are not pad less those of the nodes that carry
  /// them.
  long n_free() const { return dim * (n_free_members_ - carrier_.n_unknowns()); }

  /// w, as the table "fluctuation", and what the damper has taken.
  void save(core::State &state, const particles::Particles<dim> &particles) const;
  /// Velocities of the particles are not touched.
  void load(const core::State &state, const particles::Particles<dim> &particles);

  /// What the damper has taken so far, in J, theory.md eq. (C20): an exact sum over the cells and,
  /// of each step, a sum over the near nodes.
  double damper_energy() const { return ranks_.sum(damper_energy_).value() / 2; }

  /// 1/2 w M w + 1/2 dt w f in J of the members that are one's own, before it is rounded.
  core::ExactSum kinetic_sum(const particles::Particles<dim> &particles, double dt) const;

  /// Large rotation: gives pads the orientation of the mesh's motion U (m), theory.md eq. (C15);
  /// from now on they turn with its rate, until the next call.
  void turn_pads(const Nodal<dim> &u, particles::Particles<dim> &particles);

private:
  static constexpr int nc = fem::n_cell_nodes<dim>;
  using Slot = typename MemberBatches<dim>::Slot;
  struct Pad
  {
    int particle;
    int batch, lane; // of its cell
    std::array<int, nc> nodes;
    Eigen::Matrix<double, dim, nc> gradient; // of the shape functions, 1/m
    std::array<Eigen::Matrix<double, n_spins<dim>, dim>, nc> spin;
  };

  using Member = typename Overlap<dim>::Member;
  using Cell = typename NodalSums<dim>::Cell;

  /// Members at hand of the cells of the overlap that hold some of one's own.
  std::map<int, std::vector<const Member *>> held_cells(const OverlapView<dim> &whole,
                                                        const OverlapView<dim> &here) const;
  /// All cells with members, in their order, with the ranks that own their first ones.
  std::vector<Cell> find_cells(const OverlapView<dim> &whole, const OverlapView<dim> &here) const;
  /// Puts the held cells side by side and says in `cells` where each one is.
  void make_lanes(const OverlapView<dim> &here,
                  const std::map<int, std::vector<const Member *>> &held,
                  const std::function<double(double)> &damping, std::vector<Cell> &cells);
  void make_pads(const OverlapView<dim> &here,
                 const std::map<int, std::vector<const Member *>> &held,
                 const std::vector<Cell> &cells);
  void note_own(const particles::Particles<dim> &particles, const std::vector<Cell> &cells);
  /// visit(particle, mass, 1 - damping/2, nodes, values) for every member; pads have no mass.
  template <typename Visit>
  void for_each_member(Visit &&visit) const;
  /// visit(slot, lane, nodes) of the members that are not pad; nodes[a][lane].
  template <typename Visit>
  void for_each_free(Visit &&visit) const;
  void turn_with_mesh(const Nodal<dim> &coarse, particles::Particles<dim> &particles) const;
  /// visit(pad, corner, Psi^T T): N
  template <typename Visit>
  void for_each_pad_force(const particles::Particles<dim> &particles, Visit &&visit) const;
  void add_pad_torques(const particles::Particles<dim> &particles,
                       std::vector<LaneArray> &sums) const;

  core::Ranks ranks_;
  MemberBatches<dim> lanes_;
  std::vector<std::uint8_t> own_;             // per slot: bit l, lane l is a particle of one's own
  std::vector<std::array<int, 2>> own_cells_; // batch and lane of those that one hands on
  NodalSums<dim> nodal_;
  std::vector<LaneArray> sums_; // of the members, see MemberSum
  CoarseProjection<dim> carrier_;
  std::vector<LaneArray> motion_;    // w, dim per slot, m/s
  Nodal<dim> carried_;               // Phi^T M w', then x: what the mesh carries of w'
  Nodal<dim> lost_;                  // Phi^T M damping (w + w')
  ScalarMatrix<dim> loss_;           // Phi^T M damping (1 - damping/2) Phi
  std::vector<LaneArray> cell_loss_; // of the members' part of (C20), per batch
  core::ExactSum damper_energy_;     // twice what it has taken; of the nodes' part the first rank's
  std::vector<LaneArray> kept_;      // exp(-c_f dt) per slot; empty: no heat bath
  double bath_energy_ = 0;
  long n_free_members_ = 0;
  std::vector<Pad> pads_;
};
} // namespace ligament::coupling
