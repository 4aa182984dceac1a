#include "dem/cut_flanks.h"

#include <algorithm>
#include <cmath>

namespace ligament::dem
{
template <int dim>
CutFlanks<dim>::CutFlanks(const packings::Packing<dim> &packing)
    : spacing_(packing.spacing), largest_(packings::largest_diameter(packing)),
      cuts_(packing.cuts.size())
{
  for (std::size_t c = 0; c < cuts_.size(); ++c)
    for (int i = 0; i < packing.size(); ++i) {
      const Vector<dim> x = get(packing.centre, i);
      const double height = packing.cuts[c].height(x);
      if (std::abs(height) < 1.5 * largest_ && packing.cuts[c].is_beside(x))
        cuts_[c].positive[i] = height > 0;
    }
  const auto facing_of = [&](int i) {
    return Facing{packing.global_id.empty() ? i : packing.global_id[i], i, get(packing.centre, i)};
  };
  for (const auto &face : packing.faces) {
    if (face.cut < 0)
      continue;
    auto &[positive, facing] = cuts_[face.cut];
    const bool upwards = packing.cuts[face.cut].normal().dot(face.normal) > 0;
    positive[face.i] = !upwards;
    positive[face.j] = upwards;
    facing[!upwards].push_back(facing_of(face.i));
    facing[upwards].push_back(facing_of(face.j));
  }
  for (Flanks &flanks : cuts_)
    for (auto &facing : flanks.facing) {
      std::sort(facing.begin(), facing.end(),
                [](const Facing &a, const Facing &b) { return a.particle < b.particle; });
      facing.erase(
          std::unique(facing.begin(), facing.end(),
                      [](const Facing &a, const Facing &b) { return a.particle == b.particle; }),
          facing.end());
    }
}

template <int dim>
bool CutFlanks<dim>::face_each_other(int i, int j) const
{
  return std::any_of(cuts_.begin(), cuts_.end(), [&](const Flanks &flanks) {
    const auto of_i = flanks.positive.find(i), of_j = flanks.positive.find(j);
    return of_i != flanks.positive.end() && of_j != flanks.positive.end() &&
           of_i->second != of_j->second;
  });
}

// In the reference of i's flank: where the other flank's particles have slid to, against the place
// of the partner that the packing gave.
template <int dim>
auto CutFlanks<dim>::next(const Contact<dim> &c, const Particles &p) const -> Next
{
  const Vector<dim> slide = Contacts<dim>::slide(c, p), home = c.home, n = c.cut_normal;
  const auto distance = [&](const Vector<dim> &place) {
    const Vector<dim> x = place + slide - home;
    return (x - n * n.dot(x)).norm();
  };
  const double now = distance(get(p.reference, c.face.j));
  if (now < spacing_ / 2)
    return {true, nullptr};
  const Flanks &flanks = cuts_[c.cut];
  const Facing *best = nullptr;
  double least = now;
  for (const Facing &facing : flanks.facing[flanks.positive.at(c.face.j)])
    if (const double d = distance(facing.place); d < least)
      least = d, best = &facing;
  return least < largest_ ? Next{best == nullptr, best} : Next{false, nullptr};
}

template <int dim>
void CutFlanks<dim>::pass_on_joints(const Particles &p, Contacts<dim> &contacts) const
{
  for (std::size_t k = contacts.all().size(); k-- > 0;) {
    const Contact<dim> &c = contacts.all()[k];
    if (!c.is_joint() || c.is_bonded)
      continue;
    if (const Next to = next(c, p); !to.stays)
      contacts.pass_on(k, to.to ? to.to->particle : -1, p);
  }
}

template class CutFlanks<2>;
template class CutFlanks<3>;
} // namespace ligament::dem
