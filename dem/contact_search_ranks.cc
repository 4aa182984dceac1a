// The search for contacts of a body in parts: all ranks tell each other what lies on surfaces and
// on the flanks of initial cracks, and invite what comes near.
#include "dem/contact_search.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ligament::dem
{
template <int dim>
auto CutFlanks<dim>::own_flanks(const Particles &p) const -> std::vector<Told>
{
  std::vector<Told> told;
  for (std::size_t c = 0; c < cuts_.size(); ++c)
    for (const auto &[i, is_positive] : cuts_[c].positive) {
      if (!guests_->is_own(i))
        continue;
      const auto &facing = cuts_[c].facing[is_positive]; // ascending
      const auto place =
          std::lower_bound(facing.begin(), facing.end(), i,
                           [](const Facing &f, int particle) { return f.particle < particle; });
      const bool faces = place != facing.end() && place->particle == i;
      Told &t = told.emplace_back(Told{p.global_id[i], int(c), is_positive, faces, {}});
      for (int a = 0; a < dim; ++a)
        t.place[a] = p.reference[a][i];
    }
  return told;
}

// Ranks own particles in the order of the body: so are the lists that all make of them.
template <int dim>
void CutFlanks<dim>::join(const ContactGuests<dim> &guests, const Particles &p)
{
  guests_ = &guests;
  const auto told = guests.ranks().gather_all(own_flanks(p));
  for (Flanks &flanks : cuts_)
    flanks = {};
  for (const Told &t : told) {
    told_.emplace(t.name, t);
    const int i = guests.index(t.name);
    if (i >= 0)
      cuts_[t.cut].positive[i] = t.is_positive;
    if (t.faces)
      cuts_[t.cut].facing[t.is_positive].push_back(
          {t.name, i, Eigen::Map<const Vector<dim>>(t.place.data())});
  }
}

template <int dim>
void CutFlanks<dim>::append(int i, std::int64_t name)
{
  if (has_left(name))
    return;
  const auto [begin, end] = told_.equal_range(name);
  for (auto of = begin; of != end; ++of) {
    const Told &t = of->second;
    cuts_[t.cut].positive[i] = t.is_positive;
    for (Facing &facing : cuts_[t.cut].facing[t.is_positive])
      if (facing.name == name)
        facing.particle = i;
  }
}

template <int dim>
auto CutFlanks<dim>::passings(const Particles &p, const Contacts<dim> &contacts) const
    -> std::vector<Passing>
{
  std::vector<Passing> found;
  for (const Contact<dim> &c : contacts.all()) {
    if (!c.is_joint() || c.is_bonded || !guests_->is_own(c.face.i))
      continue;
    if (const Next to = next(c, p); !to.stays)
      found.push_back({c.name, p.global_id[c.face.i], to.to ? to.to->name : 0, !to.to});
  }
  return found;
}

template <int dim>
void ContactSearch<dim>::join(ContactGuests<dim> &guests, const Particles &p)
{
  guests_ = &guests;
  flanks_.join(guests, p);
}

template <int dim>
void ContactSearch<dim>::invite(const std::vector<std::int64_t> &names, Particles &p,
                                Contacts<dim> &contacts)
{
  const auto come =
      guests_->invite(names, p, [&](int i, typename ContactGuests<dim>::Guest &guest) {
        guest.material = contacts.material(i);
        guest.diameter = diameter(i);
      });
  contacts.append(come);
  for (const auto &guest : come) {
    const int i = int(on_surface_.size());
    on_surface_.push_back(0);
    if (!diameter_.empty())
      diameter_.push_back(guest.diameter);
    add_seen(i);
    flanks_.append(i, guest.name);
  }
}

// Pairs are looked for in the cells of a grid of the size of the reach, as update() does.
template <int dim>
void ContactSearch<dim>::meet_others(Particles &p, Contacts<dim> &contacts)
{
  struct OnSurface
  {
    std::int64_t name;
    double diameter;
    std::array<double, dim> reference, displacement;
    Vector<dim> home() const { return Eigen::Map<const Vector<dim>>(reference.data()); }
    Vector<dim> at() const { return home() + Eigen::Map<const Vector<dim>>(displacement.data()); }
  };
  const auto told_of = [&](int i) {
    OnSurface s{p.global_id[i], diameter(i), {}, {}};
    for (int c = 0; c < dim; ++c)
      s.reference[c] = p.reference[c][i], s.displacement[c] = p.displacement[c][i];
    return s;
  };
  std::vector<OnSurface> own;
  for (const int i : surface_)
    if (is_own(i))
      own.push_back(told_of(i));
  const double reach = largest_ + 2 * skin_;
  using Cell = std::array<std::int64_t, dim>;
  const auto cell_of = [&](const Vector<dim> &x) {
    Cell cell;
    for (int c = 0; c < dim; ++c)
      cell[c] = std::int64_t(std::floor(x[c] / reach));
    return cell;
  };
  std::map<Cell, std::vector<OnSurface>> strangers;
  for (const OnSurface &s : guests_->ranks().gather_all(own)) {
    const int i = guests_->index(s.name);
    if (i < 0)
      strangers[cell_of(s.at())].push_back(s);
    else if (!on_surface_[i]) // by a face that is not at hand
      add_seen(i);
  }
  std::vector<std::int64_t> wanted;
  for (const int i : surface_) {
    if (!guests_->keeps(i) || strangers.empty())
      continue;
    const OnSurface s = told_of(i);
    const Cell home = cell_of(s.at());
    for (int m = 0; m < int(std::pow(3, dim)); ++m) {
      Cell cell = home;
      for (int c = 0, rest = m; c < dim; ++c, rest /= 3)
        cell[c] += rest % 3 - 1;
      const auto there = strangers.find(cell);
      if (there == strangers.end())
        continue;
      for (const OnSurface &other : there->second)
        if ((s.at() - other.at()).norm() <= reach)
          wanted.push_back(other.name);
    }
  }
  invite(wanted, p, contacts);
}

// Whoever owns particle i of a joint says where it goes on, and tells those that see it for the
// first time what it remembers.
template <int dim>
void ContactSearch<dim>::pass_on_joints(Particles &p, Contacts<dim> &contacts)
{
  using Passing = typename CutFlanks<dim>::Passing;
  const auto all = guests_->ranks().gather_all(flanks_.passings(p, contacts));
  if (all.empty())
    return;
  const auto is_kept = [&](const Passing &passing) {
    return !passing.ends && guests_->keeps(guests_->index(passing.i), guests_->index(passing.to));
  };
  std::vector<std::int64_t> wanted;
  for (const Passing &passing : all)
    if (is_kept(passing)) {
      wanted.push_back(passing.i);
      wanted.push_back(passing.to);
    }
  invite(wanted, p, contacts);
  for (const Passing &passing : all) {
    const auto k = contacts.find(passing.joint);
    if (!k)
      continue;
    if (passing.ends || is_kept(passing))
      contacts.pass_on(*k, passing.ends ? -1 : guests_->index(passing.to), p);
    else
      contacts.erase(*k);
  }
  std::vector<std::size_t> told;
  for (const Passing &passing : all)
    if (const int i = guests_->index(passing.i); !passing.ends && i >= 0 && guests_->is_own(i))
      told.push_back(*contacts.find(passing.joint));
  contacts.tell(told);
}

template void CutFlanks<2>::join(const ContactGuests<2> &, const Particles &);
template void CutFlanks<2>::append(int, std::int64_t);
template void ContactSearch<2>::join(ContactGuests<2> &, const Particles &);
template void ContactSearch<2>::invite(const std::vector<std::int64_t> &, Particles &,
                                       Contacts<2> &);
template void ContactSearch<2>::meet_others(Particles &, Contacts<2> &);
template void ContactSearch<2>::pass_on_joints(Particles &, Contacts<2> &);
template void CutFlanks<3>::join(const ContactGuests<3> &, const Particles &);
template void CutFlanks<3>::append(int, std::int64_t);
template void ContactSearch<3>::join(ContactGuests<3> &, const Particles &);
template void ContactSearch<3>::invite(const std::vector<std::int64_t> &, Particles &,
                                       Contacts<3> &);
template void ContactSearch<3>::meet_others(Particles &, Contacts<3> &);
template void ContactSearch<3>::pass_on_joints(Particles &, Contacts<3> &);
} // namespace ligament::dem
