// What a step passes over where parts of the body are at rest, and what wakes them.
#include "dem/many_body_force.h"

namespace ligament::dem
{
// The pressures at interfaces are solved for together: one that moves moves all, if by next to
// nothing.
template <int dim>
void ManyBodyForce<dim>::set_rest(particles::RestBlocks<dim> *rest)
{
  core::require(!rest || !plastic_ || rest->is_exact(),
                "what is held at rest by a threshold could yield");
  rest_ = rest;
  work_.rest = rest;
  work_.nearness_version = -1;
  if (rest)
    rest->wake(interfaces_.members());
}

template <int dim>
const particles::AwakeRanges *ManyBodyForce<dim>::awake_ranges(const Workspace &work) const
{
  return work.rest && !work.rest->all_awake() ? &work.rest->ranges() : nullptr;
}

template <int dim>
const SliceNearness *ManyBodyForce<dim>::awake_slices(Workspace &work) const
{
  if (!work.rest || work.rest->all_awake())
    return nullptr;
  if (work.nearness_version != work.rest->version()) {
    work.nearness = slices_.nearness(*work.rest);
    work.nearness_version = work.rest->version();
  }
  return &work.nearness;
}

template <int dim>
void ManyBodyForce<dim>::wake_loaded()
{
  surface_.for_each_that_begins([&](const std::vector<int> &loaded) { rest_->wake(loaded); });
}

// Contacts that the search found join particles that no bond ever joined.
template <int dim>
void ManyBodyForce<dim>::wake_contacts()
{
  std::vector<int> asleep;
  for (const auto &contact : contacts_.all())
    for (const int i : {contact.face.i, contact.face.j})
      if (!rest_->is_awake(i))
        asleep.push_back(i);
  rest_->wake(asleep);
}

template <int dim>
void ManyBodyForce<dim>::clear_forces_at_rest(Particles &p) const
{
  const auto clear = [&](int i) {
    if (rest_->is_awake(i))
      return;
    for (auto &f : p.force)
      f[i] = 0;
    for (auto &t : p.torque)
      t[i] = 0;
  };
  for (const int i : other_particles_)
    clear(i);
  for (const auto &contact : contacts_.all()) {
    clear(contact.face.i);
    clear(contact.face.j);
  }
}

template <int dim>
void ManyBodyForce<dim>::add_contact_forces(Particles &p)
{
  contacts_.add_forces(p, time_ - last_time_);
  if (rest_ && !rest_->is_exact() && !rest_->all_awake())
    clear_forces_at_rest(p);
}

template void ManyBodyForce<2>::set_rest(particles::RestBlocks<2> *);
template void ManyBodyForce<3>::set_rest(particles::RestBlocks<3> *);
template const particles::AwakeRanges *ManyBodyForce<2>::awake_ranges(const Workspace &) const;
template const particles::AwakeRanges *ManyBodyForce<3>::awake_ranges(const Workspace &) const;
template const SliceNearness *ManyBodyForce<2>::awake_slices(Workspace &) const;
template const SliceNearness *ManyBodyForce<3>::awake_slices(Workspace &) const;
template void ManyBodyForce<2>::wake_loaded();
template void ManyBodyForce<3>::wake_loaded();
template void ManyBodyForce<2>::wake_contacts();
template void ManyBodyForce<3>::wake_contacts();
template void ManyBodyForce<2>::clear_forces_at_rest(Particles &) const;
template void ManyBodyForce<3>::clear_forces_at_rest(Particles &) const;
template void ManyBodyForce<2>::add_contact_forces(Particles &);
template void ManyBodyForce<3>::add_contact_forces(Particles &);
} // namespace ligament::dem
