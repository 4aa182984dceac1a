#include "md/partial_atoms.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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
  is_of_one_kind_ = std::all_of(atoms_.begin(), atoms_.end(), [&](const SharedAtom &a) {
    return a.species == atoms_[0].species;
  });
  if (is_of_one_kind_ && !atoms_.empty())
    lay_out();
}

template <int dim>
void PartialAtoms<dim>::lay_out()
{
  const int n = int(atoms_.size());
  table_ = make_pair_table(potential_, atoms_[0].species, atoms_[0].species);
  passes_ = partial_passes<dim>();
  std::stable_partition(pairs_.begin(), pairs_.end(), [&](const SharedPair &p) {
    return p.reference.norm() < potential_.cutoff();
  });
  const auto add_pair = [&](const SharedPair &p) {
    i_.push_back(p.i);
    j_.push_back(p.j);
    for (int c = 0; c < dim; ++c)
      places_[c].push_back(p.reference[c]);
    share_.push_back(p.share);
    tilts_.push_back(p.tilt_i + p.tilt_j);
    rest_.push_back(p.reference.norm());
  };
  for (const SharedPair &p : pairs_)
    add_pair(p);
  while (i_.size() % 8 != 0)
    add_pair({0, 0, Vector<dim>::Constant(2 * potential_.cutoff()), 0, 0, 0});
  pull_.resize(i_.size());
  pair_slope_.resize(i_.size());
  atom_records_.assign(4 * n, 0.);
  density_.resize(n);
  force_.resize(4 * n);
}

template <int dim>
PartialArrays PartialAtoms<dim>::arrays()
{
  PartialArrays k = {};
  k.n_pairs = int(i_.size());
  k.i = i_.data();
  k.j = j_.data();
  for (int c = 0; c < dim; ++c)
    k.reference[c] = places_[c].data();
  k.share = share_.data();
  k.tilts = tilts_.data();
  k.atoms = atom_records_.data();
  k.table = table_.data();
  const double step = potential_.cutoff() / double(table_.size() - 1);
  k.cutoff2 = potential_.cutoff() * potential_.cutoff();
  k.beyond2 = std::pow(potential_.cutoff() + step / 2, 2); // in the piece of zeros
  k.inverse_step = 1 / step;
  k.pull = pull_.data();
  k.slope = pair_slope_.data();
  k.density = density_.data();
  k.force = force_.data();
  k.rest = rest_.data();
  k.end = double(table_.size() - 1);
  k.energy = pair_energy_.data();
  return k;
}

template <int dim>
void PartialAtoms<dim>::read_displacements(const particles::Particles<dim> &atoms)
{
  for (int i = 0; i < int(atoms_.size()); ++i) {
    for (int c = 0; c < dim; ++c)
      atom_records_[4 * i + c] = atoms.displacement[c][i];
    atom_records_[4 * i + 3] = 0;
  }
}

template <int dim>
void PartialAtoms<dim>::compute_forces(particles::Particles<dim> &atoms)
{
  if (!is_of_one_kind_ || atoms_.empty()) {
    change_densities_plainly(atoms);
    compute_plainly(atoms);
    return;
  }
  const int n = int(atoms_.size());
  read_displacements(atoms);
  std::fill(force_.begin(), force_.end(), 0.);
  const PartialArrays k = arrays();
  if (potential_.has_embedding()) {
    std::fill(density_.begin(), density_.end(), 0.);
    passes_.first(k);
    for (int i = 0; i < n; ++i)
      if (const SharedAtom &a = atoms_[i]; a.share != 0)
        atom_records_[4 * i + 3] =
            a.share * (potential_.embedding(a.species, density_[i]).slope - a.rest_slope);
    passes_.second(k);
  } else
    passes_.pairs(k);
  for (int c = 0; c < dim; ++c) {
    atoms.force[c].resize(n);
    for (int i = 0; i < n; ++i)
      atoms.force[c][i] = force_[4 * i + c];
  }
}

