#include "md/energy_change.h"

#include "core/exact_sum.h"
#include "particles/block_sum.h"

#include <numeric>

namespace ligament::md
{
namespace
{
/// That fit in the nearest cache but one.
constexpr int pairs_at_a_time = 1024;
} // namespace

template <int dim>
EnergyChange<dim>::EnergyChange(const Potential &potential, int species, const Vector<dim> &period)
    : has_embedding_(potential.has_embedding()), cutoff_(potential.cutoff()), period_(period),
      table_(make_pair_table(potential, species, species)), passes_(partial_passes<dim>()),
      i_(pairs_at_a_time), j_(pairs_at_a_time), rest_(pairs_at_a_time), share_(pairs_at_a_time, 1.),
      tilts_(pairs_at_a_time, 0.)
{
  for (auto &component : places_)
    component.resize(pairs_at_a_time);
  if (has_embedding_)
    embedding_ = potential.embedding_spline(species);
}

template <int dim>
PartialArrays EnergyChange<dim>::arrays()
{
  PartialArrays k = {};
  k.n_pairs = n_pairs_;
  k.i = i_.data();
  k.j = j_.data();
  for (int c = 0; c < dim; ++c)
    k.reference[c] = places_[c].data();
  k.rest = rest_.data();
  k.share = share_.data();
  k.tilts = tilts_.data();
  k.atoms = atom_records_.data();
  k.density = density_.data();
  k.table = table_.data();
  k.end = double(table_.size() - 1);
  k.inverse_step = k.end / cutoff_;
  k.energy = pair_energy_.data();
  return k;
}

template <int dim>
void EnergyChange<dim>::add_pair(int i, int j, const Vector<dim> &reference)
{
  const int p = n_pairs_++;
  i_[p] = i;
  j_[p] = j;
  for (int c = 0; c < dim; ++c)
    places_[c][p] = reference[c];
  rest_[p] = reference.norm();
}

template <int dim>
double EnergyChange<dim>::pass()
{
  while (n_pairs_ % 8 != 0)
    add_pair(0, 0, Vector<dim>::Constant(2 * cutoff_)); // out of range
  pair_energy_.fill(0);
  (has_embedding_ ? passes_.changes : passes_.pair_changes)(arrays());
  n_pairs_ = 0;
  return std::accumulate(pair_energy_.begin(), pair_energy_.end(), 0.);
}

template <int dim>
double EnergyChange<dim>::find(const NeighbourList &list, const particles::Particles<dim> &atoms,
                               const std::vector<double> &at_rest)
{
  const int n = atoms.size();
  atom_records_.assign(4 * std::size_t(n), 0.);
  for (int i = 0; i < n; ++i)
    for (int c = 0; c < dim; ++c)
      atom_records_[4 * std::size_t(i) + c] = atoms.displacement[c][i];
  density_.assign(n, 0.);
  core::ExactSum sum;
  list.for_each_pair([&](int i, int j, const std::array<int, 3> &periods) {
    Vector<dim> reference;
    for (int c = 0; c < dim; ++c)
      reference[c] = atoms.reference[c][j] - atoms.reference[c][i] + periods[c] * period_[c];
    add_pair(i, j, reference);
    if (n_pairs_ == pairs_at_a_time)
      sum.add(pass());
  });
  sum.add(pass());
  if (has_embedding_)
    sum.merge(
        particles::block_sum(n, [&](int i) { return embedding_.change(at_rest[i], density_[i]); }));
  return sum.value();
}

template class EnergyChange<2>;
template class EnergyChange<3>;
} // namespace ligament::md
