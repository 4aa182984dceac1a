// Contacts of a body in parts: what ranks tell each other of them.
#include "core/check.h"
#include "dem/contact_numbers.h"
#include "dem/parts/contact_forces.h"

#include <algorithm>
#include <set>

namespace ligament::dem
{
// Whoever owns one of the two has the contact, too, and sees at the same time that it has changed.
template <int dim>
auto Contacts<dim>::foreign_motions(const std::vector<Change> &changed, const Particles &p) const
    -> std::map<int, Motion>
{
  if (!guests_)
    return {};
  constexpr int n = n_particle_dofs<dim>;
  struct Told
  {
    std::int64_t name;
    std::array<double, 2 * n> numbers;
  };
  std::set<int> own, foreign;
  for (const Change &change : changed)
    for (const int i : {contacts_[change.contact].face.i, contacts_[change.contact].face.j})
      (guests_->is_own(i) ? own : foreign).insert(i);
  std::vector<Told> told;
  for (const int i : own) {
    Told &t = told.emplace_back();
    t.name = ids_[i];
    const Motion m = motion_of(p, i);
    Eigen::Map<Eigen::Matrix<double, 2 * n, 1>>(t.numbers.data()) << m.velocity, m.force, m.spin,
        m.torque;
  }
  std::map<std::int64_t, Motion> by_name;
  for (const Told &t : guests_->ranks().gather_all(told)) {
    const Eigen::Map<const Eigen::Matrix<double, 2 * n, 1>> all(t.numbers.data());
    by_name[t.name] = {all.template head<dim>(), all.template segment<dim>(dim),
                       all.template segment<n_spins<dim>>(2 * dim),
                       all.template tail<n_spins<dim>>()};
  }
  std::map<int, Motion> found;
  for (const int i : foreign) {
    const auto of = by_name.find(ids_[i]);
    if (of == by_name.end())
      guests_->ranks().abort("a contact is not known to the rank that owns its particle", 1);
    found[i] = of->second;
  }
  return found;
}

template <int dim>
void Contacts<dim>::join(const ContactGuests<dim> &guests)
{
  guests_ = &guests;
  contacts_.erase(
      std::remove_if(contacts_.begin(), contacts_.end(),
                     [&](const Contact<dim> &c) { return !guests_->keeps(c.face.i, c.face.j); }),
      contacts_.end());
}

template <int dim>
void Contacts<dim>::append(const std::vector<typename ContactGuests<dim>::Guest> &guests)
{
  auto ids = ids_.list();
  for (const auto &guest : guests) {
    ids.push_back(guest.name);
    materials_.append(guest.material);
  }
  ids_ = particles::GlobalIds(ids);
}

namespace
{
/// A contact as ranks tell each other of it.
template <int dim>
struct ToldContact
{
  static constexpr int n_numbers = dim == 2 ? 33 : 47;

