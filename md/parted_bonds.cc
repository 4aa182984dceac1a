#include "md/parted_bonds.h"

#include "core/check.h"

#include <algorithm>

namespace ligament::md
{
template <int dim>
PartedBonds<dim>::PartedBonds(std::vector<Bond<dim>> bonds, double limit, double area)
    : bonds_(std::move(bonds)), is_parted_(bonds_.size(), 0), limit_(limit), area_(area)
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
  for (std::size_t b = 0; b < bonds_.size(); ++b) {
    if (is_parted_[b])
      continue;
    const Bond<dim> &bond = bonds_[b];
    const Vector<dim> present =
        bond.reference + get(atoms.displacement, bond.j) - get(atoms.displacement, bond.i);
    if (present.squaredNorm() > limit_ * limit_)
      part(b, atoms, time);
  }
}

// Pairs by their names; of several images of a pair by the order of the bonds.
template <int dim>
void PartedBonds<dim>::save(core::State &state, const Particles &atoms) const
{
  if (parted_.empty())
    return;
  std::map<std::array<std::int64_t, 2>, std::int64_t> n_of;
  std::vector<std::int64_t> image(bonds_.size());
  for (std::size_t b = 0; b < bonds_.size(); ++b)
    image[b] = n_of[{atoms.global_id[bonds_[b].i], atoms.global_id[bonds_[b].j]}]++;
  std::vector<std::int64_t> rows, i, j, images;
  std::vector<double> times;
  for (std::size_t k = 0; k < parted_.size(); ++k) {
    rows.push_back(std::int64_t(k));
    i.push_back(parted_[k].global_i);
    j.push_back(parted_[k].global_j);
    images.push_back(image[order_[k]]);
    times.push_back(parted_[k].time);
  }
  core::Table table(std::move(rows));
  table.add("i", i);
  table.add("j", j);
  table.add("image", images);
  table.add("time", times);
  state["parted_bonds"] = std::move(table);
}

template <int dim>
void PartedBonds<dim>::load(const core::State &state, const Particles &atoms)
{
  std::fill(is_parted_.begin(), is_parted_.end(), 0);
  order_.clear();
  parted_.clear();
  if (state.count("parted_bonds") == 0)
    return;
  std::map<std::array<std::int64_t, 2>, std::vector<std::size_t>> bonds_of;
  for (std::size_t b = 0; b < bonds_.size(); ++b)
    bonds_of[{atoms.global_id[bonds_[b].i], atoms.global_id[bonds_[b].j]}].push_back(b);
  const core::Table &table = core::table(state, "parted_bonds");
  const auto i = table.integers("i"), j = table.integers("j"), images = table.integers("image");
  const auto times = table.reals("time");
  for (std::size_t k = 0; k < times.size(); ++k) {
    const auto found = bonds_of.find({i[k], j[k]});
    core::require(found != bonds_of.end() && images[k] < std::int64_t(found->second.size()),
                  "the state is of another crystal: a bond of it is not there");
    part(found->second[std::size_t(images[k])], atoms, times[k]);
  }
}

template class PartedBonds<2>;
template class PartedBonds<3>;
} // namespace ligament::md
