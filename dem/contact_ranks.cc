// Contacts of a body in parts: what ranks tell each other of them, and where they must stop.
#include "core/check.h"
#include "dem/parts/contact_forces.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>
#include <unordered_set>

namespace ligament::dem
{
// Whoever owns one of the two has the contact, too, and sees at the same time that it has changed.
template <int dim>
auto Contacts<dim>::foreign_motions(const std::vector<Change> &changed, const Particles &p) const
    -> std::map<int, Motion>
{
  if (!owners_ || owners_->ranks.is_one())
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
      (owners_->is_own(i) ? own : foreign).insert(i);
  std::vector<Told> told;
  for (const int i : own) {
    Told &t = told.emplace_back();
    t.name = ids_[i];
    const Motion m = motion_of(p, i);
    Eigen::Map<Eigen::Matrix<double, 2 * n, 1>>(t.numbers.data()) << m.velocity, m.force, m.spin,
        m.torque;
  }
  std::map<std::int64_t, Motion> by_name;
  for (const Told &t : owners_->ranks.gather_all(told)) {
    const Eigen::Map<const Eigen::Matrix<double, 2 * n, 1>> all(t.numbers.data());
    by_name[t.name] = {all.template head<dim>(), all.template segment<dim>(dim),
                       all.template segment<n_spins<dim>>(2 * dim),
                       all.template tail<n_spins<dim>>()};
  }
  std::map<int, Motion> found;
  for (const int i : foreign) {
    const auto of = by_name.find(ids_[i]);
    if (of == by_name.end())
      owners_->ranks.abort("a contact is not known to the rank that owns its particle", 1);
    found[i] = of->second;
  }
  return found;
}

template <int dim>
void ContactForces<dim>::join(const particles::Owners &owners)
{
  contacts_.join(owners);
  search_.join(owners);
  agreed_ = Agreed{&owners, owners.ranks.any(!all().empty())};
}

template <int dim>
std::vector<std::int64_t> ContactForces<dim>::seen() const
{
  return {!all().empty(), has_slid_, search_.is_due()};
}

template <int dim>
void ContactForces<dim>::agree(const std::vector<std::int64_t> &seen)
{
  agreed_->any = seen[0] != 0;
  has_slid_ = seen[1] != 0;
  search_.set_due(seen[2] != 0);
}

template <int dim>
void ContactForces<dim>::agree_after_load()
{
  agree(agreed_->owners->ranks.max(seen()));
}

template <int dim>
void ContactForces<dim>::follow_break()
{
  agreed_->any = true;
  searching_ = true;
  search_.set_due(agreed_->owners->ranks.any(search_.is_due()));
}

// Pairs are looked for among the surface particles of all ranks, by the rank of one of them: in the
// cells of a grid of the size of the reach, as update() does.
template <int dim>
bool ContactSearch<dim>::meets_strangers(const Particles &p) const
{
  struct OnSurface
  {
    std::int64_t name;
    double diameter;
    std::array<double, dim> reference, displacement;
    Vector<dim> at() const { return home() + Eigen::Map<const Vector<dim>>(displacement.data()); }
    Vector<dim> home() const { return Eigen::Map<const Vector<dim>>(reference.data()); }
  };
  std::vector<OnSurface> own;
  std::unordered_set<std::int64_t> at_hand;
  for (int i = 0; i < p.size(); ++i)
    at_hand.insert(p.global_id[i]);
  for (const int i : surface_) {
    if (!owners_->is_own(i))
      continue;
    OnSurface &s = own.emplace_back();
    s.name = p.global_id[i];
    s.diameter = diameter(i);
    for (int c = 0; c < dim; ++c)
      s.reference[c] = p.reference[c][i], s.displacement[c] = p.displacement[c][i];
  }
  const double reach = largest_ + 2 * skin_;
  using Cell = std::array<long, dim>;
  const auto cell_of = [&](const Vector<dim> &x) {
    Cell cell;
    for (int c = 0; c < dim; ++c)
      cell[c] = std::lround(std::floor(x[c] / reach));
    return cell;
  };
  std::map<Cell, std::vector<OnSurface>> strangers;
  for (const OnSurface &s : owners_->ranks.gather_all(own))
    if (!at_hand.count(s.name))
      strangers[cell_of(s.at())].push_back(s);
  const auto meets = [&](const OnSurface &a, const OnSurface &b) {
    const double touch = std::min((a.diameter + b.diameter) / 2, (a.home() - b.home()).norm());
    return (a.at() - b.at()).norm() < touch + 2 * skin_ && !flanks_.lie_beside(a.home(), b.home());
  };
  for (const OnSurface &s : own)
    for (int m = 0; m < int(std::pow(3, dim)); ++m) {
      Cell cell = cell_of(s.at());
      for (int c = 0, rest = m; c < dim; ++c, rest /= 3)
        cell[c] += rest % 3 - 1;
      const auto there = strangers.find(cell);
      if (there != strangers.end() &&
          std::any_of(there->second.begin(), there->second.end(),
                      [&](const OnSurface &other) { return meets(s, other); }))
        return true;
    }
  return false;
}

// A flank that has slid by one spacing and a half meets particles two faces further on at most.
template <int dim>
bool ContactSearch<dim>::slides_to_strangers(const Particles &p,
                                             const Contacts<dim> &contacts) const
{
  return std::any_of(contacts.all().begin(), contacts.all().end(), [&](const Contact<dim> &c) {
    return c.is_joint() && !(owners_->is_own(c.face.i) && owners_->is_own(c.face.j)) &&
           (owners_->is_own(c.face.i) || owners_->is_own(c.face.j)) &&
           Contacts<dim>::slide(c, p).norm() > 1.5 * spacing_;
  });
}

template <int dim>
void ContactSearch<dim>::stop_at_strangers(const Particles &p, const Contacts<dim> &contacts) const
{
  if (!owners_ || owners_->ranks.is_one())
    return;
  const auto found = owners_->ranks.max(
      std::vector<std::int64_t>{meets_strangers(p), slides_to_strangers(p, contacts)});
  core::require<core::GuardStop>(
      found[0] == 0, "particles touch that were never near each other and belong to different "
                     "ranks, which see too little of each other; go on with one rank");
  core::require<core::GuardStop>(
      found[1] == 0, "the flanks of a crack have slid by more than 1.5 spacings where it passes "
                     "from one rank to the next, which see too little of each other; go on with "
                     "one rank");
}

template std::map<int, Contacts<2>::Motion>
Contacts<2>::foreign_motions(const std::vector<Change> &, const Particles &) const;
template std::map<int, Contacts<3>::Motion>
Contacts<3>::foreign_motions(const std::vector<Change> &, const Particles &) const;
template void ContactForces<2>::join(const particles::Owners &);
template void ContactForces<3>::join(const particles::Owners &);
template std::vector<std::int64_t> ContactForces<2>::seen() const;
template std::vector<std::int64_t> ContactForces<3>::seen() const;
template void ContactForces<2>::agree(const std::vector<std::int64_t> &);
template void ContactForces<3>::agree(const std::vector<std::int64_t> &);
template void ContactForces<2>::agree_after_load();
template void ContactForces<3>::agree_after_load();
template void ContactForces<2>::follow_break();
template void ContactForces<3>::follow_break();
template void ContactSearch<2>::stop_at_strangers(const Particles &, const Contacts<2> &) const;
template void ContactSearch<3>::stop_at_strangers(const Particles &, const Contacts<3> &) const;
} // namespace ligament::dem
