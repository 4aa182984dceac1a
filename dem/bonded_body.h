// The bonds of a body and the stiffness of its volumes: what all parts of its force read.
#pragma once

#include "dem/bond_network.h"
#include "dem/edge_cells.h"
#include "dem/loaded_faces.h"

#include <map>

namespace ligament::dem
{
template <int dim>
class BondedBody
{
public:
  using Particles = particles::Particles<dim>;

  /// `walls` enter the volumes of their particles.
  BondedBody(const packings::Packing<dim> &packing, const Materials &materials,
             const std::vector<WallFace<dim>> &walls);

  double spacing() const { return spacing_; } // m
  const Materials &materials() const { return materials_; }
  bool has_dilatation() const { return !materials_.has_no_dilatation(); }
  bool is_plane_strain() const { return dim == 2 && materials_.base().plane == PlaneMode::strain; }
  const BondNetwork<dim> &bonds() const { return bonds_; }
  /// Those beyond joined sides.
  PeriodicImages<dim> &images() const { return *images_; }
  int n_particles() const { return bonds_.n_particles(); }
  const std::vector<packings::BoundaryFace<dim>> &boundary_faces() const { return boundary_faces_; }
  /// m^3; empty: a lattice's.
  const std::vector<double> &volumes() const { return volumes_; }

  /// lambda_i / V_i in Pa/m^3, energy weight included; 0: no volumetric stiffness.
  const std::vector<double> &lambda_per_volume() const { return lambda_per_volume_; }
  /// 1/2 lambda V theta^2 in J of a particle whose lambda theta is `pressure` (Pa).
  double volume_energy(int i, double pressure) const
  {
    return lambda_per_volume_[i] == 0 ? 0 : 0.5 * pressure * pressure / lambda_per_volume_[i];
  }

  /// See ParticleForce::set_energy_weights.
  void set_energy_weights(const std::vector<double> &weights);
  /// Empty: all 1.
  const std::vector<double> &energy_weights() const { return energy_weights_; }
  double energy_weight(int i) const { return energy_weights_.empty() ? 1 : energy_weights_[i]; }

  void set_edge(EdgeCells<dim> edge) { edge_ = std::move(edge); }
  /// Which faces never break, and the pressures of cells that lack faces.
  const EdgeCells<dim> &edge() const { return edge_; }

  /// The bond no longer carries, nor does it enter the volumes.
  void remove(const BondId &id, const Bond<dim> &bond, const Particles &particles);

  /// The sum of S q / V over bonds beside those of the network, of particles that have some; and
  /// these from now on.
  const std::map<int, double> &other_shares() const { return other_share_; }
  void set_other_shares(const std::map<int, double> &shares, const Particles &particles);
  /// lambda_i / V_i if that sum were this one, in a cell of so many m^3.
  double lambda_per_volume_with(int i, double other_share, double volume) const;

  /// Particles whose pressure has parts beside those of lattice bonds, ascending.
  const std::vector<int> &other_particles() const { return other_particles_; }
  void set_other_particles(std::vector<int> particles);
  void add_other_particle(int particle);

private:
  /// For a cell of so many m^3.
  void update_volumetric_stiffness(int i, double volume);

  double spacing_;
  Materials materials_;
  std::unique_ptr<PeriodicImages<dim>> images_;
  BondNetwork<dim> bonds_;
  std::vector<packings::BoundaryFace<dim>> boundary_faces_;
  std::vector<double> volumes_;
  std::map<int, double> wall_share_; // sum of S q / V over faces held along their normal
  std::map<int, double> other_share_; // the same, of bonds beside the network's
  std::vector<double> lambda_per_volume_, energy_weights_;
  EdgeCells<dim> edge_;
  std::vector<int> other_particles_;
};
} // namespace ligament::dem
