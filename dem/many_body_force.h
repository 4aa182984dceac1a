// The many-body law of discrete elements: exact isotropic elasticity on any packing, walls,
// tractions, breaking bonds (theory.md sections D1 to D6).
#pragma once

#include "dem/bond_network.h"
#include "dem/fracture_law.h"
#include "dem/surface_loads.h"
#include "particles/particle_force.h"

namespace ligament::dem
{
template <int dim>
class ManyBodyForce : public particles::ParticleForce<dim>
{
public:
  using Particles = particles::Particles<dim>;

  ManyBodyForce(particles::Packing<dim> packing, const DemMaterial &material,
                std::vector<core::BoundaryLoad<dim>> loads, const FractureLaw &fracture = {});

  void compute(Particles &particles, double time) override;

  /// At the loads of the last compute.
  double potential_energy(const Particles &particles) const override;

  /// 2 / omega, omega the largest frequency by Lanczos iteration about the reference, raised by
  /// 1 %; deterministic. Held particles don't move.
  double stable_step(const Particles &particles) const override;

  particles::ElasticConstants<dim> elastic_constants() const override;

  void
  add_tangent(const std::function<void(const particles::QuadraticTerm<dim> &)> &add) const override;

  void
  for_each_face(const std::function<void(const particles::FaceView<dim> &)> &visit) const override;

  /// Averaged stress tensors in Pa (Voigt order, in-plane components in 2D), theory.md eq. (D10).
  void stresses(const Particles &particles, Components<n_strains<dim>> &stress) const;

  /// Largest tension on a face in Pa over the bonds of these particles; 0 when there is none.
  double max_tension(const Particles &particles, const std::vector<int> &of) const;

  /// Force in N of support or traction number `load` (constructor's order) on the body, at the
  /// last compute.
  Vector<dim> reaction(int load) const { return surface_.reaction(load); }
  /// Work in J of supports and tractions since the last reset_work, booked by compute().
  double external_work() const { return surface_.external_work(); }
  void reset_work() { surface_.reset_work(); }

  long n_bonds() const { return bonds_.n_bonds(); }
  const DemMaterial &material() const { return material_; }

private:
  /// Forces, torques and pressure_ of bonds and loaded faces.
  void elastic_forces(Particles &particles, SurfaceLoads<dim> &surface,
                      std::vector<double> &pressure) const;
  /// lambda_i theta_i in Pa.
  void dilatation(const Particles &particles, const SurfaceLoads<dim> &surface,
                  std::vector<double> &pressure) const;
  void update_volumetric_stiffness(int i);

  particles::Packing<dim> packing_;
  DemMaterial material_;
  FractureLaw fracture_;
  BondNetwork<dim> bonds_;
  SurfaceLoads<dim> surface_;
  std::vector<double> wall_share_;        // sum of S q / V over faces held along their normal
  std::vector<double> lambda_per_volume_; // lambda_i / V_i, Pa/m^3
  std::vector<double> pressure_;          // lambda_i theta_i, Pa
};
} // namespace ligament::dem