// What pairs and tilts have gained since rest; density_ becomes what densities have.
template <int dim>
double PartialAtoms<dim>::change_densities(const particles::Particles<dim> &atoms)
{
  read_displacements(atoms);
  std::fill(density_.begin(), density_.end(), 0.);
  pair_energy_.fill(0);
  (potential_.has_embedding() ? passes_.changes : passes_.pair_changes)(arrays());
  return std::accumulate(pair_energy_.begin(), pair_energy_.end(), 0.);
}

template <int dim>
Bond<dim> PartialAtoms<dim>::bond_of(const SharedPair &p,
                                     const particles::Particles<dim> &atoms) const
{
  Bond<dim> b;
  b.i = p.i;
  b.j = p.j;
  b.reference = p.reference;
  b.moved = get(atoms.displacement, p.j) - get(atoms.displacement, p.i);
  b.present = b.reference + b.moved;
  b.length = b.present.norm();
  return b;
}

template <int dim>
double PartialAtoms<dim>::compute(particles::Particles<dim> &atoms)
{
  const bool is_fast = is_of_one_kind_ && !atoms_.empty();
  double energy = is_fast ? change_densities(atoms) : change_densities_plainly(atoms);
  for (int i = 0; i < int(atoms_.size()) && potential_.has_embedding(); ++i)
    if (const SharedAtom &a = atoms_[i]; a.share != 0)
      energy +=
          a.share * (potential_.embedding_spline(a.species).change(rest_density_[i], density_[i]) -
                     a.rest_slope * density_[i]);
  if (is_fast)
    compute_forces(atoms);
  else
    compute_plainly(atoms);
  return energy;
}

// The same by loops, to be followed by compute_plainly where that finds the forces.
template <int dim>
double PartialAtoms<dim>::change_densities_plainly(const particles::Particles<dim> &atoms)
{
  const int n = int(atoms_.size());
  double energy = 0;
  density_.assign(n, 0.);
  slope_.assign(n, 0.);
  for (const SharedPair &p : pairs_) {
    const Bond<dim> b = bond_of(p, atoms);
    const double from = b.reference.norm();
    if (std::min(from, b.length) >= potential_.cutoff())
      continue;
    const int s = atoms_[p.i].species, t = atoms_[p.j].species;
    const double longer = b.longer();
    energy += p.share * potential_.pair_spline(s, t).change(from, longer);
    if (potential_.has_embedding()) {
      const double at_i = potential_.density_spline(s, t).change(from, longer),
                   at_j = s == t ? at_i : potential_.density_spline(t, s).change(from, longer);
      energy += p.tilt_i * at_i + p.tilt_j * at_j;
      density_[p.i] += at_i;
      density_[p.j] += at_j;
    }
  }
  for (int i = 0; i < n; ++i)
    if (const SharedAtom &a = atoms_[i]; a.share != 0)
      slope_[i] = a.share * (potential_.embedding(a.species, rest_density_[i] + density_[i]).slope -
                             a.rest_slope);
  return energy;
}

template <int dim>
void PartialAtoms<dim>::compute_plainly(particles::Particles<dim> &atoms) const
{
  for (auto &component : atoms.force)
    std::fill(component.begin(), component.end(), 0.);
  for (const SharedPair &p : pairs_) {
    const Bond<dim> b = bond_of(p, atoms);
    const BondJets jets = potential_.bond(atoms_[p.i].species, atoms_[p.j].species, b.length);
    const double tension = p.share * jets.pair.slope +
                           (p.tilt_i + slope_[p.i]) * jets.density_at_i.slope +
                           (p.tilt_j + slope_[p.j]) * jets.density_at_j.slope;
    const Vector<dim> f = tension / b.length * b.present;
    add(atoms.force, p.i, f);
    add(atoms.force, p.j, Vector<dim>(-f));
  }
}

template class PartialAtoms<2>;
template class PartialAtoms<3>;
} // namespace ligament::md