  std::array<std::int64_t, 3> name;
  std::int64_t i, j, flags; // names of its particles
  int cut;
  double overlap;
  std::array<double, n_numbers> numbers;
};

/// visit(number) for all that a ToldContact has.
template <int dim, typename C, typename Visit>
void for_each_told(C &c, Visit &&visit)
{
  for_each_number<dim>(c, [&](const std::string &, auto &number) { visit(number); });
  for_each_constant<dim>(c, visit);
}
} // namespace

template <int dim>
void Contacts<dim>::tell(const std::vector<std::size_t> &of)
{
  std::vector<ToldContact<dim>> told;
  for (const std::size_t k : of) {
    Contact<dim> &c = contacts_[k];
    ToldContact<dim> &t = told.emplace_back(ToldContact<dim>{c.name,
                                                             ids_[c.face.i],
                                                             ids_[c.face.j],
                                                             ContactFlags::of(c),
                                                             c.cut,
                                                             c.last_overlap.value_or(0),
                                                             {}});
    auto place = t.numbers.begin();
    for_each_told<dim>(c, [&](double number) { *place++ = number; });
    core::require(place == t.numbers.end(), "numbers of a contact were not counted");
  }
  for (const ToldContact<dim> &t : guests_->ranks().gather_all(told)) {
    const int i = guests_->index(t.i), j = guests_->index(t.j);
    if (!guests_->keeps(i, j) || find(t.name))
      continue;
    core::require(i >= 0 && j >= 0, "a contact is told of before its particles have come");
    const Vector<dim> none = Vector<dim>::Zero();
    Contact<dim> c{t.name, {i, j, none, none, none, 0, 0, 0, 0}, false, 0, 0, 0, 0};
    c.cut = t.cut;
    ContactFlags::set(c, t.flags, t.overlap);
    auto place = t.numbers.begin();
    for_each_told<dim>(c, [&](double &number) { number = *place++; });
    contacts_.push_back(std::move(c));
    settle(); // the next one is looked for
  }
}

template <int dim>
void Contacts<dim>::tell_passed_on()
{
  std::vector<std::size_t> passed_on;
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    if (contacts_[k].is_joint() && !contacts_[k].from_face && guests_->is_own(contacts_[k].face.i))
      passed_on.push_back(k);
  tell(passed_on);
}

template <int dim>
std::optional<std::size_t> Contacts<dim>::find(const std::array<std::int64_t, 3> &name) const
{
  const auto found = std::lower_bound(
      contacts_.begin(), contacts_.end(), name,
      [](const Contact<dim> &c, const std::array<std::int64_t, 3> &n) { return c.name < n; });
  if (found == contacts_.end() || found->name != name)
    return std::nullopt;
  return found - contacts_.begin();
}

template <int dim>
void ContactForces<dim>::join(std::shared_ptr<particles::Owners> owners, const Particles &p,
                              std::vector<char> kept)
{
  guests_ = std::make_unique<ContactGuests<dim>>(std::move(owners), p, std::move(kept));
  contacts_.join(*guests_);
  search_.join(*guests_, p);
  any_ = guests_->ranks().any(!all().empty());
  may_meet_ = guests_->ranks().any(may_meet_);
  if (may_meet_)
    search_.watch_from_reference();
}

template <int dim>
void ContactForces<dim>::invite(const core::State &state, Particles &p)
{
  const core::Table &table = core::table(state, "contacts");
  const auto i = table.integers("i"), j = table.integers("j");
  std::vector<std::int64_t> wanted;
  for (std::size_t r = 0; r < table.n_rows(); ++r)
    if (guests_->keeps(guests_->index(i[r]), guests_->index(j[r]))) {
      wanted.push_back(i[r]);
      wanted.push_back(j[r]);
    }
  search_.invite(wanted, p, contacts_);
}

template <int dim>
std::vector<std::int64_t> ContactForces<dim>::seen() const
{
  return {!all().empty(), has_slid_, search_.is_due()};
}

template <int dim>
void ContactForces<dim>::agree(const std::vector<std::int64_t> &seen)
{
  any_ = seen[0] != 0;
  has_slid_ = seen[1] != 0;
  search_.set_due(seen[2] != 0);
}

template <int dim>
void ContactForces<dim>::agree_after_load()
{
  contacts_.tell_passed_on();
  agree(guests_->ranks().max(seen()));
}

template <int dim>
void ContactForces<dim>::follow_break()
{
  any_ = true;
  searching_ = true;
  search_.set_due(guests_->ranks().any(search_.is_due()));
}

template std::map<int, Contacts<2>::Motion>
Contacts<2>::foreign_motions(const std::vector<Change> &, const Particles &) const;
template std::map<int, Contacts<3>::Motion>
Contacts<3>::foreign_motions(const std::vector<Change> &, const Particles &) const;
template void Contacts<2>::join(const ContactGuests<2> &);
template void Contacts<3>::join(const ContactGuests<3> &);
template void Contacts<2>::append(const std::vector<ContactGuests<2>::Guest> &);
template void Contacts<3>::append(const std::vector<ContactGuests<3>::Guest> &);
template void Contacts<2>::tell(const std::vector<std::size_t> &);
template void Contacts<3>::tell(const std::vector<std::size_t> &);
template std::optional<std::size_t> Contacts<2>::find(const std::array<std::int64_t, 3> &) const;
template std::optional<std::size_t> Contacts<3>::find(const std::array<std::int64_t, 3> &) const;
template void ContactForces<2>::join(std::shared_ptr<particles::Owners>, const Particles &,
                                     std::vector<char>);
template void ContactForces<2>::invite(const core::State &, Particles &);
template std::vector<std::int64_t> ContactForces<2>::seen() const;
template void ContactForces<2>::agree(const std::vector<std::int64_t> &);
template void ContactForces<2>::agree_after_load();
template void ContactForces<2>::follow_break();
template void ContactForces<3>::join(std::shared_ptr<particles::Owners>, const Particles &,
                                     std::vector<char>);
template void ContactForces<3>::invite(const core::State &, Particles &);
template std::vector<std::int64_t> ContactForces<3>::seen() const;
template void ContactForces<3>::agree(const std::vector<std::int64_t> &);
template void ContactForces<3>::agree_after_load();
template void ContactForces<3>::follow_break();
} // namespace ligament::dem
