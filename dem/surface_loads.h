// Supports and tractions on the outer faces of the packing, and the work they do.
#pragma once

#include "core/exact_sum.h"
#include "core/load.h"
#include "dem/loaded_faces.h"
#include "dem/parts/force_part.h"
#include "dem/pressed_cells.h"
#include "packings/outer_face.h"

#include <algorithm>
#include <map>

namespace ligament::dem
{
template <int dim>
class SurfaceLoads : public ForcePart<dim>
{
public:
  using Particles = particles::Particles<dim>;

  SurfaceLoads(const packings::Packing<dim> &packing, const Materials &materials,
               std::vector<core::BoundaryLoad<dim>> loads);

  /// Displacements and tractions at time t (s).
  void set_time(double t);

  std::vector<int> particles() const override;
  /// Wakes the particles of each load as soon as it acts: a support moves, a traction is applied.
  /// Null: nothing rests.
  void wake(particles::RestBlocks<dim> *rest);
  void add_pressures(const Particles &particles, Evaluation<dim> &evaluation) const override;
  void add_strains(const Particles &particles, Evaluation<dim> &evaluation) const override;
  /// Leaves reactions behind.
  void add_forces(Particles &particles, Evaluation<dim> &evaluation) const override;
  void add_force_on(int i, const Particles &particles, const Evaluation<dim> &evaluation,
                    Wrench<dim> &wrench) const override;
  /// At other pressures than add_forces() found.
  void find_reactions(const Particles &particles, Evaluation<dim> &evaluation) const;
  /// Of the walls.
  void add_energies(const Particles &particles, Evaluation<dim> &evaluation,
                    std::vector<double> &energy) const override;
  void for_each_moment(const Particles &particles, const Evaluation<dim> &evaluation,
                       const VisitMoment<dim> &visit) const override;

  /// Adds to external_work() what the loads did on every face of one's own since the last call:
  /// trapezoidal rule.
  void book_work(const Particles &particles, const Evaluation<dim> &evaluation);
  const core::ExactSum &external_work() const { return work_; }

  /// What the next work is booked against, as the tables "loads", "walls" and "loaded_faces".
  void save(core::State &state, const core::Names &names) const override;
  void load(const core::State &state, const core::Names &names, const Particles &) override;

  const std::vector<WallFace<dim>> &walls() const { return walls_; }
  int n_loads() const { return int(loads_.size()); }
  /// Whether pressures that follow the surface act, here or on other ranks.
  bool presses() const
  {
    return std::any_of(loads_.begin(), loads_.end(), [](const auto &l) { return l.pressure; });
  }

private:
  /// What the loads make of it.
  void add_faces(const packings::OuterFace<dim> &face, double shear_modulus);
  Vector<dim> relative(const WallFace<dim> &wall, const Particles &p, bool has_loads) const;
  /// Component by component, load by load, on one's own particles; of known forces of walls.
  std::vector<core::ExactSum> reaction_sums(const Particles &particles,
                                            const Evaluation<dim> &evaluation) const;
  /// What the particle's own strain takes from Du of a wall, and how far it moves a loaded face.
  Vector<dim> stretch(const WallFace<dim> &wall, const Evaluation<dim> &evaluation) const;
  Vector<dim> stretch(const TractionFace<dim> &face, const Particles &particles,
                      const Evaluation<dim> &evaluation) const;
  Vector<dim> traction(const TractionFace<dim> &face, bool has_loads) const;
  /// On the particle, in N.
  Vector<dim> force(const WallFace<dim> &wall, const Particles &p,
                    const Evaluation<dim> &evaluation) const;

  Wrench<dim> wrench(const WallFace<dim> &wall, const Particles &p, const Vector<dim> &force) const;
  Wrench<dim> wrench(const TractionFace<dim> &face, const Particles &p,
                     const Evaluation<dim> &evaluation) const;

  std::vector<core::BoundaryLoad<dim>> loads_;
  std::vector<WallFace<dim>> walls_;
  std::vector<TractionFace<dim>> tractions_;
  PressedCells<dim> pressed_;
  /// Walls and tractions of each particle that has some.
  std::map<int, std::array<std::vector<int>, 2>> faces_of_;
  std::vector<Vector<dim>> displacement_, traction_; // of each load
  std::vector<char> has_begun_;                      // of each load
  core::ExactSum work_;
  /// What each face's work was booked with.
  struct Booked
  {
    std::vector<Vector<dim>> displacement, traction; // of each load
    std::vector<Vector<dim>> wall_force;             // of each wall
    std::vector<Vector<dim>> place, gradient;        // of each face under a traction
  };
  std::optional<Booked> booked_;
};
} // namespace ligament::dem
