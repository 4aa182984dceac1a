// What a coupler asks of atoms: neighbours, who lacks some, forces and terms of the reference,
// parts of the energy.
#include "md/atom_force.h"
#include "md/cauchy_born_law.h"
#include "md/partial_atoms.h"

#include <algorithm>

namespace ligament::md
{
template <int dim>
std::shared_ptr<const core::HyperelasticLaw<dim>> AtomForce<dim>::finite_strain_law() const
{
  return std::make_shared<CauchyBornLaw<dim>>(crystal_);
}

template <int dim>
void AtomForce<dim>::reference_forces(const Particles &, Components<dim> &force) const
{
  // The list may be another one by now, and remembers where it was built.
  Particles atoms = at_rest();
  AtomForce copy = *this;
  copy.list_.template build<dim>(atoms.reference, atoms.displacement);
  body_.screen.apply(copy.list_);
  copy.compute_plainly(atoms);
  force = std::move(atoms.force);
}

template <int dim>
void AtomForce<dim>::add_tangent(
    const Particles &atoms, const std::function<void(const particles::QuadraticTerm<dim> &)> &add,
    const std::vector<int> *of) const
{
  using Term = particles::QuadraticTerm<dim>;
  AtomTangent<dim>(body_, atoms).add_terms(add, of);
  for (int i = 0; i < atoms.size(); ++i) {
    Vector<dim> k = get(loads_.stiffnesses(), i);
    if (k.isZero(0) || (of && !std::binary_search(of->begin(), of->end(), i)))
      continue;
    Term term{
        Term::Kind::wall, get(atoms.reference, i), {i}, Eigen::MatrixXd::Identity(dim, dim), k};
    add(term);
  }
}

template <int dim>
void AtomForce<dim>::for_each_neighbour(
    const Particles &atoms, const std::function<void(const particles::Neighbour &)> &visit,
    const std::vector<int> *of) const
{
  const auto is_asked = [&](int i) { return !of || std::binary_search(of->begin(), of->end(), i); };
  ReferenceBonds<dim>(body_, atoms).for_each([&](const Bond<dim> &b) {
    if (is_asked(b.i))
      visit({b.i, b.j, true});
    if (is_asked(b.j))
      visit({b.j, b.i, true});
  });
}

template <int dim>
std::vector<int> AtomForce<dim>::open_particles(const Particles &atoms,
                                                const std::vector<int> &of) const
{
  const double cutoff = body_.potential.cutoff();
  const auto &bonds = crystal_.half_bonds();
  const auto whole = 2 * std::count_if(bonds.begin(), bonds.end(),
                                       [&](const Vector<dim> &b) { return b.norm() < cutoff; });
  std::vector<int> n_neighbours(atoms.size(), 0);
  ReferenceBonds<dim>(body_, atoms).for_each([&](const Bond<dim> &b) {
    ++n_neighbours[b.i];
    ++n_neighbours[b.j];
  });
  std::vector<int> open;
  for (const int i : of)
    if (n_neighbours[i] < whole)
      open.push_back(i);
  return open;
}

template <int dim>
std::unique_ptr<particles::PartialForce<dim>>
AtomForce<dim>::part(const Particles &atoms, const std::vector<int> &members,
                     const typename particles::ParticleForce<dim>::TermShare &share) const
{
  using Part = PartialAtoms<dim>;
  const int n = int(members.size());
  std::vector<int> index(atoms.size(), -1);
  std::vector<typename Part::SharedAtom> shared;
  std::vector<std::vector<int>> neighbours; // of members, themselves first
  const auto rest_slope = [&](int i) {
    return body_.potential.embedding(body_.species[i], reference_density_[i]).slope;
  };
  for (int m = 0; m < n; ++m) {
    index[members[m]] = m;
    shared.push_back({body_.species[members[m]], 0., rest_slope(members[m])});
    neighbours.push_back({members[m]});
  }
  const Particles rest = at_rest();
  NeighbourList list(list_.cutoff() + list_.skin(), 0, body_.period);
  list.build<dim>(rest.reference, rest.displacement);
  std::vector<typename Part::SharedPair> pairs;
  for_each_bond<dim>(list, rest, body_.period, false, [&](const Bond<dim> &b) {
    const int i = index[b.i], j = index[b.j];
    if (b.length < list_.cutoff()) {
      if (i >= 0)
        neighbours[i].push_back(b.j);
      if (j >= 0)
        neighbours[j].push_back(b.i);
    }
    if (i < 0 || j < 0)
      return;
    const double s = share(Vector<dim>(get(reference_, b.i) + b.reference / 2), {b.i, b.j});
    pairs.push_back({i, j, b.reference, s * body_.weight_of(b.i, b.j),
                     s * body_.weight_of(b.i) * shared[i].rest_slope,
                     s * body_.weight_of(b.j) * shared[j].rest_slope});
  });
  for (int m = 0; m < n && body_.potential.has_embedding(); ++m)
    shared[m].share = body_.weight_of(members[m]) *
                      share(Vector<dim>(get(reference_, members[m])), neighbours[m]);
  const auto is_idle = [&](const auto &p) {
    return p.share == 0 && shared[p.i].share == 0 && shared[p.j].share == 0;
  };
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), is_idle), pairs.end());
  return std::make_unique<Part>(body_.potential, std::move(pairs), std::move(shared));
}

#define INSTANTIATE(dim)                                                                           \
  template std::shared_ptr<const core::HyperelasticLaw<dim>> AtomForce<dim>::finite_strain_law()   \
      const;                                                                                       \
  template void AtomForce<dim>::reference_forces(const Particles &, Components<dim> &) const;      \
  template void AtomForce<dim>::add_tangent(                                                       \
      const Particles &, const std::function<void(const particles::QuadraticTerm<dim> &)> &,       \
      const std::vector<int> *) const;                                                             \
  template void AtomForce<dim>::for_each_neighbour(                                                \
      const Particles &, const std::function<void(const particles::Neighbour &)> &,                \
      const std::vector<int> *) const;                                                             \
  template std::unique_ptr<particles::PartialForce<dim>> AtomForce<dim>::part(                     \
      const Particles &, const std::vector<int> &,                                                 \
      const particles::ParticleForce<dim>::TermShare &) const;                                     \
  template std::vector<int> AtomForce<dim>::open_particles(const Particles &,                      \
                                                           const std::vector<int> &) const;
INSTANTIATE(2)
INSTANTIATE(3)
#undef INSTANTIATE
} // namespace ligament::md
