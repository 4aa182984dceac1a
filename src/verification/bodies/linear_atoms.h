// The force of atoms to first order in their displacements: a harmonic crystal with the terms, the
// reference and the edges of the real one.
#pragma once

#include "md/atom_force.h"
#include "md/atom_tangent.h"
#include "src/scene/atoms.h"
#include "src/simulation/make_force.h"

#include <optional>

namespace ligament::program
{
/// Forces of the reference plus the tangent's, at any amplitude; what else is asked for is the real
/// force's answer.
template <int dim>
class LinearAtoms : public md::AtomForce<dim>
{
public:
  using Particles = particles::Particles<dim>;

  LinearAtoms(const md::Crystal<dim> &crystal, const packings::Packing<dim> &packing)
      : md::AtomForce<dim>(crystal, packing), parts_{crystal.potential(),
                                                     std::vector<int>(packing.centre[0].size(), 0),
                                                     packing.period,
                                                     {},
                                                     {}}
  {
  }

  void compute(Particles &atoms, double) override { add_forces(atoms, atoms.force); }

  double potential_energy(const Particles &atoms) const override
  {
    Components<dim> force;
    add_forces(atoms, force);
    double twice = 0;
    for (int c = 0; c < dim; ++c)
      for (int i = 0; i < atoms.size(); ++i)
        twice -= (force[c][i] + reference_[c][i]) * atoms.displacement[c][i];
    return twice / 2;
  }

private:
  void add_forces(const Particles &atoms, Components<dim> &force) const
  {
    if (!tangent_) {
      tangent_.emplace(parts_, atoms);
      tangent_->keep_stiffness();
      this->reference_forces(atoms, reference_);
    }
    tangent_->apply(atoms.displacement, force);
    for (int c = 0; c < dim; ++c)
      for (int i = 0; i < atoms.size(); ++i)
        force[c][i] += reference_[c][i];
  }

  md::AtomBody<dim> parts_;
  mutable std::optional<md::AtomTangent<dim>> tangent_;
  mutable Components<dim> reference_;
};

/// Makes it for the bodies of make_body().
template <int dim>
std::unique_ptr<particles::ParticleForce<dim>>
make_linear_atoms(const Scene &scene, packings::Packing<dim> packing,
                  const std::vector<core::BoundaryLoad<dim>> &, std::map<std::string, Figure> &,
                  core::Log &)
{
  return std::make_unique<LinearAtoms<dim>>(crystal_of<dim>(scene), packing);
}
} // namespace ligament::program
