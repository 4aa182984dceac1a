// Faces that touch, as part of the force: those of broken bonds and initial cracks, and those that
// a search finds.
#pragma once

#include "dem/contact_search.h"
#include "dem/contacts.h"
#include "dem/parts/force_part.h"

namespace ligament::dem
{
/// What is seen in one step acts in the next: a body in parts can agree on it meanwhile.
template <int dim>
class ContactForces : public ForcePart<dim>
{
public:
  using Particles = particles::Particles<dim>;

  /// Faces that a crack cuts touch from the start.
  ContactForces(const packings::Packing<dim> &packing, const Materials &materials,
                const PeriodicImages<dim> &images);

  const Contacts<dim> &contacts() const { return contacts_; }
  const std::vector<Contact<dim>> &all() const { return contacts_.all(); }

  /// Ranks that hold other parts step some of the particles from now on. Contacts of the `kept`
  /// ones are known here, all of them; owners of guests are added to `owners`.
  void join(std::shared_ptr<particles::Owners> owners, const Particles &particles,
            std::vector<char> kept);
  /// Before load(): the particles that contacts of the state need here come.
  void invite(const core::State &state, Particles &particles);
  /// After each drift: where particles of other ranks are that contacts alone see.
  void follow_guests(Particles &particles)
  {
    if (guests_)
      guests_->update(particles);
  }
  /// No part of the body has any.
  bool none() const { return guests_ ? !any_ : all().empty(); }
  /// Whether faces may begin to touch though no bond breaks.
  bool may_touch() const { return !none() || may_meet_ || searching_; }
  /// What ranks have to agree on behind each step, before the next one searches: whether there are
  /// contacts, whether they slid, whether a search is due; 1 where one rank sees it.
  std::vector<std::int64_t> seen() const;
  void agree(const std::vector<std::int64_t> &seen);
  /// The same after load(), and what joints have gone on to.
  void agree_after_load();
  /// A bond has broken somewhere: all search in the next step. To be called by all ranks.
  void follow_break();

  /// A bond has broken: its particles lie on a surface, its face may touch. Null: other ranks keep
  /// this contact. Behind the last one of a step comes settle().
  const Contact<dim> *add_broken(const Bond<dim> &bond);
  /// The same; adds the force of the contact, too, and returns its energy in J, of one that is
  /// kept. `pressing`: the bond's force on its first particle (N) where that is to go on; 0
  /// otherwise.
  double act_broken(const Bond<dim> &bond, const Vector<dim> &pressing, Particles &particles,
                    double dt);
  /// See Contacts.
  void settle() { contacts_.settle(); }

  /// See Contacts: a bond holds this one from now on; and it is a contact again, as act_broken.
  void bond(const std::array<std::int64_t, 3> &name) { contacts_.bond(contacts_.place(name)); }
  double act_parted(const std::array<std::int64_t, 3> &name, const Vector<dim> &pressing,
                    double grown, Particles &particles, double dt);

  /// Once at every new time: looks for faces that begin to touch, from when bonds have broken or
  /// faces have slid.
  void search(Particles &particles, const BondNetwork<dim> &bonds, double time,
              particles::RestBlocks<dim> *rest);
  /// What contacts join is awake from now on.
  void wake(const BondNetwork<dim> &bonds, particles::RestBlocks<dim> *rest) const;
  /// Adds forces and torques, after all other parts; slips follow the motion. See Contacts.
  void act(Particles &particles, double dt) { contacts_.add_forces(particles, dt); }

  /// See Contacts.
  std::vector<ClosedContact<dim>> add_trial_forces(Particles &particles) const
  {
    return contacts_.add_trial_forces(particles);
  }
  void forget_steps() { contacts_.forget_steps(); }

  std::vector<int> particles() const override { return {}; }
  void add_energies(const Particles &particles, Evaluation<dim> &,
                    std::vector<double> &energy) const override;
  void for_each_moment(const Particles &particles, const Evaluation<dim> &,
                       const VisitMoment<dim> &visit) const override;

  /// Energy in J that friction took, and that the leap-frog lost where contacts opened and closed.
  const core::ExactSum &frictional_work() const { return contacts_.frictional_work(); }
  const core::ExactSum &step_error() const { return contacts_.step_error(); }

  void save(core::State &state, const core::Names &names) const override;
  void load(const core::State &state, const core::Names &names, const Particles &) override;

private:
  Contacts<dim> contacts_;
  ContactSearch<dim> search_;
  const PeriodicImages<dim> &images_;
  double spacing_; // m
  // Faces have slid, or surfaces have moved: seen in one step, it acts in the next.
  bool searching_ = false, has_slid_ = false;
  std::optional<double> looked_at_;           // s
  // Of a body in parts.
  std::unique_ptr<ContactGuests<dim>> guests_;
  bool any_ = false; // some part has contacts
  bool may_meet_;    // free surfaces of some part, see ContactSearch
};
} // namespace ligament::dem
