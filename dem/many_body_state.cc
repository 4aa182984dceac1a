// What the many-body law remembers, and how a new one of the same body takes it up: broken bonds
// are removed again, in their order.
#include "dem/many_body_force.h"

namespace ligament::dem
{
namespace
{
/// A time that may not have come yet, in s.
void save_time(core::State &state, const std::string &column, const std::optional<double> &time)
{
  core::save_value(state, "force", column, time.value_or(std::nan("")));
}

std::optional<double> load_time(const core::State &state, const std::string &column)
{
  const double time = core::load_real(state, "force", column);
  return std::isnan(time) ? std::nullopt : std::optional(time);
}
} // namespace

template <int dim>
void ManyBodyForce<dim>::save(core::State &state, const core::Names &names,
                              const Particles &) const
{
  save_broken(state);
  save_jumps(state, names);
  contacts_.save(state, names);
  search_.save(state, names);
  surface_.save(state, names);
  if (plastic_)
    plastic_->save(state, names);
  core::save_value(state, "force", "time", time_);
  core::save_value(state, "force", "last_time", last_time_);
  save_time(state, "broken_at", broken_at_);
  save_time(state, "looked_at", looked_at_);
  save_time(state, "flowed_at", flowed_at_);
  core::save_value(state, "force", "searching", std::int64_t(searching_));
  core::save_value(state, "force", "has_slid", std::int64_t(has_slid_));
  core::save_value(state, "force", "fracture_energy", fracture_energy_);
  core::save_value(state, "force", "breaking_step_error", breaking_step_error_);
  core::save_value(state, "force", "plastic_dissipation", plastic_dissipation_);
}

template <int dim>
void ManyBodyForce<dim>::load(const core::State &state, const core::Names &names,
                              const Particles &p)
{
  core::require(broken_.empty(), "a state is loaded into a body that nothing has broken yet");
  replay_broken(state, names, p);
  load_jumps(state, names);
  contacts_.load(state, names, [&](int i, int j, double distance) {
    return search_.face_between(i, j, distance);
  });
  search_.load(state, names);
  surface_.load(state, names);
  if (plastic_) {
    plastic_->load(state, names);
    find_other_particles();
    for_each_plastic([&](int i) { update_flowed_volume(i, p.volume[i]); });
    surface_.set_plastic([&](int i) { return plastic_->strain(i); });
  }
  time_ = core::load_real(state, "force", "time");
  last_time_ = core::load_real(state, "force", "last_time");
  broken_at_ = load_time(state, "broken_at");
  looked_at_ = load_time(state, "looked_at");
  flowed_at_ = load_time(state, "flowed_at");
  searching_ = core::load_integer(state, "force", "searching") != 0;
  has_slid_ = core::load_integer(state, "force", "has_slid") != 0;
  fracture_energy_ = core::load_real(state, "force", "fracture_energy");
  breaking_step_error_ = core::load_real(state, "force", "breaking_step_error");
  plastic_dissipation_ = core::load_real(state, "force", "plastic_dissipation");
}

template <int dim>
void ManyBodyForce<dim>::save_broken(core::State &state) const
{
  std::vector<std::int64_t> order, i, j;
  std::vector<double> time, energy;
  for (const BrokenBond<dim> &b : broken_) {
    order.push_back(std::int64_t(order.size()));
    i.push_back(b.global_i);
    j.push_back(b.global_j);
    time.push_back(b.time);
    energy.push_back(b.energy);
  }
  core::Table table(std::move(order));
  table.add("i", i);
  table.add("j", j);
  table.add("time", time);
  table.add("energy", energy);
  state["broken"] = std::move(table);
}

// Bonds of strangers are passed over.
template <int dim>
void ManyBodyForce<dim>::replay_broken(const core::State &state, const core::Names &names,
                                       const Particles &p)
{
  const core::Table &table = core::table(state, "broken");
  const auto i = table.integers("i"), j = table.integers("j");
  const auto time = table.reals("time"), energy = table.reals("energy");
  for (std::size_t r = 0; r < table.n_rows(); ++r) {
    const int here = names.index(i[r]), there = names.index(j[r]);
    if (here < 0 || there < 0)
      continue;
    std::optional<BondId> id;
    bonds_.for_each_bond_of(here, [&](BondId of, const Bond<dim> &b) {
      if (b.i == there || b.j == there)
        id = of;
    });
    core::require(id.has_value(), "the state breaks a bond that this body doesn't have");
    const Bond<dim> b = bonds_.bond(*id);
    drop_bond(*id, b, p);
    note_broken(b, p, time[r], energy[r]);
  }
}

template <int dim>
void ManyBodyForce<dim>::save_jumps(core::State &state, const core::Names &names) const
{
  std::map<std::int64_t, const Jump *> jumps;
  for (const Jump &jump : jumps_)
    jumps[names.name(jump.i)] = &jump;
  std::vector<std::int64_t> keys;
  Components<dim> force;
  Components<n_spins<dim>> torque;
  for (const auto &[name, jump] : jumps) {
    keys.push_back(name);
    for (int c = 0; c < dim; ++c)
      force[c].push_back(jump->force[c]);
    for (int c = 0; c < n_spins<dim>; ++c)
      torque[c].push_back(jump->torque[c]);
  }
  core::Table table(std::move(keys));
  for (int c = 0; c < dim; ++c)
    table.add("force_" + std::to_string(c), force[c]);
  for (int c = 0; c < n_spins<dim>; ++c)
    table.add("torque_" + std::to_string(c), torque[c]);
  state["jumps"] = std::move(table);
}

// In the order of the particles, in which break_bonds() found them.
template <int dim>
void ManyBodyForce<dim>::load_jumps(const core::State &state, const core::Names &names)
{
  const core::Table &table = core::table(state, "jumps");
  std::map<int, Jump> jumps;
  for (std::size_t r = 0; r < table.n_rows(); ++r)
    if (const int i = names.index(table.keys()[r]); i >= 0)
      jumps[i].i = i;
  for (int c = 0; c < dim + n_spins<dim>; ++c) {
    const auto values =
        table.reals(c < dim ? "force_" + std::to_string(c) : "torque_" + std::to_string(c - dim));
    for (std::size_t r = 0; r < table.n_rows(); ++r)
      if (const int i = names.index(table.keys()[r]); i >= 0)
        (c < dim ? jumps[i].force[c] : jumps[i].torque[c - dim]) = values[r];
  }
  jumps_.clear();
  for (const auto &[i, jump] : jumps)
    jumps_.push_back(jump);
}

template void ManyBodyForce<2>::save(core::State &, const core::Names &, const Particles &) const;
template void ManyBodyForce<3>::save(core::State &, const core::Names &, const Particles &) const;
template void ManyBodyForce<2>::load(const core::State &, const core::Names &, const Particles &);
template void ManyBodyForce<3>::load(const core::State &, const core::Names &, const Particles &);
} // namespace ligament::dem
