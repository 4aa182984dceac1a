// What flow took so far, and the state of strains of the particles' own.
#include "dem/parts/inelastic_strains.h"

#include <cmath>
#include <string>

namespace ligament::dem
{
template <int dim>
core::ExactSum InelasticStrains<dim>::dissipation() const
{
  return sum_of(Streams::taken);
}

template <int dim>
core::ExactSum InelasticStrains<dim>::viscous_dissipation() const
{
  return is_viscous() ? sum_of(Streams::dissipated) : core::ExactSum();
}

template <int dim>
core::ExactSum InelasticStrains<dim>::sum_of(int stream) const
{
  core::ExactSum sum;
  if (!has_begun())
    return sum;
  const double *const of = streams_.stream(stream);
  particles::for_each(part_.owned, [&](int i) {
    if (is_strained(i) && of[i] != 0)
      sum.add(of[i]);
  });
  return sum;
}

template <int dim>
core::ExactSum InelasticStrains<dim>::stored_energy() const
{
  core::ExactSum sum;
  if (!has_begun())
    return sum;
  particles::for_each(part_.owned, [&](int i) {
    if (const double h = history(i); h != 0) {
      const int law = law_number(i) % int(parameters_.size());
      sum.add(volume(i) * dem::stored_energy(parameters_[law], h));
    }
  });
  return sum;
}

// Others of its block may keep numbers that nothing reads: what is saved must not depend on blocks.
template <int dim>
bool InelasticStrains<dim>::has_state(int i) const
{
  return is_strained(i) && (knows_stress(i) || history(i) != 0 || !tensor(i).isZero(0));
}

template <int dim>
void InelasticStrains<dim>::save(core::State &state, const core::Names &names) const
{
  if (!has_law())
    return;
  std::vector<std::int64_t> keys;
  std::vector<std::vector<double>> values(n_streams());
  for (const int i : names.ascending())
    if (has_state(i)) {
      keys.push_back(names.name(i));
      for (int k = 0; k < n_streams(); ++k)
        values[k].push_back(streams_.stream(k)[i]);
    }
  core::Table table(std::move(keys));
  for (int k = 0; k < n_streams(); ++k)
    table.add("number_" + std::to_string(k), values[k]);
  state["inelastic"] = std::move(table);
  core::save_value(state, "flow", "flowed_at", flowed_at_.value_or(std::nan("")));
}

template <int dim>
void InelasticStrains<dim>::load(const core::State &state, const core::Names &names,
                                 const Particles &p)
{
  if (!has_law())
    return;
  const core::Table &table = core::table(state, "inelastic");
  std::vector<char> is_known(body_->n_particles(), 0);
  const auto here = [&](std::size_t row) {
    const int i = names.index(table.keys()[row]);
    return i < body_->n_particles() ? i : -1; // no guest
  };
  for (std::size_t r = 0; r < table.n_rows(); ++r)
    if (const int i = here(r); i >= 0)
      is_known[i] = begun_[i / inelastic_block] = 1;
  for (int k = 0; k < n_streams() && table.n_rows() > 0; ++k) {
    const auto values = table.reals("number_" + std::to_string(k));
    for (std::size_t r = 0; r < table.n_rows(); ++r)
      if (const int i = here(r); i >= 0)
        streams_.stream(k)[i] = values[r];
  }
  const double time = core::load_real(state, "flow", "flowed_at");
  flowed_at_ = std::isnan(time) ? std::nullopt : std::optional(time);
  if (!is_viscous())
    return;
  // Of particles that are new the strain so far is no rate: the next step takes no time.
  particles::for_each(p.part.pressed, [&](int i) {
    if (laws_[law_number(i)].viscous && !is_known[i])
      flowed_at_ = std::nullopt;
  });
}

template class InelasticStrains<2>;
template class InelasticStrains<3>;
} // namespace ligament::dem
