#include "md/potential.h"

#include "core/check.h"

#include <fmt/format.h>

namespace ligament::md
{
std::string list_of_names(const std::vector<std::string> &names)
{
  std::string list;
  for (const std::string &name : names)
    list += (list.empty() ? "" : ", ") + name;
  return list;
}

Potential::Potential(std::vector<Species> species, std::vector<Spline> pair,
                     std::vector<Spline> density, std::vector<Spline> embedding)
    : species_(std::move(species)), pair_(std::move(pair)), density_(std::move(density)),
      embedding_(std::move(embedding))
{
  const std::size_t n = species_.size();
  core::require(n > 0 && pair_.size() == n * n &&
                    density_.size() == (embedding_.empty() ? 0 : n * n) &&
                    (embedding_.empty() || embedding_.size() == n),
                "a potential lacks functions of some of its species");
  for (const auto *functions : {&pair_, &density_})
    for (const Spline &f : *functions)
      core::require(f.step() == pair_[0].step() && f.pieces().size() == pair_[0].pieces().size(),
                    "the functions of a potential are on different grids");
  for (const Species &s : species_)
    core::require(s.mass > 0,
                  fmt::format("the mass of {} is {} kg: it must be above 0", s.name, s.mass));
}

int Potential::find_species(const std::string &name) const
{
  std::vector<std::string> known;
  for (int a = 0; a < n_species(); ++a) {
    if (species_[a].name == name)
      return a;
    known.push_back(species_[a].name);
  }
  throw core::InputError("the potential has no species \"" + name + "\": it knows " +
                         list_of_names(known) + "; choose one of these");
}

BondJets Potential::bond(int a, int b, double distance) const
{
  BondJets jets;
  if (distance >= cutoff())
    return jets;
  jets.pair = pair_spline(a, b)(distance);
  if (has_embedding()) {
    jets.density_at_i = density_spline(a, b)(distance);
    jets.density_at_j = a == b ? jets.density_at_i : density_spline(b, a)(distance);
  }
  return jets;
}

Jet Potential::embedding(int a, double density) const
{
  return has_embedding() ? embedding_[a](density) : Jet();
}

Potential Potential::normal_form(const std::vector<double> &densities) const
{
  if (!has_embedding())
    return *this;
  const int n = n_species();
  core::require(int(densities.size()) == n, "the normal form needs the density of each species");
  Potential normal = *this;
  for (int a = 0; a < n; ++a) {
    const double slope = embedding(a, densities[a]).slope;
    normal.embedding_[a].add_line(-slope);
    for (int b = 0; b < n; ++b) { // both pairs (a, b) and (b, a) have this share
      normal.pair_[a * n + b].add(slope, density_spline(a, b));
      normal.pair_[b * n + a].add(slope, density_spline(a, b));
    }
  }
  return normal;
}
} // namespace ligament::md
