#include "md/atom_force.h"

#include "core/check.h"
#include "particles/block_sum.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace ligament::md
{
namespace
{
/// Units may be reduced ones, in which a spacing is about 1.
template <int dim>
double skin_of(const Crystal<dim> &crystal, const AtomForceOptions &options)
{
  if (options.skin > 0)
    return options.skin;
  const bool is_atomic = crystal.spacing() > 1e-10 && crystal.spacing() < 1e-9;
  return is_atomic ? 1e-10 : 0.3 * crystal.spacing();
}

template <int dim>
AtomBody<dim> make_body(const Crystal<dim> &crystal, const packings::Packing<dim> &packing,
                        const AtomForceOptions &options)
{
  // Atoms that were farther apart than this and meet have come round the tip.
  const double reach = 1.5 * (crystal.potential().cutoff() + skin_of(crystal, options));
  AtomBody<dim> body{crystal.potential(), options.species, packing.period, {}, {}};
  if (!packing.cuts.empty())
    body.screen = CrackScreen<dim>(packing.cuts, packing.centre, packing.period, reach);
  if (options.species.empty())
    body.species.assign(packing.size(), crystal.parameters().species);
  core::require(int(body.species.size()) == packing.size(),
                "the species of atoms are not as many as the atoms");
  for (const int a : body.species)
    core::require(a >= 0 && a < body.potential.n_species(),
                  "an atom of a species that the potential has not");
  return body;
}

/// Bonds that are gone; the others have kept their order.
template <int dim>
std::vector<Bond<dim>> missing_ones(const std::vector<Bond<dim>> &before,
                                    const std::vector<Bond<dim>> &after)
{
  std::vector<Bond<dim>> missing;
  auto kept = after.begin();
  for (const Bond<dim> &b : before)
    if (kept != after.end() && kept->i == b.i && kept->j == b.j && kept->reference == b.reference)
      ++kept;
    else
      missing.push_back(b);
  return missing;
}

double sum(const std::vector<double> &values)
{
  return particles::block_sum(int(values.size()), [&](int i) { return values[i]; }).value();
}
} // namespace

template <int dim>
AtomForce<dim>::AtomForce(const Crystal<dim> &crystal, const packings::Packing<dim> &packing,
                          const AtomForceOptions &options,
                          const std::vector<core::BoundaryLoad<dim>> &loads)
    : crystal_(crystal), body_(make_body(crystal, packing, options)), reference_(packing.centre),
      kernel_(body_.potential, body_.species),
      loads_(packing, crystal.elastic_constants().stiffness(0, 0) / crystal.spacing(), loads),
      list_(body_.potential.cutoff(), skin_of(crystal, options), packing.period)
{
  const Particles atoms = at_rest();
  list_.build<dim>(atoms.reference, atoms.displacement);
  whole_coordination_ = count_neighbours(atoms);
  const std::vector<Bond<dim>> uncut = nearest_neighbours(atoms);
  body_.screen.apply(list_);
  reference_density_ = densities(atoms);
  reference_energy_ = whole_energy(atoms);
  std::vector<Bond<dim>> nearest = nearest_neighbours(atoms);
  cut_ = missing_ones(uncut, nearest);
  const double n_nearest = double(
      std::count_if(crystal.half_bonds().begin(), crystal.half_bonds().end(),
                    [&](const Vector<dim> &b) { return b.norm() < 1.05 * crystal.spacing(); }));
  // What a P wave needs for ten spacings is three and more periods of the fastest vibration.
  const double lasting =
      options.is_warm ? 10 * crystal.spacing() / crystal.elastic_constants().wave_speed_p : 0;
  parted_ =
      PartedBonds<dim>(std::move(nearest), shell_limit(),
                       dim * crystal.volume() / (n_nearest * crystal.spacing()), lasting);
  looked_build_ = list_.n_builds();
  const auto &species = body_.species;
  const bool is_of_one_kind =
      std::adjacent_find(species.begin(), species.end(), std::not_equal_to<>()) == species.end();
  if (is_of_one_kind && !species.empty())
    energy_change_.emplace(body_.potential, species[0], packing.period);
  // Rows know no cuts.
  if (options.keeps_neighbours && body_.screen.is_empty() && is_of_one_kind)
    rows_.emplace(crystal, packing, species[0], list_.cutoff() + list_.skin());
}

template <int dim>
std::vector<Bond<dim>> AtomForce<dim>::nearest_neighbours(const Particles &atoms) const
{
  std::vector<Bond<dim>> nearest;
  for_each_present_bond(atoms, false, [&](const Bond<dim> &b) {
    if (b.length < 1.05 * crystal_.spacing())
      nearest.push_back(b);
  });
  return nearest;
}

template <int dim>
particles::Particles<dim> AtomForce<dim>::at_rest() const
{
  Particles atoms;
  atoms.drop_orientations();
  atoms.resize(int(reference_[0].size()));
  atoms.reference = reference_;
  return atoms;
}

// The list of the reference has all bonds of the rows: while these hold, it does. When they hold
// again, the list of the reference comes back.
template <int dim>
bool AtomForce<dim>::update_list(const Particles &atoms) const
{
  const auto rows_hold = [&] { return rows_ && rows_->holds(atoms.displacement); };
  if (list_is_reference_ && rows_hold())
    return true;
  if (list_.place<dim>(atoms.reference, atoms.displacement))
    return false;
  if (!list_is_reference_ && rows_hold()) {
    const Particles rest = at_rest();
    list_.build<dim>(rest.reference, rest.displacement);
    body_.screen.apply(list_);
    list_is_reference_ = true;
    return true;
  }
  list_.build<dim>(atoms.reference, atoms.displacement);
  body_.screen.apply(list_);
  list_is_reference_ = false;
  built_ = atoms.displacement;
  return false;
}

template <int dim>
void AtomForce<dim>::compute(Particles &atoms, double time)
{
  const bool is_undisturbed = update_list(atoms);
  if (list_.n_builds() != looked_build_ || parted_.is_due(time)) {
    parted_.look(atoms, time);
    looked_build_ = list_.n_builds();
  }
  if (!body_.weight.empty())
    compute_plainly(atoms);
  else if (is_undisturbed)
    rows_->compute(atoms.force);
  else
    kernel_.compute<dim>(list_, atoms.force);
  loads_.add_forces(atoms, time);
}

template <int dim>
std::vector<double> AtomForce<dim>::densities(const Particles &atoms) const
{
  std::vector<double> density(atoms.size(), 0.);
  if (body_.potential.has_embedding())
    for_each_present_bond(atoms, false, [&](const Bond<dim> &b) {
      const BondJets jets = body_.potential.bond(body_.species[b.i], body_.species[b.j], b.length);
      density[b.i] += jets.density_at_i.value;
      density[b.j] += jets.density_at_j.value;
    });
  return density;
}

template <int dim>
void AtomForce<dim>::compute_plainly(Particles &atoms) const
{
  for (auto &component : atoms.force)
    std::fill(component.begin(), component.end(), 0.);
  for_each_tension(atoms, [&](const Bond<dim> &b, double tension) {
    const Vector<dim> f = tension / b.length * b.present;
    add(atoms.force, b.i, f);
    add(atoms.force, b.j, Vector<dim>(-f));
  });
}

template <int dim>
std::vector<double> AtomForce<dim>::energies(const Particles &atoms) const
{
  std::vector<double> energy(atoms.size(), 0.), density = densities(atoms);
  for_each_present_bond(atoms, false, [&](const Bond<dim> &b) {
    const double half =
        body_.weight_of(b.i, b.j) / 2 *
        body_.potential.bond(body_.species[b.i], body_.species[b.j], b.length).pair.value;
    energy[b.i] += half;
    energy[b.j] += half;
  });
  for (int i = 0; i < atoms.size(); ++i)
    energy[i] += body_.weight_of(i) * body_.potential.embedding(body_.species[i], density[i]).value;
  return energy;
}

template <int dim>
std::vector<double> AtomForce<dim>::energy_changes(const Particles &atoms) const
{
  const Potential &p = body_.potential;
  std::vector<double> energy(atoms.size(), 0.), density(atoms.size(), 0.);
  for_each_present_bond(atoms, true, [&](const Bond<dim> &b) {
    const int a = body_.species[b.i], c = body_.species[b.j];
    const double length = b.reference.norm(), longer = b.longer();
    const double half = body_.weight_of(b.i, b.j) / 2 * p.pair_spline(a, c).change(length, longer);
    energy[b.i] += half;
    energy[b.j] += half;
    if (p.has_embedding()) {
      density[b.i] += p.density_spline(a, c).change(length, longer);
      density[b.j] += p.density_spline(c, a).change(length, longer);
    }
  });
  for (int i = 0; i < atoms.size() && p.has_embedding(); ++i)
    energy[i] += body_.weight_of(i) *
                 p.embedding_spline(body_.species[i]).change(reference_density_[i], density[i]);
  return energy;
}

template <int dim>
double AtomForce<dim>::energy_change(const Particles &atoms) const
{
  return energy_change_ && body_.weight.empty()
             ? energy_change_->find(list_, atoms, reference_density_)
             : sum(energy_changes(atoms));
}

template <int dim>
double AtomForce<dim>::whole_energy(const Particles &atoms) const
{
  return body_.weight.empty() ? kernel_.energy(list_) : sum(energies(atoms));
}

template <int dim>
double AtomForce<dim>::potential_energy(const Particles &atoms) const
{
  update_list(atoms);
  const double bonds =
      list_is_reference_ ? energy_change(atoms) : whole_energy(atoms) - reference_energy_;
  return bonds + loads_.energy(atoms);
}

template <int dim>
double AtomForce<dim>::stable_step(const Particles &atoms) const
{
  const double plain = md::stable_step(AtomTangent<dim>(body_, atoms), atoms);
  double rate = 0; // 1/s^2, by which springs of supports may raise squared frequencies
  for (const auto &component : loads_.stiffnesses())
    for (std::size_t i = 0; i < component.size(); ++i)
      rate = std::max(rate, component[i] * atoms.inverse_mass(int(i)));
  return rate > 0 ? 2 / std::sqrt(4 / (plain * plain) + rate) : plain;
}

template <int dim>
void AtomForce<dim>::set_energy_weights(const std::vector<double> &weights)
{
  core::require(list_is_reference_ && body_.weight.empty() &&
                    weights.size() == body_.species.size(),
                "energy weights are set once, for all atoms, before these move");
  body_.weight = weights;
  reference_energy_ = whole_energy(at_rest());
}

template class AtomForce<2>;
template class AtomForce<3>;
} // namespace ligament::md
