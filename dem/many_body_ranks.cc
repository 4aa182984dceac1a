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
  refuse_where(!interfaces_.empty(), "a body whose particles of several materials meet");
  refuse_where(strains_.has_law(), "a body that flows");
  refuse_where(fracture().faces_open(), "a body whose faces soften or fall");
  refuse_where(rebonded_.is_on(), "a body whose faces are bonded again");
  refuse_where(body_.images().is_any(), "a body whose sides are joined");
  refuse_where(!body_.energy_weights().empty(), "a body with weighted energy");
  core::require(broken_.all().empty(), "parts are joined before anything breaks");
  owners_ = std::make_shared<particles::Owners>(owners);
  names_ = p.names();
  contacts_.join(owners_, p, kept_particles(p));
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

template <int dim>
std::vector<BondId> ManyBodyForce<dim>::breaking_bonds(const StressedBody<dim> &state,
                                                       std::vector<std::int64_t> &places)
{
  n_breaking_ = 0;
  auto found = search_.exceeding_bonds(state, ranks().rank());
  if (!ranks().is_one()) {
    if (!search_.can_break() && contacts_.none())
      return {};
    std::vector<std::int64_t> seen = contacts_.seen();
    seen.push_back(!found.empty());
    seen = ranks().max(std::move(seen));
    contacts_.agree(seen);
    if (seen.back() == 0)
      return {};
    found = ranks().gather_all(found);
  }
  if (found.empty())
    return {};
  const auto breaking = search_.breaking(std::move(found), body_);
  if (!ranks().is_one())
    n_breaking_ = std::int64_t(breaking.size());
  return bonds_here(breaking, places);
}

template <int dim>
std::vector<BondId> ManyBodyForce<dim>::bonds_here(const std::vector<ExceedingBond<dim>> &bonds,
                                                   std::vector<std::int64_t> &places) const
{
  std::vector<BondId> here;
  for (std::size_t k = 0; k < bonds.size(); ++k)
    if (const auto id = bonds[k].rank == ranks().rank() ? std::optional(bonds[k].id)
                                                        : bond_between(bonds[k].name))
    {
      here.push_back(*id);
      places.push_back(std::int64_t(k));
    }
  return here;
}

template <int dim>
std::optional<BondId>
ManyBodyForce<dim>::bond_between(const std::array<std::int64_t, 2> &name) const
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

// What broke elsewhere touches contacts as what broke here does.
template <int dim>
void ManyBodyForce<dim>::follow_break(const std::vector<std::int64_t> &places)
{
  broken_.count(time_, n_broken_, places);
  n_broken_ += n_breaking_;
  n_breaking_ = 0;
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
template std::vector<BondId> ManyBodyForce<2>::breaking_bonds(const StressedBody<2> &,
                                                              std::vector<std::int64_t> &);
template std::vector<BondId> ManyBodyForce<3>::breaking_bonds(const StressedBody<3> &,
                                                              std::vector<std::int64_t> &);
template void ManyBodyForce<2>::follow_break(const std::vector<std::int64_t> &);
template void ManyBodyForce<3>::follow_break(const std::vector<std::int64_t> &);
template Vector<2> ManyBodyForce<2>::reaction(int) const;
template Vector<3> ManyBodyForce<3>::reaction(int) const;
template double ManyBodyForce<2>::breaking_step_error() const;
template double ManyBodyForce<3>::breaking_step_error() const;
template std::vector<BrokenBond<2>> ManyBodyForce<2>::broken_bonds_of_body(const Particles &) const;
template std::vector<BrokenBond<3>> ManyBodyForce<3>::broken_bonds_of_body(const Particles &) const;
} // namespace ligament::dem
