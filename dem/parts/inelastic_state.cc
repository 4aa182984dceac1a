// What flow took so far, and the state of strains of the particles' own.
#include "dem/parts/inelastic_strains.h"

#include "core/exact_sum.h"

#include <cmath>
#include <string>

namespace ligament::dem
{
template <int dim>
double InelasticStrains<dim>::dissipation() const
{
  return sum_of(Streams::taken);
}

template <int dim>
double InelasticStrains<dim>::viscous_dissipation() const
{
  return is_viscous() ? sum_of(Streams::dissipated) : 0;
}

template <int dim>
double InelasticStrains<dim>::sum_of(int stream) const
{
  if (!has_begun())
    return 0;
  const double *const of = streams_.stream(stream);
  core::ExactSum sum;
  for (int i = 0; i < body_->n_particles(); ++i)
    if (is_strained(i) && of[i] != 0)
      sum.add(of[i]);
  return sum.value();
}

template <int dim>
double InelasticStrains<dim>::stored_energy() const
{
  core::ExactSum sum;
  if (!has_begun())
    return 0;
  for (int i = 0; i < body_->n_particles(); ++i)
    if (const double h = history(i); h != 0) {
      const int law = law_number(i) % int(parameters_.size());
      sum.add(volume(i) * dem::stored_energy(parameters_[law], h));
    }
  return sum.value();
}

template <int dim>
void InelasticStrains<dim>::save(core::State &state, const core::Names &names) const
{
  if (!has_law())
    return;
  std::vector<std::int64_t> keys, ages;
  std::vector<std::vector<double>> values(n_streams());
  for (const int i : names.ascending())
    if (is_strained(i)) {
      keys.push_back(names.name(i));
      ages.push_back(age_[i / inelastic_block]);
      for (int k = 0; k < n_streams(); ++k)
        values[k].push_back(streams_.stream(k)[i]);
    }
  core::Table table(std::move(keys));
  table.add("age", ages);
  for (int k = 0; k < n_streams(); ++k)
    table.add("number_" + std::to_string(k), values[k]);
  state["inelastic"] = std::move(table);
  core::save_value(state, "flow", "flowed_at", flowed_at_.value_or(std::nan("")));
}

template <int dim>
void InelasticStrains<dim>::load(const core::State &state, const core::Names &names,
                                 const Particles &)
{
  if (!has_law())
    return;
  const core::Table &table = core::table(state, "inelastic");
  const auto ages = table.integers("age");
  for (std::size_t r = 0; r < table.n_rows(); ++r)
    if (const int i = names.index(table.keys()[r]); i >= 0) {
      std::uint8_t &age = age_[i / inelastic_block];
      age = std::max(age, std::uint8_t(ages[r]));
    }
  for (int k = 0; k < n_streams(); ++k) {
    const auto values = table.reals("number_" + std::to_string(k));
    for (std::size_t r = 0; r < table.n_rows(); ++r)
      if (const int i = names.index(table.keys()[r]); i >= 0)
        streams_.stream(k)[i] = values[r];
  }
  const double time = core::load_real(state, "flow", "flowed_at");
  flowed_at_ = std::isnan(time) ? std::nullopt : std::optional(time);
  if (!is_viscous())
    return;
  // Of particles that are new the strain so far is no rate: the next step takes no time.
  std::vector<char> is_known(body_->n_particles(), 0);
  for (std::size_t r = 0; r < table.n_rows(); ++r)
    if (const int i = names.index(table.keys()[r]); i >= 0)
      is_known[i] = 1;
  for (int i = 0; i < body_->n_particles(); ++i)
    if (laws_[law_number(i)].viscous && !is_known[i])
      flowed_at_ = std::nullopt;
}

template class InelasticStrains<2>;
template class InelasticStrains<3>;
} // namespace ligament::dem
