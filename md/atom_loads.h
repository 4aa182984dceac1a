// Supports and tractions on the atoms along a side of the specimen, and the work they do.
#pragma once

#include "core/exact_sum.h"
#include "core/load.h"
#include "packings/packing.h"
#include "particles/particle_force.h"

namespace ligament::md
{
/// A crystal has no faces to pull at: a load acts on the atoms within one range of its side, each
/// with a share of the side's area (packings::BoundaryFace). Supports hold them by springs as stiff
/// as one spacing of the crystal, k = C11 S/d for the share S; tractions push at them with t S.
template <int dim>
class AtomLoads
{
public:
  using Particles = particles::Particles<dim>;

  AtomLoads() = default;
  /// `stiffness` in N/m^3: of the springs, per area. Throws core::InputError where two loads
  /// prescribe the same component of an atom, and for pressures, which follow faces.
  AtomLoads(const packings::Packing<dim> &packing, double stiffness,
            std::vector<core::BoundaryLoad<dim>> loads);

  bool is_empty() const { return springs_.empty() && pushes_.empty(); }
  /// Adds to the forces those of the loads at a time in s, and books their work since the last
  /// call by the trapezoidal rule.
  void add_forces(Particles &atoms, double time);
  /// Of the springs at the last add_forces()'s loads, in J.
  double energy(const Particles &atoms) const;
  /// N/m on component c of an atom, of all its springs: its share of the tangent.
  const Components<dim> &stiffnesses() const { return stiffness_; }

  Vector<dim> reaction(int load) const;
  double external_work() const { return work_.value(); }

  void save(core::State &state, const core::Names &names) const;
  void load(const core::State &state, const core::Names &names, const Particles &atoms);

private:
  struct Spring
  {
    int i, c, load;
    double stiffness; // N/m
  };
  struct Push
  {
    int i, load;
    Vector<dim> area; // m^2, 0 for components that a support holds
  };
  double stretch(const Spring &s, const Particles &atoms) const
  {
    return displacement_[s.load][s.c] - atoms.displacement[s.c][s.i];
  }
  void set_time(double time);

  std::vector<core::BoundaryLoad<dim>> loads_;
  std::vector<Spring> springs_;
  std::vector<Push> pushes_;
  Components<dim> stiffness_;
  std::vector<Vector<dim>> displacement_, traction_, reaction_; // of each load
  core::ExactSum work_;
  // What the last work was booked with.
  bool is_booked_ = false;
  std::vector<Vector<dim>> old_displacement_, old_traction_;
  Components<dim> old_; // m, displacements of the atoms
};
} // namespace ligament::md
