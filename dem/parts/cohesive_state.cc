// What faces that soften remember, and how it comes back to those of another object for the same
// body.
#include "dem/parts/cohesive_numbers.h"

namespace ligament::dem
{
template <int dim>
std::optional<BondId> CohesiveFaces<dim>::bond_between(int i, int j) const
{
  std::optional<BondId> found;
  body_.bonds().for_each_bond_of(i, [&](BondId id, const Bond<dim> &b) {
    if (b.i == j || b.j == j)
      found = id;
  });
  return found;
}

template <int dim>
void CohesiveFaces<dim>::go_on(Face &face)
{
  if (face.fall.is_on())
    face.law.shape = {}, face.law.mode_ratio = 1;
  face.opening = face.stayed;
  face.force = face.last_force;
}

template <int dim>
void CohesiveFaces<dim>::save(core::State &state, const core::Names &) const
{
  if (none() && !opened_at_)
    return;
  std::vector<std::int64_t> keys;
  std::map<std::string, std::vector<double>> columns;
  std::vector<std::int64_t> materials;
  for (const auto &[name, face] : faces_) {
    if (!face.is_own)
      continue;
    keys.insert(keys.end(), name.begin(), name.end());
    materials.push_back(face.material);
    for_each_face_number<dim>(
        face, [&](const std::string &column, double value) { columns[column].push_back(value); });
  }
  core::Table table(std::move(keys), 2);
  for (const auto &[column, values] : columns)
    table.add(column, values);
  table.add("material", materials);
  state["cohesive"] = std::move(table);
  core::save_value(state, "cohesive_clock", "opened_at", opened_at_.value_or(std::nan("")));
  core::save_value(state, "cohesive_clock", "has_jumped", std::int64_t(has_jumped_));
  core::save_sum(state, "cohesive_work", work_);
}

template <int dim>
void CohesiveFaces<dim>::load(const core::State &state, const core::Names &names,
                              const Particles &p)
{
  const auto found = state.find("cohesive");
  if (found == state.end())
    return;
  const core::Table &table = found->second;
  std::map<std::string, std::vector<double>> columns;
  for (const std::string &column : table.columns())
    if (column != "material")
      columns[column] = table.reals(column);
  const auto materials = table.integers("material");
  for (std::size_t r = 0; r < table.n_rows(); ++r) {
    const int here = names.index(table.keys()[2 * r]), there = names.index(table.keys()[2 * r + 1]);
    if (here < 0 || there < 0 || std::max(here, there) >= body_.n_particles()) // a guest
      continue;
    const std::optional<BondId> id = bond_between(here, there);
    core::require(id.has_value(), "the state opens a bond that this body doesn't have");
    const Bond<dim> b = body_.bonds().bond(*id);
    Face face = make(*id, b, p, int(materials[r]));
    for_each_face_number<dim>(
        face, [&](const std::string &column, double &value) { value = columns.at(column)[r]; });
    go_on(face);
    faces_.emplace(name_of(b, p), face);
  }
  find_fronts();
  n_all_ = std::int64_t(table.n_rows());
  find_told();
  const double time = core::load_real(state, "cohesive_clock", "opened_at");
  opened_at_ = std::isnan(time) ? std::nullopt : std::optional(time);
  const core::Table &clock = core::table(state, "cohesive_clock");
  has_jumped_ = clock.has("has_jumped") && clock.integers("has_jumped")[0] != 0;
  work_ = core::load_sum(state, "cohesive_work");
}

template void CohesiveFaces<2>::save(core::State &, const core::Names &) const;
template void CohesiveFaces<3>::save(core::State &, const core::Names &) const;
template void CohesiveFaces<2>::load(const core::State &, const core::Names &, const Particles &);
template void CohesiveFaces<3>::load(const core::State &, const core::Names &, const Particles &);
template void CohesiveFaces<2>::go_on(CohesiveFace<2> &);
template void CohesiveFaces<3>::go_on(CohesiveFace<3> &);
template std::optional<BondId> CohesiveFaces<2>::bond_between(int, int) const;
template std::optional<BondId> CohesiveFaces<3>::bond_between(int, int) const;
} // namespace ligament::dem
