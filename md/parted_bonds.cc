#include "md/parted_bonds.h"

#include "core/check.h"

#include <algorithm>

namespace ligament::md
{
template <int dim>
PartedBonds<dim>::PartedBonds(std::vector<Bond<dim>> bonds, double limit, double area,
                              double lasting)
    : bonds_(std::move(bonds)), is_parted_(bonds_.size(), 0), limit_(limit), area_(area),
      lasting_(lasting)
{
}

template <int dim>
void PartedBonds<dim>::part(std::size_t b, const Particles &atoms, double time)
{
  const Bond<dim> &bond = bonds_[b];
  is_parted_[b] = 1;
  order_.push_back(b);
  parted_.push_back({bond.i, bond.j, atoms.global_id[bond.i], atoms.global_id[bond.j], time,
                     get(atoms.reference, bond.i) + bond.reference / 2, bond.reference.normalized(),
                     area_, 0.});
}

template <int dim>
void PartedBonds<dim>::look(const Particles &atoms, double time)
{
  std::vector<Since> parted;
  for (std::size_t b = 0; b < bonds_.size(); ++b) {
    if (is_parted_[b])
      continue;
    const Bond<dim> &bond = bonds_[b];
    const Vector<dim> present =
        bond.reference + get(atoms.displacement, bond.j) - get(atoms.displacement, bond.i);
    if (present.squaredNorm() <= limit_ * limit_) {
      longer_.erase(b);
      continue;
    }
    const double since = longer_.emplace(b, time).first->second;
    if (time >= since + lasting_)
      parted.push_back({b, since});
  }
  // A look sees all that have been longer for that while: in time they follow those of looks
  // before.
  std::stable_sort(parted.begin(), parted.end(),
                   [](const Since &a, const Since &b) { return a.time < b.time; });
  for (const Since &s : parted) {
    part(s.bond, atoms, s.time);
    longer_.erase(s.bond);
  }
}

template <int dim>
bool PartedBonds<dim>::is_due(double time) const
{
  return std::any_of(longer_.begin(), longer_.end(),
                     [&](const auto &bond) { return time >= bond.second + lasting_; });
}

// Pairs by their names; of several images of a pair by the order of the bonds.
template <int dim>
core::Table PartedBonds<dim>::named(const std::vector<Since> &bonds, const Particles &atoms) const
{
  std::map<std::array<std::int64_t, 2>, std::int64_t> n_of;
  std::vector<std::int64_t> image(bonds_.size());
  for (std::size_t b = 0; b < bonds_.size(); ++b)
    image[b] = n_of[{atoms.global_id[bonds_[b].i], atoms.global_id[bonds_[b].j]}]++;
  std::vector<std::int64_t> rows, i, j, images;
  std::vector<double> times;
  for (std::size_t k = 0; k < bonds.size(); ++k) {
    const Bond<dim> &bond = bonds_[bonds[k].bond];
    rows.push_back(std::int64_t(k));
    i.push_back(atoms.global_id[bond.i]);
    j.push_back(atoms.global_id[bond.j]);
    images.push_back(image[bonds[k].bond]);
    times.push_back(bonds[k].time);
  }
  core::Table table(std::move(rows));
  table.add("i", i);
  table.add("j", j);
  table.add("image", images);
  table.add("time", times);
  return table;
}

template <int dim>
std::vector<typename PartedBonds<dim>::Since>
PartedBonds<dim>::found(const core::Table &table, const Particles &atoms) const
{
  std::map<std::array<std::int64_t, 2>, std::vector<std::size_t>> bonds_of;
  for (std::size_t b = 0; b < bonds_.size(); ++b)
    bonds_of[{atoms.global_id[bonds_[b].i], atoms.global_id[bonds_[b].j]}].push_back(b);
  const auto i = table.integers("i"), j = table.integers("j"), images = table.integers("image");
  const auto times = table.reals("time");
  std::vector<Since> bonds;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const auto same = bonds_of.find({i[k], j[k]});
    core::require(same != bonds_of.end() && images[k] < std::int64_t(same->second.size()),
                  "the state is of another crystal: a bond of it is not there");
    bonds.push_back({same->second[std::size_t(images[k])], times[k]});
  }
  return bonds;
}

template <int dim>
void PartedBonds<dim>::save(core::State &state, const Particles &atoms) const
{
  std::vector<Since> bonds;
  for (std::size_t k = 0; k < parted_.size(); ++k)
    bonds.push_back({order_[k], parted_[k].time});
  if (!bonds.empty())
    state["parted_bonds"] = named(bonds, atoms);
  bonds.clear();
  for (const auto &[bond, time] : longer_)
    bonds.push_back({bond, time});
  if (!bonds.empty())
    state["longer_bonds"] = named(bonds, atoms);
}

template <int dim>
void PartedBonds<dim>::load(const core::State &state, const Particles &atoms)
{
  std::fill(is_parted_.begin(), is_parted_.end(), 0);
  order_.clear();
  parted_.clear();
  longer_.clear();
  if (state.count("parted_bonds") > 0)
    for (const Since &s : found(core::table(state, "parted_bonds"), atoms))
      part(s.bond, atoms, s.time);
  if (state.count("longer_bonds") > 0)
    for (const Since &s : found(core::table(state, "longer_bonds"), atoms))
      longer_[s.bond] = s.time;
}

template class PartedBonds<2>;
template class PartedBonds<3>;
} // namespace ligament::md
