#include "dem/cut_flanks.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace ligament::dem
{
namespace
{
constexpr double least_cosine = 0.906; // of 25 degrees, between the normals of two flanks

template <int dim>
bool has_turned(const Contact<dim> &c, const particles::Particles<dim> &p)
{
  const auto normal = [&](int k) -> Vector<dim> {
    return c.cut_normal + Turn<dim>::of(p, k).change(c.cut_normal);
  };
  return normal(c.face.i).dot(normal(c.face.j)) < least_cosine;
}
} // namespace

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
  const auto is_joined = [&](int k) { return k < int(is_joined_.size()) && is_joined_[k]; };
  if (!is_joined(i) && !is_joined(j))
    return false;
  return std::any_of(cuts_.begin(), cuts_.end(), [&](const Flanks &flanks) {
    const auto of_i = flanks.positive.find(i), of_j = flanks.positive.find(j);
    return of_i != flanks.positive.end() && of_j != flanks.positive.end() &&
           of_i->second != of_j->second;
  });
}

// Of one's own particles all joints are at hand. Others are told what has changed.
template <int dim>
void CutFlanks<dim>::find_joined(const Particles &p, const Contacts<dim> &contacts)
{
  if (cuts_.empty())
    return;
  std::set<std::int64_t> own;
  for (const Contact<dim> &c : contacts.all())
    for (const int k : {c.face.i, c.face.j})
      if (c.is_joint() && p.part.owns(k))
        own.insert(p.global_id[k]);
  std::vector<std::int64_t> begun, ended;
  std::set_difference(own.begin(), own.end(), own_joined_.begin(), own_joined_.end(),
                      std::back_inserter(begun));
  std::set_difference(own_joined_.begin(), own_joined_.end(), own.begin(), own.end(),
                      std::back_inserter(ended));
  own_joined_ = std::move(own);
  if (guests_) {
    begun = guests_->ranks().gather_all(begun);
    ended = guests_->ranks().gather_all(ended);
  }
  for (const std::int64_t name : ended)
    joined_.erase(name);
  joined_.insert(begun.begin(), begun.end());
  is_joined_.assign(p.size(), 0);
  for (int k = 0; k < p.size() && !joined_.empty(); ++k)
    is_joined_[k] = joined_.count(p.global_id[k]) > 0;
}

template <int dim>
void CutFlanks<dim>::leave(int i, std::int64_t name)
{
  left_.insert(name);
  for (Flanks &flanks : cuts_) {
    flanks.positive.erase(i);
    for (auto &facing : flanks.facing)
      facing.erase(std::remove_if(facing.begin(), facing.end(),
                                  [&](const Facing &f) { return f.name == name; }),
                   facing.end());
  }
}

template <int dim>
void CutFlanks<dim>::leave_where_turned(const Particles &p, const Contacts<dim> &contacts)
{
  if (cuts_.empty())
    return;
  std::vector<std::int64_t> leaving;
  for (const Contact<dim> &c : contacts.all())
    if (c.is_joint() && p.part.owns(c.face.i) && has_turned(c, p))
      for (const int k : {c.face.i, c.face.j})
        if (!has_left(p.global_id[k]))
          leaving.push_back(p.global_id[k]);
  if (guests_)
    leaving = guests_->ranks().gather_all(leaving);
  if (leaving.empty())
    return;
  const std::set<std::int64_t> names(leaving.begin(), leaving.end());
  for (int k = 0; k < p.size(); ++k)
    if (names.count(p.global_id[k]) > 0)
      leave(k, p.global_id[k]);
  for (const std::int64_t name : names)
    leave(-1, name); // where it is not at hand
}

// In the reference of i's flank: where the other flank's particles have slid to, against the place
// of the partner that the packing gave.
template <int dim>
auto CutFlanks<dim>::next(const Contact<dim> &c, const Particles &p) const -> Next
{
  if (has_left(p.global_id[c.face.i]) || has_left(p.global_id[c.face.j]))
    return {false, nullptr};
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

template <int dim>
void CutFlanks<dim>::save(core::State &state) const
{
  if (!cuts_.empty())
    state["left_flanks"] = core::Table(std::vector<std::int64_t>(left_.begin(), left_.end()));
}

template <int dim>
void CutFlanks<dim>::load(const core::State &state, const core::Names &names)
{
  const auto table = state.find("left_flanks"); // which older states don't have
  if (table == state.end())
    return;
  for (const std::int64_t name : table->second.keys())
    leave(names.index(name), name);
}

template class CutFlanks<2>;
template class CutFlanks<3>;
} // namespace ligament::dem
