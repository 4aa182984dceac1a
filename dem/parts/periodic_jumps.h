// Prescribed jumps of the displacement across joined sides, what they pull with, and their work.
#pragma once

#include "core/exact_sum.h"
#include "core/load.h"
#include "dem/contacts.h"
#include "dem/periodic_images.h"
#include "dem/stressed_body.h"

namespace ligament::dem
{
template <int dim>
class PeriodicJumps : public ForcePart<dim>
{
public:
  using Particles = particles::Particles<dim>;

  /// Of all loads those that are jumps. Components that none of them names are zero.
  PeriodicJumps(const BondedBody<dim> &body, std::vector<core::BoundaryLoad<dim>> loads);

  /// Jumps at time t (s), or none.
  void set_time(double t);
  /// What all evaluations see from now on: the present jumps, or sides that stand still.
  void show(bool has_loads) const;
  /// Wakes the particles at the sides as soon as one of them jumps; null: nothing rests.
  void wake(particles::RestBlocks<dim> *rest);

  std::vector<int> particles() const override { return {}; }
  void add_energies(const Particles &, Evaluation<dim> &, std::vector<double> &) const override {}
  void remove(const BondId &id, const Bond<dim> &bond, const Particles &particles) override;

  /// Of the loads: the sum of what crosses the joined sides, in N, at the state's pressures. The
  /// first load of an axis also has the components that none of its loads names.
  void find_reactions(const StressedBody<dim> &state, const Contacts<dim> &contacts,
                      Evaluation<dim> &evaluation) const;

  /// Adds to external_work() what the jumps did since the last call: trapezoidal rule.
  void book_work(const Evaluation<dim> &evaluation);
  double external_work() const { return work_.value(); }

  /// What the next work is booked against, as the table "periodic_jumps".
  void save(core::State &state, const core::Names &names) const override;
  void load(const core::State &state, const core::Names &names, const Particles &) override;

private:
  PeriodicImages<dim> &images_;
  std::vector<core::BoundaryLoad<dim>> loads_;
  struct Jump
  {
    int load, axis;
  };
  std::vector<Jump> jumps_;
  std::vector<BondId> across_;        // bonds to images
  std::vector<int> particles_;        // of them
  std::array<Vector<dim>, dim> jump_; // of each axis, in m
  bool has_begun_ = false;
  core::ExactSum work_;
  struct Booked
  {
    std::array<Vector<dim>, dim> jump;
    std::vector<Vector<dim>> reaction; // of each of jumps_
  };
  std::optional<Booked> booked_;
};
} // namespace ligament::dem
