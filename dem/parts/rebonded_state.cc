// What faces that are bonded again keep, and how it comes back in another object for the same body.
#include "dem/parts/rebonded_faces.h"

#include <cmath>

namespace ligament::dem
{
namespace
{
void visit_turn(NaturalTurn<2> &turn, const std::function<void(const std::string &, double &)> &see)
{
  see("turn", turn.angle);
}
void visit_turn(NaturalTurn<3> &turn, const std::function<void(const std::string &, double &)> &see)
{
  see("turn_w", turn.of_i_in_j.w);
  for (int c = 0; c < 3; ++c)
    see("turn_" + std::to_string(c), turn.of_i_in_j.v[c]);
}

/// see(column, number) for every number of a face.
template <int dim>
void for_each_number(RebondedFace<dim> &f,
                     const std::function<void(const std::string &, double &)> &see)
{
  for (const auto &[name, vector] :
       {std::pair("lever_i_", &f.lever_i), std::pair("lever_j_", &f.lever_j),
        std::pair("normal_i_", &f.normal_i), std::pair("normal_j_", &f.normal_j),
        std::pair("opening_", &f.opening)})
    for (int c = 0; c < dim; ++c)
      see(name + std::to_string(c), (*vector)[c]);
  for (const auto &[name, matrix] :
       {std::pair("strain_i_", &f.strain_i), std::pair("strain_j_", &f.strain_j)})
    for (int c = 0; c < dim * dim; ++c)
      see(name + std::to_string(c), (*matrix)(c / dim, c % dim));
  visit_turn(f.turn, see);
  see("area", f.area);
  see("distance", f.distance);
  see("shear_modulus", f.shear_modulus);
  see("bending", f.bending);
  see("twist", f.twist);
  see("strength", f.strength);
  see("friction", f.friction);
  see("flowed", f.flowed);
  see("pressure_i", f.pressure_i);
  see("pressure_j", f.pressure_j);
  see("gained", f.gained);
}
} // namespace

template <int dim>
void RebondedFaces<dim>::save(core::State &state, const core::Names &names) const
{
  if (!is_on())
    return;
  std::vector<std::int64_t> keys, i, j, acts;
  std::map<std::string, std::vector<double>> numbers;
  for (const auto &[name, face] : faces_) {
    keys.insert(keys.end(), name.begin(), name.end());
    i.push_back(names.name(face.i));
    j.push_back(names.name(face.j));
    acts.push_back(face.acts);
    Face copy = face;
    for_each_number<dim>(
        copy, [&](const std::string &column, double &value) { numbers[column].push_back(value); });
  }
  core::Table table(std::move(keys), 3);
  table.add("i", i);
  table.add("j", j);
  table.add("acts", acts);
  for (const auto &[column, values] : numbers)
    table.add(column, values);
  state["rebonded"] = std::move(table);
  core::save_value(state, "rebonding", "looked_at", looked_at_.value_or(std::nan("")));
  core::save_sum(state, "rebonding_energy", energy_);
}

template <int dim>
void RebondedFaces<dim>::load(const core::State &state, const core::Names &names,
                              const Particles &p)
{
  if (!is_on())
    return;
  const core::Table &table = core::table(state, "rebonded");
  const auto i = table.integers("i"), j = table.integers("j"), acts = table.integers("acts");
  std::map<std::string, std::vector<double>> numbers;
  for (const std::string &column : table.columns())
    numbers[column] = table.reals(column);
  for (std::size_t r = 0; r < table.n_rows(); ++r) {
    Face face{};
    face.i = names.index(i[r]), face.j = names.index(j[r]);
    if (face.i < 0 || face.j < 0)
      continue;
    face.turns_with_i = i[r] < j[r];
    face.acts = acts[r];
    has_new_ = has_new_ || !face.acts;
    for_each_number<dim>(
        face, [&](const std::string &column, double &value) { value = numbers.at(column)[r]; });
    faces_.emplace(Name{table.keys()[3 * r], table.keys()[3 * r + 1], table.keys()[3 * r + 2]},
                   face);
  }
  const double time = core::load_real(state, "rebonding", "looked_at");
  looked_at_ = std::isnan(time) ? std::nullopt : std::optional(time);
  energy_ = core::load_sum(state, "rebonding_energy");
  take_part(p);
}

template class RebondedFaces<2>;
template class RebondedFaces<3>;
} // namespace ligament::dem
