#include "dem/cut_flanks.h"

#include <algorithm>
#include <cmath>

namespace ligament::dem
{
template <int dim>
CutFlanks<dim>::CutFlanks(const packings::Packing<dim> &packing)
    : spacing_(packing.spacing), largest_(packings::largest_diameter(packing)),
      planes_(packing.cuts), cuts_(packing.cuts.size())
{
  for (std::size_t c = 0; c < cuts_.size(); ++c)
    for (int i = 0; i < packing.size(); ++i)
      if (const int at = side(c, get(packing.centre, i)); at != 0)
        cuts_[c].positive[i] = at > 0;
  for (const auto &face : packing.faces) {
    if (face.cut < 0)
      continue;
    auto &[positive, facing] = cuts_[face.cut];
    const bool upwards = packing.cuts[face.cut].normal().dot(face.normal) > 0;
    positive[face.i] = !upwards;
    positive[face.j] = upwards;
    facing[!upwards].push_back(face.i);
    facing[upwards].push_back(face.j);
  }
  for (Flanks &flanks : cuts_)
    for (auto &facing : flanks.facing) {
      std::sort(facing.begin(), facing.end());
      facing.erase(std::unique(facing.begin(), facing.end()), facing.end());
    }
}

template <int dim>
int CutFlanks<dim>::side(std::size_t c, const Vector<dim> &x) const
{
  const double height = planes_[c].height(x);
  if (std::abs(height) >= 1.5 * largest_ || !planes_[c].is_beside(x))
    return 0;
  return height > 0 ? 1 : -1;
}

template <int dim>
bool CutFlanks<dim>::lie_beside(const Vector<dim> &a, const Vector<dim> &b) const
{
  for (std::size_t c = 0; c < planes_.size(); ++c)
    if (side(c, a) * side(c, b) < 0)
      return true;
  return false;
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
int CutFlanks<dim>::partner(const Contact<dim> &c, const Particles &p) const
{
  const Vector<dim> slide = Contacts<dim>::slide(c, p), home = c.home, n = c.cut_normal;
  const auto distance = [&](int k) {
    const Vector<dim> x = get(p.reference, k) + slide - home;
    return (x - n * n.dot(x)).norm();
  };
  const double now = distance(c.face.j);
  if (now < spacing_ / 2)
    return c.face.j;
  const Flanks &flanks = cuts_[c.cut];
  int best = c.face.j;
  double least = now;
  for (const int k : flanks.facing[flanks.positive.at(c.face.j)])
    if (const double d = distance(k); d < least)
      least = d, best = k;
  return least < largest_ ? best : -1;
}

template <int dim>
void CutFlanks<dim>::pass_on_joints(const Particles &p, Contacts<dim> &contacts) const
{
  for (std::size_t k = contacts.all().size(); k-- > 0;) {
    const Contact<dim> &c = contacts.all()[k];
    if (!c.is_joint() || c.is_bonded)
      continue;
    if (const int j = partner(c, p); j != c.face.j)
      contacts.pass_on(k, j, p);
  }
}

template class CutFlanks<2>;
template class CutFlanks<3>;
} // namespace ligament::dem
