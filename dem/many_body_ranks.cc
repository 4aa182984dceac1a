// The many-body law of a body in parts: what ranks tell each other of bonds that break, and whose
// sums are read.
#include "dem/many_body_force.h"

#include <algorithm>

namespace ligament::dem
{
// Asked of all ranks at once: one that refused alone would leave the others waiting.
template <int dim>
void ManyBodyForce<dim>::join(const particles::Owners &owners, const Particles &p)
{
  if (owners.ranks.is_one())
    return;
  const auto refuse_where = [&](bool here, const std::string &what) {
    core::require(!owners.ranks.any(here), what + " is known in one process only; use one rank");
  };
  refuse_where(fracture().faces_open() && strains_.has_law(),
               "a body that flows and whose faces soften or fall");
  refuse_where(!interfaces_.empty(), "a body whose particles of several materials meet");
  refuse_where(rebonded_.is_on(), "a body whose faces are bonded again");
  refuse_where(body_.images().is_any(), "a body whose sides are joined");
  refuse_where(!body_.energy_weights().empty(), "a body with weighted energy");
  core::require(broken_.all().empty(), "parts are joined before anything breaks");
  owners_ = std::make_shared<particles::Owners>(owners);
  strains_.join(p.part);
  names_ = p.names();
  contacts_.join(owners_, p, kept_particles(p));
  if (fracture().faces_open())
    cohesive_.join(owners_, names_, p);
}

// Contacts act on what is stepped; where bonds break by stresses, these are asked for at the other
// ends of the bonds of one's own, too.
template <int dim>
std::vector<char> ManyBodyForce<dim>::kept_particles(const Particles &p) const
{
  std::vector<char> kept(body_.n_particles(), 0);
  particles::for_each(p.part.stepped, [&](int i) { kept[i] = 1; });
  if (search_.reads_stresses())
    particles::for_each(p.part.owned, [&](int i) {
      body_.bonds().for_each_bond_of(
          i, [&](BondId, const Bond<dim> &b) { kept[b.i] = kept[b.j] = 1; });
    });
  return kept;
}

template <int dim>
void ManyBodyForce<dim>::invite(const core::State &state, Particles &p)
{
  if (!ranks().is_one())
    contacts_.invite(state, p);
}

// What one rank sees all are told of; they choose alike.
template <int dim>
void ManyBodyForce<dim>::look_for_breaks_in_parts(const StressedBody<dim> &state, Particles &p)
{
  if (!search_.can_break() && !contacts_.may_touch())
    return;
  const auto exceeding = search_.exceeding_bonds(state);
  std::vector<std::int64_t> seen = contacts_.seen();
  seen.insert(seen.end(), {!exceeding.empty(), !cohesive_.own_torn().empty()});
  seen = ranks().max(std::move(seen));
  contacts_.agree(seen);
  const bool tears = seen.back() != 0, exceeds = *(seen.end() - 2) != 0;
  std::vector<BondName> breaking = tears ? cohesive_.torn_of_body() : std::vector<BondName>();
  const std::size_t n_torn = breaking.size();
  if (exceeds) {
    const auto at_once =
        begin_softening_in_parts(p, search_.breaking(ranks().gather_all(exceeding), body_));
    breaking.insert(breaking.end(), at_once.begin(), at_once.end());
  }
  if (breaking.empty())
    return;
  std::vector<std::int64_t> places;
  break_bonds(p, bonds_here(breaking, places), {});
  cohesive_.follow_torn(n_torn);
  follow_break(p, places, breaking.size());
}

// How a face begins is known to whoever owns its first particle: it has the stresses of both.
template <int dim>
auto ManyBodyForce<dim>::begin_softening_in_parts(const Particles &p,
                                                  const std::vector<ExceedingBond<dim>> &exceeding)
    -> std::vector<BondName>
{
  std::vector<BondName> names, begun;
  for (const auto &bond : exceeding)
    names.push_back(bond.name);
  if (!fracture().faces_open())
    return names;
  std::vector<BondId> own;
  for (const BondName &name : names)
    if (const auto id = bond_between(name); id && p.part.owns(body_.bonds().bond(*id).i))
      own.push_back(*id);
  begin_softening(p, own);
  for (const BondId &id : own)
    if (const Bond<dim> b = body_.bonds().bond(id); cohesive_.has(b, p))
      begun.push_back(cohesive_.name_of(b, p));
  begun = cohesive_.tell_begun(begun, p);
  for (const BondName &name : begun)
    if (const auto id = bond_between(name))
      follow_softening(body_.bonds().bond(*id), p);
  if (!begun.empty())
    began_at_ = time_;
  names.erase(std::remove_if(names.begin(), names.end(),
                             [&](const BondName &name) {
                               return std::binary_search(begun.begin(), begun.end(), name);
                             }),
              names.end());
  return names;
}

template <int dim>
std::vector<BondId> ManyBodyForce<dim>::bonds_here(const std::vector<BondName> &names,
                                                   std::vector<std::int64_t> &places) const
{
  std::vector<BondId> here;
  for (std::size_t k = 0; k < names.size(); ++k)
    if (const auto id = bond_between(names[k])) {
      here.push_back(*id);
      places.push_back(std::int64_t(k));
    }
  return here;
}

template <int dim>
std::optional<BondId> ManyBodyForce<dim>::bond_between(const BondName &name) const
{
  const int i = names_.index(name[0]), j = names_.index(name[1]);
  std::optional<BondId> found;
  if (i >= 0 && j >= 0)
    body_.bonds().for_each_bond_of(i, [&](BondId id, const Bond<dim> &b) {
      if (b.i == j || b.j == j)
        found = id;
    });
  return found;
}

// What broke elsewhere touches contacts, and all faces that soften, as what broke here does.
template <int dim>
void ManyBodyForce<dim>::follow_break(const Particles &p, const std::vector<std::int64_t> &places,
                                      std::size_t n_all)
{
  if (places.empty())
    cohesive_.take_up(p, evaluation_);
  broken_.count(time_, n_broken_, places);
  n_broken_ += std::int64_t(n_all);
  contacts_.follow_break();
}

template <int dim>
Vector<dim> ManyBodyForce<dim>::reaction(int load) const
{
  if (ranks().is_one())
    return evaluation_.reactions[load];
  const auto first = evaluation_.reaction_sums.begin() + dim * load;
  const auto sums = ranks().sum(std::vector<core::ExactSum>(first, first + dim));
  Vector<dim> reaction;
  for (int c = 0; c < dim; ++c)
    reaction[c] = sums[c].value();
  return reaction;
}

template <int dim>
double ManyBodyForce<dim>::breaking_step_error() const
{
  const auto sums = ranks().sum({broken_.step_error(), contacts_.step_error()});
  return sums[0].value() + sums[1].value();
}

template <int dim>
std::vector<BrokenBond<dim>> ManyBodyForce<dim>::broken_bonds_of_body(const Particles &p) const
{
  if (ranks().is_one())
    return broken_.all();
  struct Row
  {
    std::int64_t number, i, j;
    double time, area, energy;
    std::array<double, dim> place, normal;
  };
  std::vector<Row> rows;
  for (std::size_t k = 0; k < broken_.all().size(); ++k) {
    const BrokenBond<dim> &b = broken_.all()[k];
    if (!p.part.owns(b.i))
      continue;
    Row &row = rows.emplace_back(
        Row{broken_.number(k), b.global_i, b.global_j, b.time, b.area, b.energy, {}, {}});
    for (int c = 0; c < dim; ++c)
      row.place[c] = b.position[c], row.normal[c] = b.normal[c];
  }
  rows = ranks().gather_all(rows);
  std::sort(rows.begin(), rows.end(),
            [](const Row &a, const Row &b) { return a.number < b.number; });
  std::vector<BrokenBond<dim>> all;
  for (const Row &row : rows)
    all.push_back({-1, -1, row.i, row.j, row.time, Eigen::Map<const Vector<dim>>(row.place.data()),
                   Eigen::Map<const Vector<dim>>(row.normal.data()), row.area, row.energy});
  return all;
}

template void ManyBodyForce<2>::join(const particles::Owners &, const Particles &);
template void ManyBodyForce<2>::invite(const core::State &, Particles &);
template void ManyBodyForce<3>::join(const particles::Owners &, const Particles &);
template void ManyBodyForce<3>::invite(const core::State &, Particles &);
template void ManyBodyForce<2>::look_for_breaks_in_parts(const StressedBody<2> &, Particles &);
template void ManyBodyForce<3>::look_for_breaks_in_parts(const StressedBody<3> &, Particles &);
template Vector<2> ManyBodyForce<2>::reaction(int) const;
template Vector<3> ManyBodyForce<3>::reaction(int) const;
template double ManyBodyForce<2>::breaking_step_error() const;
template double ManyBodyForce<3>::breaking_step_error() const;
template std::vector<BrokenBond<2>> ManyBodyForce<2>::broken_bonds_of_body(const Particles &) const;
template std::vector<BrokenBond<3>> ManyBodyForce<3>::broken_bonds_of_body(const Particles &) const;
} // namespace ligament::dem
