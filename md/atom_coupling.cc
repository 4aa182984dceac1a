// What a coupler asks of atoms: neighbours, who lacks some, forces and terms of the reference.
#include "md/atom_force.h"

#include <algorithm>

namespace ligament::md
{
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
  constexpr int dofs = n_particle_dofs<dim>;
  for (int i = 0; i < atoms.size(); ++i) {
    Vector<dim> k = get(loads_.stiffnesses(), i);
    if (k.isZero(0) || (of && !std::binary_search(of->begin(), of->end(), i)))
      continue;
    Term term{Term::Kind::wall, get(atoms.reference, i), {i}, Eigen::MatrixXd::Zero(dim, dofs), k};
    term.rows.template leftCols<dim>().setIdentity();
    add(term);
  }
}

template <int dim>
void AtomForce<dim>::for_each_neighbour(
    const Particles &atoms, const std::function<void(const particles::Neighbour &)> &visit,
    const std::vector<int> *of) const
{
  const auto is_asked = [&](int i) { return !of || std::binary_search(of->begin(), of->end(), i); };
  AtomTangent<dim>(body_, atoms).for_each_bond([&](const Bond<dim> &b) {
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
  AtomTangent<dim>(body_, atoms).for_each_bond([&](const Bond<dim> &b) {
    ++n_neighbours[b.i];
    ++n_neighbours[b.j];
  });
  std::vector<int> open;
  for (const int i : of)
    if (n_neighbours[i] < whole)
      open.push_back(i);
  return open;
}

#define INSTANTIATE(dim)                                                                           \
  template void AtomForce<dim>::reference_forces(const Particles &, Components<dim> &) const;      \
  template void AtomForce<dim>::add_tangent(                                                       \
      const Particles &, const std::function<void(const particles::QuadraticTerm<dim> &)> &,       \
      const std::vector<int> *) const;                                                             \
  template void AtomForce<dim>::for_each_neighbour(                                                \
      const Particles &, const std::function<void(const particles::Neighbour &)> &,                \
      const std::vector<int> *) const;                                                             \
  template std::vector<int> AtomForce<dim>::open_particles(const Particles &,                      \
                                                           const std::vector<int> &) const;
INSTANTIATE(2)
INSTANTIATE(3)
#undef INSTANTIATE
} // namespace ligament::md
