#include "dem/bonded_body.h"

#include <algorithm>
#include <utility>

namespace ligament::dem
{
template <int dim>
BondedBody<dim>::BondedBody(const packings::Packing<dim> &packing, const Materials &materials,
                            const std::vector<WallFace<dim>> &walls)
    : spacing_(packing.spacing), materials_(materials),
      images_(std::make_unique<PeriodicImages<dim>>(packing.period)),
      bonds_(packing, materials, images_.get()), boundary_faces_(packing.boundary_faces),
      lambda_per_volume_(packing.size())
{
  materials_.base().check();
  if (bonds_.n_directions() == 0)
    volumes_ = packing.volume;
  for (const auto &wall : walls)
    wall_share_[wall.i] += wall.area * wall.lever.dot(wall.prescribed.cwiseProduct(wall.normal)) /
                           packing.volume[wall.i];
  for (int i = 0; i < packing.size(); ++i)
    update_volumetric_stiffness(i, packing.volume[i]);
}

template <int dim>
void BondedBody<dim>::update_volumetric_stiffness(int i, double volume)
{
  const auto other = other_share_.find(i);
  lambda_per_volume_[i] =
      lambda_per_volume_with(i, other == other_share_.end() ? 0 : other->second, volume);
}

template <int dim>
double BondedBody<dim>::lambda_per_volume_with(int i, double other_share, double volume) const
{
  const auto wall_share = wall_share_.find(i);
  double phi = wall_share == wall_share_.end() ? 0 : wall_share->second;
  phi += other_share;
  bonds_.for_each_bond_of(i, [&](BondId, const Bond<dim> &b) {
    const double q = i == b.i ? b.lever_i.dot(b.normal) : -b.lever_j.dot(b.normal);
    phi += b.area * q / volume;
  });
  return energy_weight(i) * materials_.of(i).template volumetric_stiffness<dim>(phi) / volume;
}

template <int dim>
void BondedBody<dim>::set_other_shares(const std::map<int, double> &shares, const Particles &p)
{
  std::vector<int> changed;
  for (const auto *of : {&std::as_const(other_share_), &shares})
    for (const auto &[i, share] : *of)
      changed.push_back(i);
  other_share_ = shares;
  for (const int i : changed)
    if (lambda_per_volume_[i] != 0)
      update_volumetric_stiffness(i, p.volume[i]);
}

template <int dim>
void BondedBody<dim>::set_energy_weights(const std::vector<double> &weights)
{
  core::require(energy_weights_.empty() && int(weights.size()) == n_particles(),
                "energy weights are set once, for every particle");
  bonds_.for_each_interface([&](BondId, const Bond<dim> &b) {
    core::require(weights[b.i] == 1 && weights[b.j] == 1,
                  "the overlap sees a bond between two materials");
  });
  energy_weights_ = weights;
  bonds_.set_weights(weights);
  for (int i = 0; i < n_particles(); ++i)
    lambda_per_volume_[i] *= weights[i];
}

// The volumes lose the share of this face; the other faces keep theirs.
template <int dim>
void BondedBody<dim>::remove(const BondId &id, const Bond<dim> &b, const Particles &p)
{
  bonds_.remove(id);
  for (const int i : {b.i, b.j})
    if (lambda_per_volume_[i] != 0)
      update_volumetric_stiffness(i, p.volume[i]);
}

template <int dim>
void BondedBody<dim>::set_other_particles(std::vector<int> particles)
{
  other_particles_ = std::move(particles);
  std::sort(other_particles_.begin(), other_particles_.end());
  other_particles_.erase(std::unique(other_particles_.begin(), other_particles_.end()),
                         other_particles_.end());
}

template <int dim>
void BondedBody<dim>::add_other_particle(int particle)
{
  const auto place = std::lower_bound(other_particles_.begin(), other_particles_.end(), particle);
  if (place == other_particles_.end() || *place != particle)
    other_particles_.insert(place, particle);
}

template class BondedBody<2>;
template class BondedBody<3>;
} // namespace ligament::dem
