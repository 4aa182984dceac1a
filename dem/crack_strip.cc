#include "dem/crack_strip.h"

#include "core/check.h"
#include "dem/grips.h"
#include "dem/many_body_force.h"
#include "dem/principal_tension.h"
#include "particles/particle_solver.h"

#include <cmath>
#include <memory>

namespace ligament::dem
{
namespace
{
constexpr double spacing = 1, modulus = 1, density = 1; // c has no unit: any values do
constexpr double strength = 1e-3; // small strains, as those of stiff materials
/// Waves that cross the strip while K_I grows from 0 to where c = 1.
constexpr double n_crossings = 100;
/// Of that growth the strip starts with so much: its crack then opens without breaking anything.
constexpr double start = 0.5;
constexpr double whole_length = 10; // d

/// A body between grips, in 3D between smooth walls, too, that moves on with its slowest wave
/// across critically damped.
template <int dim>
class DrawnStrip
{
public:
  /// From a state of uniform strain across it.
  DrawnStrip(packings::Packing<dim> packing, const DemMaterial &material, double height,
             double opening_rate, double start_time, const FractureLaw &law = {})
      : time_(start_time)
  {
    particles::Particles<dim> state;
    packings::fill_particles(packing, density, state);
    for (int i = 0; i < state.size(); ++i)
      state.displacement[1][i] = opening_rate * start_time / height * state.reference[1][i];
    auto loads = grips<dim>(opening_rate);
    add_smooth_walls(loads);
    auto owned =
        std::make_unique<ManyBodyForce<dim>>(std::move(packing), material, std::move(loads), law);
    force_ = owned.get();
    dt_ = 0.9 * force_->stable_step(state);
    const double shear_speed = std::sqrt(material.shear_modulus() / density);
    kept_ = std::exp(-2 * M_PI * shear_speed / height * dt_);
    solver_ = std::make_unique<particles::ParticleSolver<dim>>(std::move(state), std::move(owned));
    solver_->compute_forces(time_);
  }

  void step()
  {
    solver_->kick(dt_);
    solver_->scale_velocities(kept_);
    solver_->drift(dt_);
    solver_->compute_forces(time_ += dt_);
  }

  double time() const { return time_; }
  /// Of both grips, in N.
  double load() const { return (force_->reaction(1)[1] - force_->reaction(0)[1]) / 2; }
  /// Area that broke, seen along y, in m^2.
  double broken_area()
  {
    const auto &bonds = force_->broken_bonds();
    for (; n_seen_ < bonds.size(); ++n_seen_)
      area_ += bonds[n_seen_].area * std::abs(bonds[n_seen_].normal[1]);
    return area_;
  }

private:
  const ManyBodyForce<dim> *force_;
  std::unique_ptr<particles::ParticleSolver<dim>> solver_;
  double time_, dt_, kept_, area_ = 0;
  std::size_t n_seen_ = 0;
};
} // namespace

template <int dim>
void CrackStrip::lay_out(packings::SpecimenParameters<dim> &p, const Vector<2> &tip) const
{
  p.spacing = spacing;
  p.lower[0] = -behind, p.upper[0] = ahead;
  p.lower[1] = -height / 2, p.upper[1] = height / 2;
  if constexpr (dim == 2)
    p.cracks = {{{-2 * behind, tip[1]}, {tip[0], tip[1]}}};
  else {
    p.lower[2] = -depth / 2, p.upper[2] = depth / 2;
    const double z = depth;
    p.cracks = {{{-2 * behind, tip[1], -z},
                 {tip[0], tip[1], -z},
                 {tip[0], tip[1], z},
                 {-2 * behind, tip[1], z}}};
  }
}

template <int dim>
void CrackStrip::lay_out_whole(packings::SpecimenParameters<dim> &p) const
{
  lay_out(p, Vector<2>::Zero());
  p.cracks.clear();
  p.lower[0] = -whole_length / 2, p.upper[0] = whole_length / 2;
}

template <int dim>
double CrackStrip::factor(packings::Packing<dim> cracked, packings::Packing<dim> whole,
                          const DemMaterial &of, FractureLaw::Criterion criterion) const
{
  DemMaterial material = of;
  material.youngs_modulus = modulus, material.density = density;
  const double nu = material.poissons_ratio, thickness = dim == 2 ? 1 : depth;
  const bool plane_stress = dim == 2 && material.plane == PlaneMode::stress;
  const double plane_modulus = modulus / (plane_stress ? 1 : 1 - nu * nu);
  const double crossing = height / std::sqrt(material.shear_modulus() / density);
  // K^2 = E' G, G = stress * opening / 2: the opening at which K = strength * sqrt(d), about.
  const double opening = strength * std::sqrt(2 * height * spacing) / plane_modulus;
  const double rate = opening / (n_crossings * crossing), begin = start * n_crossings * crossing;

  // Stress over opening far before the crack; the grips hold particles, not a plane.
  DrawnStrip<dim> drawn(std::move(whole), material, height, rate, begin);
  double stiffness = 0;
  int n = 0;
  while (drawn.time() < begin + 20 * crossing) {
    drawn.step();
    if (drawn.time() > begin + 10 * crossing)
      stiffness += drawn.load() / (whole_length * thickness) / (rate * drawn.time()), ++n;
  }
  stiffness /= n;

  DrawnStrip<dim> strip(std::move(cracked), material, height, rate, begin,
                        {criterion, strength, {}, PrincipalTension<dim>::whole_face(spacing)});
  while (strip.broken_area() < run * thickness * spacing) {
    strip.step();
    core::require<core::EnvironmentError>(strip.time() < 4 * n_crossings * crossing,
                                          "toughness: no crack runs in this packing");
  }
  const double energy_release = 0.5 * stiffness * std::pow(rate * strip.time(), 2);
  return strength * std::sqrt(spacing / (plane_modulus * energy_release));
}

template void CrackStrip::lay_out(packings::SpecimenParameters<2> &, const Vector<2> &) const;
template void CrackStrip::lay_out_whole(packings::SpecimenParameters<2> &) const;
template double CrackStrip::factor(packings::Packing<2>, packings::Packing<2>, const DemMaterial &,
                                   FractureLaw::Criterion) const;
template void CrackStrip::lay_out(packings::SpecimenParameters<3> &, const Vector<2> &) const;
template void CrackStrip::lay_out_whole(packings::SpecimenParameters<3> &) const;
template double CrackStrip::factor(packings::Packing<3>, packings::Packing<3>, const DemMaterial &,
                                   FractureLaw::Criterion) const;
} // namespace ligament::dem
