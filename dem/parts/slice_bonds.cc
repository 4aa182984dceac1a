#include "dem/parts/slice_bonds.h"

namespace ligament::dem
{
template <int dim>
SliceBonds<dim>::SliceBonds(const BondedBody<dim> &body)
    : slices_(body.bonds(), body.materials().base().shear_modulus(),
              body.bonds().n_directions() == 0)
{
  if (!body.volumes().empty())
    slices_.set_volumes(body.bonds(), body.volumes(), body.energy_weights());
}

template <int dim>
const SliceNearness *SliceBonds<dim>::awake_slices(const Particles &p, Evaluation<dim> &e) const
{
  const auto *const ranges = e.ranges(p);
  if (!ranges)
    return nullptr;
  constexpr long of_part = -2; // its ranges stay
  const long version = ranges == &p.part ? of_part : e.rest->version();
  if (e.nearness_version != version) {
    e.nearness = slices_.nearness(*ranges);
    e.nearness_version = version;
  }
  return &e.nearness;
}

template <int dim>
void SliceBonds<dim>::add_pressures(const Particles &p, Evaluation<dim> &e) const
{
  const LatticeArrays<dim> a = e.arrays(p);
  const SliceNearness *const awake = awake_slices(p, e);
  slices_.load(a, records_, awake);
  if (e.body.has_dilatation())
    slices_.add_pressures(a, records_, awake);
}

template <int dim>
void SliceBonds<dim>::add_strains(const Particles &p, Evaluation<dim> &e) const
{
  const LatticeArrays<dim> a = e.arrays(p);
  const SliceNearness *const awake = awake_slices(p, e);
  slices_.load(a, records_, awake);
  slices_.add_strains(a, records_, *e.inelastic, awake);
}

template <int dim>
void SliceBonds<dim>::add_forces(Particles &p, Evaluation<dim> &e) const
{
  const bool has_lattice = e.body.bonds().n_directions() > 0;
  std::vector<int> nothing;
  slices_.forces(e.arrays_with_forces(p), e.look ? e.look->table : BreakScreen{}, records_,
                 e.look ? e.noted.table : nothing, awake_slices(p, e),
                 !(e.look && e.noted.own_terms && has_lattice && e.look->cleared_by_stress),
                 e.has_strains() ? e.sweep() : nullptr);
}

template <int dim>
void SliceBonds<dim>::add_energies(const Particles &p, Evaluation<dim> &e,
                                   std::vector<double> &energy) const
{
  slices_.add_energies(e.arrays(p), records_, energy.data());
}

template <int dim>
void SliceBonds<dim>::remove(const BondId &id, const Bond<dim> &b, const Particles &)
{
  if (id.direction < 0 && !b.joins_materials)
    slices_.remove(id.index);
}

template class SliceBonds<2>;
template class SliceBonds<3>;
} // namespace ligament::dem
