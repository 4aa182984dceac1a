#include "dem/parts/contact_forces.h"

#include <cmath>

namespace ligament::dem
{
template <int dim>
ContactForces<dim>::ContactForces(const packings::Packing<dim> &packing, const Materials &materials,
                                  const PeriodicImages<dim> &images)
    : contacts_(materials, packing.global_id, packing.size()),
      search_(packing, packings::mean_face_area(packing), &images), images_(images),
      spacing_(packing.spacing), may_meet_(search_.may_meet())
{
  for (const auto &face : packing.faces)
    if (face.cracked) {
      Bond<dim> b = BondNetwork<dim>::make_bond(face, materials, packing.thickness);
      if (face.cut >= 0) {
        contacts_.add_joint(b, face.cut, packing.cuts[face.cut].normal(),
                            get(packing.centre, face.j));
        continue;
      }
      // Closed faces press with nothing, not even with rounding: that would be a load from the
      // start.
      const Vector<dim> between = get(packing.centre, b.j) - get(packing.centre, b.i);
      b.distance = std::min(b.distance, between.norm());
      contacts_.add(b, true);
    }
  contacts_.settle();
  if (may_meet_)
    search_.watch_from_reference();
}

template <int dim>
const Contact<dim> *ContactForces<dim>::add_broken(const Bond<dim> &b)
{
  search_.add_surface_particle(b.i);
  search_.add_surface_particle(b.j);
  searching_ = true;
  return guests_ && !guests_->keeps(b.i, b.j) ? nullptr : &contacts_.add(b, true);
}

template <int dim>
double ContactForces<dim>::act_broken(const Bond<dim> &b, const Vector<dim> &pressing, Particles &p,
                                      double dt)
{
  const Contact<dim> *const contact = add_broken(b);
  if (!contact)
    return 0;
  const std::size_t k = contact - all().data();
  if (!pressing.isZero(0))
    contacts_.take_over(k, b.i == contact->face.i ? pressing : Vector<dim>(-pressing), p);
  contacts_.add_force(k, p, dt);
  return contacts_.compression_energy(*contact, p) + contacts_.slip_energy(*contact, p);
}

template <int dim>
double ContactForces<dim>::act_parted(const std::array<std::int64_t, 3> &name,
                                      const Vector<dim> &pressing, double grown, Particles &p,
                                      double dt)
{
  const std::size_t k = contacts_.place(name);
  contacts_.part(k, grown, p);
  const Contact<dim> &contact = all()[k];
  search_.add_surface_particle(contact.face.i);
  search_.add_surface_particle(contact.face.j);
  searching_ = true;
  if (!pressing.isZero(0) && !contact.is_joint())
    contacts_.take_over(k, pressing, p);
  contacts_.add_force(k, p, dt);
  return contacts_.energy(contact, p);
}

template <int dim>
void ContactForces<dim>::search(Particles &p, const BondNetwork<dim> &bonds, double time,
                                particles::RestBlocks<dim> *rest)
{
  if (!may_touch() || looked_at_ == time)
    return;
  looked_at_ = time;
  searching_ = searching_ || has_slid_;
  if (!searching_) {
    has_slid_ = contacts_.has_slid(p, spacing_ / 4) || (may_meet_ && search_.has_moved(p));
    return;
  }
  search_.update(p, bonds, contacts_);
  any_ = true; // perhaps; ranks agree on it behind the step
  wake(bonds, rest);
}

// Those that the search found join particles that no bond ever joined.
template <int dim>
void ContactForces<dim>::wake(const BondNetwork<dim> &bonds, particles::RestBlocks<dim> *rest) const
{
  if (!rest || rest->all_awake())
    return;
  std::vector<int> asleep;
  for (const auto &contact : all())
    for (const int i : {contact.face.i, contact.face.j})
      if (i < bonds.n_particles() && !rest->is_awake(i)) // no guest
        asleep.push_back(i);
  rest->wake(asleep);
}

template <int dim>
void ContactForces<dim>::add_energies(const Particles &p, Evaluation<dim> &,
                                      std::vector<double> &energy) const
{
  for (const auto &contact : all())
    if (p.part.owns(contact.face.i))
      energy[contact.face.i] += contacts_.energy(contact, p);
}

template <int dim>
void ContactForces<dim>::for_each_moment(const Particles &p, const Evaluation<dim> &,
                                         const VisitMoment<dim> &visit) const
{
  contacts_.for_each_moment(p, [&](int i, const Vector<dim> &lever, const Vector<dim> &force) {
    if (!guests_ || i < guests_->first())
      visit(i, lever, force);
  });
}

template <int dim>
void ContactForces<dim>::save(core::State &state, const core::Names &names) const
{
  contacts_.save(state, names);
  search_.save(state, names);
  core::save_value(state, "contact_search", "looked_at", looked_at_.value_or(std::nan("")));
  core::save_value(state, "contact_search", "searching", std::int64_t(searching_));
  core::save_value(state, "contact_search", "has_slid", std::int64_t(has_slid_));
}

template <int dim>
void ContactForces<dim>::load(const core::State &state, const core::Names &names, const Particles &)
{
  contacts_.load(state, names, images_, [&](int i, int j, double distance) {
    return search_.face_between(i, j, distance);
  });
  search_.load(state, names);
  const double time = core::load_real(state, "contact_search", "looked_at");
  looked_at_ = std::isnan(time) ? std::nullopt : std::optional(time);
  searching_ = core::load_integer(state, "contact_search", "searching") != 0;
  has_slid_ = core::load_integer(state, "contact_search", "has_slid") != 0;
}

template class ContactForces<2>;
template class ContactForces<3>;
} // namespace ligament::dem
