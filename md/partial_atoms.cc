#include "md/partial_atoms.h"

#include "md/bond_view.h"

#include <algorithm>

namespace ligament::md
{
template <int dim>
PartialAtoms<dim>::PartialAtoms(const Potential &potential, std::vector<SharedPair> pairs,
                                std::vector<SharedAtom> atoms)
    : potential_(potential), pairs_(std::move(pairs)), atoms_(std::move(atoms)),
      rest_density_(atoms_.size(), 0.)
{
  for (const SharedPair &p : pairs_) {
    const BondJets jets =
        potential_.bond(atoms_[p.i].species, atoms_[p.j].species, p.reference.norm());
    rest_density_[p.i] += jets.density_at_i.value;
    rest_density_[p.j] += jets.density_at_j.value;
  }
}

template <int dim>
double PartialAtoms<dim>::compute(particles::Particles<dim> &atoms)
{
  const int n = int(atoms_.size());
  double energy = 0;
  const auto bond_of = [&](const SharedPair &p) {
    Bond<dim> b;
    b.i = p.i;
    b.j = p.j;
    b.reference = p.reference;
    b.moved = get(atoms.displacement, p.j) - get(atoms.displacement, p.i);
    b.present = b.reference + b.moved;
    b.length = b.present.norm();
    return b;
  };
  denser_.assign(n, 0.);
  slope_.assign(n, 0.);
  for (const SharedPair &p : pairs_) {
    const Bond<dim> b = bond_of(p);
    const int s = atoms_[p.i].species, t = atoms_[p.j].species;
    const double from = b.reference.norm(), longer = b.longer();
    energy += p.share * potential_.pair_spline(s, t).change(from, longer);
    if (potential_.has_embedding()) {
      const double at_i = potential_.density_spline(s, t).change(from, longer),
                   at_j = potential_.density_spline(t, s).change(from, longer);
      energy += p.tilt_i * at_i + p.tilt_j * at_j;
      denser_[p.i] += at_i;
      denser_[p.j] += at_j;
    }
  }
  for (int i = 0; i < n; ++i) {
    const SharedAtom &a = atoms_[i];
    if (a.share == 0)
      continue;
    energy +=
        a.share * (potential_.embedding_spline(a.species).change(rest_density_[i], denser_[i]) -
                   a.rest_slope * denser_[i]);
    slope_[i] = a.share * (potential_.embedding(a.species, rest_density_[i] + denser_[i]).slope -
                           a.rest_slope);
  }
  for (auto &component : atoms.force)
    std::fill(component.begin(), component.end(), 0.);
  for (auto &component : atoms.torque)
    std::fill(component.begin(), component.end(), 0.);
  for (const SharedPair &p : pairs_) {
    const Bond<dim> b = bond_of(p);
    const BondJets jets = potential_.bond(atoms_[p.i].species, atoms_[p.j].species, b.length);
    const double tension = p.share * jets.pair.slope +
                           (p.tilt_i + slope_[p.i]) * jets.density_at_i.slope +
                           (p.tilt_j + slope_[p.j]) * jets.density_at_j.slope;
    const Vector<dim> f = tension / b.length * b.present;
    add(atoms.force, p.i, f);
    add(atoms.force, p.j, Vector<dim>(-f));
  }
  return energy;
}

template class PartialAtoms<2>;
template class PartialAtoms<3>;
} // namespace ligament::md
