#include "dem/parts/row_bonds.h"

namespace ligament::dem
{
template <int dim>
RowBonds<dim>::RowBonds(const BondedBody<dim> &body)
    : kernel_(body.bonds().directions(), body.bonds().segments(), body.n_particles(),
              body.materials().base().shear_modulus(), body.has_dilatation())
{
}

template <int dim>
void RowBonds<dim>::add_pressures(const Particles &p, Evaluation<dim> &e) const
{
  if (e.body.has_dilatation() || e.inelastic)
    kernel_.dilatation(e.arrays(p), e.body.bonds().segments(), window_, e.sweep());
}

template <int dim>
void RowBonds<dim>::set_forces(Particles &p, Evaluation<dim> &e) const
{
  const BreakScreen screen = e.look ? e.look->rows : BreakScreen{};
  const LatticeArrays<dim> a = e.arrays_with_forces(p);
  std::vector<RowRange> nothing;
  const auto sweep = [&](bool by_particle) {
    const long n_looked = kernel_.forces(
        a, e.body.bonds().segments(), screen, window_, e.look ? e.noted.rows : nothing,
        e.ranges(p), by_particle, !(e.look && e.look->cleared_by_stress), e.sweep());
    if (e.inelastic)
      e.inelastic->may_flow = false;
    return n_looked;
  };
  if (!e.look) {
    sweep(false);
    return;
  }
  const bool has_lattice = e.body.bonds().n_directions() > 0;
  const bool may_look_by_particle = screen.by_particle && !e.ranges(p);
  bool by_particle = may_look_by_particle && e.way.by_particle;
  const auto &others = e.body.other_particles();
  std::vector<double> &before = e.other_pressures; // the sweep adds its own to them
  before.clear();
  if (has_lattice && may_look_by_particle && !by_particle && e.body.has_dilatation())
    for (const int i : others)
      before.push_back(e.pressure[i]);
  const long n_looked = sweep(by_particle);
  if (screen.by_particle)
    e.way.choose(n_looked, e.body.n_particles());
  if (!by_particle && may_look_by_particle && e.way.by_particle) {
    // Once more is less than to look at all that was noted.
    by_particle = true;
    for (std::size_t k = 0; k < before.size(); ++k)
      e.pressure[others[k]] = before[k];
    sweep(true);
  }
  e.noted.own_terms = may_look_by_particle && (by_particle || !has_lattice);
}

template <int dim>
void RowBonds<dim>::set_energies(const Particles &p, Evaluation<dim> &e,
                                 std::vector<double> &energy) const
{
  energy.assign(e.body.n_particles(), 0.);
  kernel_.energies(e.arrays(p), e.body.bonds().segments(), window_, energy.data(),
                   e.sweep());
}

template class RowBonds<2>;
template class RowBonds<3>;
} // namespace ligament::dem
