#include "dem/contact_guests.h"

#include "core/check.h"

#include <algorithm>

namespace ligament::dem
{
template <int dim>
ContactGuests<dim>::ContactGuests(std::shared_ptr<particles::Owners> owners, const Particles &p,
                                  std::vector<char> kept)
    : owners_(std::move(owners)), kept_(std::move(kept)), names_(p.names())
{
}

// Whoever owns one of them hears of it from everybody, and tells everybody.
template <int dim>
auto ContactGuests<dim>::invite(std::vector<std::int64_t> names, Particles &p,
                                const Describe &describe) -> std::vector<Guest>
{
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  names.erase(std::remove_if(names.begin(), names.end(), [&](auto n) { return index(n) >= 0; }),
              names.end());
  auto wanted = ranks().gather_all(names);
  if (wanted.empty())
    return {};
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  std::vector<Guest> told;
  for (const std::int64_t name : wanted)
    if (const int i = index(name); i >= 0 && is_own(i)) {
      Guest &g = told.emplace_back(Guest{name, ranks().rank(), 0, p.volume[i], p.mass[i], 0, {}});
      for (int c = 0; c < dim; ++c)
        g.reference[c] = p.reference[c][i];
      describe(i, g);
    }
  std::vector<Guest> come;
  for (const Guest &g : ranks().gather_all(told))
    if (std::binary_search(names.begin(), names.end(), g.name))
      come.push_back(g);
  std::sort(come.begin(), come.end(),
            [](const Guest &a, const Guest &b) { return a.name < b.name; });
  core::require(!ranks().any(come.size() != names.size()),
                "contacts ask for particles that no rank has: the parts of the body come from "
                "different partitions");
  int i = p.size();
  p.append(names);
  for (const Guest &g : come) {
    owners_->of.push_back(g.owner);
    p.volume[i] = g.volume;
    p.mass[i] = g.mass;
    for (int c = 0; c < dim; ++c)
      p.reference[c][i] = g.reference[c];
    ++i;
  }
  names_ = p.names();
  halo_ = particles::Halo<dim>(*owners_, p, first());
  update(p);
  return come;
}

// Forces on guests are their owners' affair: nobody reads what adds up here.
template <int dim>
void ContactGuests<dim>::update(Particles &p)
{
  halo_.update(p);
  for (auto &component : p.force)
    std::fill(component.begin() + first(), component.end(), 0.);
  for (auto &component : p.torque)
    std::fill(component.begin() + first(), component.end(), 0.);
}

template class ContactGuests<2>;
template class ContactGuests<3>;
} // namespace ligament::dem
