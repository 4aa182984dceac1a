#include "dem/fracture/broken_bonds.h"

#include <cmath>
#include <map>

namespace ligament::dem
{
template <int dim>
void BrokenBonds<dim>::book_jumps(const Particles &p, double dt, int sign)
{
  for (const Jump &jump : jumps_)
    if (p.part.owns(jump.i)) // what was loaded may be another's
      step_error_.add(
          sign * 0.25 * dt *
          (jump.force.dot(get(p.velocity, jump.i)) + jump.torque.dot(get(p.spin, jump.i))));
}

template <int dim>
void BrokenBonds<dim>::end_step(const Particles &p, double dt)
{
  book_jumps(p, dt, 1);
  jumps_.clear();
}

template <int dim>
void BrokenBonds<dim>::add(const Bond<dim> &b, const Particles &p, double time, double energy,
                           double of_opening)
{
  broken_at_ = time;
  if (p.part.owns(b.i))
    energy_.add(energy);
  all_.push_back({b.i, b.j, p.global_id[b.i], p.global_id[b.j], time,
                  Vector<dim>(get(p.reference, b.i) + b.lever_i), b.normal, b.area,
                  energy + of_opening});
}

template <int dim>
void BrokenBonds<dim>::count(double time, std::int64_t before,
                             const std::vector<std::int64_t> &places)
{
  broken_at_ = time;
  for (const std::int64_t place : places)
    numbers_.push_back(before + place);
  core::require(numbers_.size() == all_.size(), "broken bonds at hand were not counted");
}

template <int dim>
void BrokenBonds<dim>::add_again(double time, double energy)
{
  broken_at_ = time;
  energy_.add(energy);
}

template <int dim>
void BrokenBonds<dim>::take_mean(Particles &p, const std::vector<int> &near,
                                 const std::vector<Wrench<dim>> &before, double dt)
{
  jumps_.clear();
  for (std::size_t k = 0; k < near.size(); ++k) {
    const int i = near[k];
    if (!particles::contains(p.part.stepped, i))
      continue;
    const Jump jump = {i, get(p.force, i) - before[k].force, get(p.torque, i) - before[k].torque};
    if (jump.force.isZero(0) && jump.torque.isZero(0))
      continue;
    ligament::add(p.force, i, Vector<dim>(-0.5 * jump.force));
    ligament::add(p.torque, i, Spin<dim>(-0.5 * jump.torque));
    jumps_.push_back(jump);
  }
  book_jumps(p, dt, -1);
}

template <int dim>
void BrokenBonds<dim>::save(core::State &state, const core::Names &names) const
{
  std::vector<std::int64_t> order, i, j;
  std::vector<double> time, energy;
  for (std::size_t k = 0; k < all_.size(); ++k) {
    const BrokenBond<dim> &b = all_[k];
    order.push_back(number(k));
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
  save_jumps(state, names);
  core::save_value(state, "breaking", "broken_at", broken_at_.value_or(std::nan("")));
  core::save_sum(state, "fracture_energy", energy_);
  core::save_sum(state, "breaking_step_error", step_error_);
}

template <int dim>
void BrokenBonds<dim>::load(const core::State &state, const core::Names &names)
{
  load_jumps(state, names);
  const double time = core::load_real(state, "breaking", "broken_at");
  broken_at_ = std::isnan(time) ? std::nullopt : std::optional(time);
  energy_ = core::load_sum(state, "fracture_energy");
  step_error_ = core::load_sum(state, "breaking_step_error");
}

template <int dim>
void BrokenBonds<dim>::save_jumps(core::State &state, const core::Names &names) const
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

// In the order of the particles, in which take_mean() found them.
template <int dim>
void BrokenBonds<dim>::load_jumps(const core::State &state, const core::Names &names)
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

template class BrokenBonds<2>;
template class BrokenBonds<3>;
} // namespace ligament::dem
