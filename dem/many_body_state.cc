// What the many-body law remembers, and how a new one of the same body takes it up: broken bonds
// are removed again, in their order.
#include "dem/many_body_force.h"

namespace ligament::dem
{
template <int dim>
void ManyBodyForce<dim>::save(core::State &state, const core::Names &names, const Particles &) const
{
  broken_.save(state, names);
  for (const auto *part : parts_)
    part->save(state, names);
  core::save_value(state, "force", "time", time_);
  core::save_value(state, "force", "last_time", last_time_);
  if (fracture().faces_open())
    core::save_value(state, "force", "began_at", began_at_);
}

template <int dim>
void ManyBodyForce<dim>::load(const core::State &state, const core::Names &names,
                              const Particles &p)
{
  core::require(broken_.all().empty(), "a state is loaded into a body that nothing has broken yet");
  replay_broken(state, names, p);
  broken_.load(state, names);
  for (auto *part : parts_)
    part->load(state, names, p);
  for (const int i : cohesive_.particles()) {
    body_.add_other_particle(i);
    strains_.open_cell(i, p.volume[i]);
  }
  if (!ranks().is_one()) {
    contacts_.agree_after_load();
    if (strains_.is_viscous() && ranks().any(!strains_.knows_last_sweep()))
      strains_.forget_last_sweep();
  }
  time_ = core::load_real(state, "force", "time");
  last_time_ = core::load_real(state, "force", "last_time");
  if (core::table(state, "force").has("began_at"))
    began_at_ = core::load_real(state, "force", "began_at");
}

// Bonds of strangers are passed over. The contacts get their order when they are loaded.
template <int dim>
void ManyBodyForce<dim>::replay_broken(const core::State &state, const core::Names &names,
                                       const Particles &p)
{
  const core::Table &table = core::table(state, "broken");
  const auto i = table.integers("i"), j = table.integers("j");
  const auto time = table.reals("time"), energy = table.reals("energy");
  std::vector<std::int64_t> numbers;
  for (std::size_t r = 0; r < table.n_rows(); ++r) {
    const int here = names.index(i[r]), there = names.index(j[r]);
    if (here < 0 || there < 0 || std::max(here, there) >= body_.n_particles()) // a guest
      continue;
    std::optional<BondId> id;
    body_.bonds().for_each_bond_of(here, [&](BondId of, const Bond<dim> &b) {
      if (b.i == there || b.j == there)
        id = of;
    });
    core::require(id.has_value(), "the state breaks a bond that this body doesn't have");
    const Bond<dim> b = body_.bonds().bond(*id);
    drop_bond(*id, b, p);
    contacts_.add_broken(b);
    broken_.add(b, p, time[r], energy[r]);
    numbers.push_back(table.keys()[r]);
  }
  if (ranks().is_one())
    return;
  broken_.set_numbers(std::move(numbers));
  n_broken_ = std::int64_t(table.n_rows());
}

template void ManyBodyForce<2>::save(core::State &, const core::Names &, const Particles &) const;
template void ManyBodyForce<3>::save(core::State &, const core::Names &, const Particles &) const;
template void ManyBodyForce<2>::load(const core::State &, const core::Names &, const Particles &);
template void ManyBodyForce<3>::load(const core::State &, const core::Names &, const Particles &);
} // namespace ligament::dem
