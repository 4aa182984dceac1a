// The isotropic elastic material of the many-body law and what follows from its two constants.
#pragma once

#include "core/check.h"
#include "core/types.h"
#include "dem/inelastic/plasticity.h"
#include "dem/inelastic/viscosity.h"
#include "particles/particle_force.h"

#include <algorithm>
#include <cmath>

namespace ligament::dem
{
struct DemMaterial
{
  double youngs_modulus = 1;           // Pa
  double poissons_ratio = 0;           // -, above -1 and below 1/2
  double density = 1;                  // kg/m^3
  PlaneMode plane = PlaneMode::strain; // read in 2D only
  double friction = 0;                 // Coulomb's coefficient of touching faces
  Plasticity plasticity = {};
  Viscosity viscosity = {};

  double shear_modulus() const { return youngs_modulus / (2 * (1 + poissons_ratio)); }

  /// The A of theory.md eq. (D9).
  double mean_stress_share() const { return 3 * poissons_ratio / (1 + poissons_ratio); }

  /// Volumetric stiffness of a particle in Pa, theory.md eq. (D9); phi is the sum of S q / V over
  /// the faces that carry load, without the out-of-plane faces. Zero for nu = 0.
  template <int dim>
  double volumetric_stiffness(double phi) const
  {
    const double out_of_plane = dim == 2 && plane == PlaneMode::strain ? 1. : 0.;
    const double a = mean_stress_share();
    return 2 * shear_modulus() * a / (3 - a * (std::min(phi, double(dim)) + out_of_plane));
  }

  /// Bending stiffness k_b of a face in N m, theory.md eq. (D4).
  template <int dim>
  double bending_stiffness(double area, double distance, double thickness) const
  {
    if constexpr (dim == 2) {
      const double nu = poissons_ratio;
      const double modulus =
          plane == PlaneMode::strain ? youngs_modulus / (1 - nu * nu) : youngs_modulus;
      return modulus * area * area * area / (12 * thickness * thickness) / distance;
    } else
      return youngs_modulus * area * area / (4 * M_PI) / distance;
  }

  /// Twisting stiffness k_t of a face in N m (3D), theory.md eq. (D4).
  double twisting_stiffness(double area, double distance) const
  {
    return 2 * shear_modulus() * area * area / (4 * M_PI) / distance;
  }

  template <int dim>
  particles::ElasticConstants<dim> elastic_constants() const;

  /// Throws InputError when a constant lies outside its bounds.
  void check() const
  {
    core::require(youngs_modulus > 0, "Young's modulus must be positive");
    core::require(poissons_ratio > -1 && poissons_ratio < 0.5,
                  "Poisson's ratio must lie between -1 and 0.5");
    core::require(density > 0, "the density must be positive");
    core::require(friction >= 0, "the friction coefficient must not be negative");
  }
};

template <int dim>
particles::ElasticConstants<dim> DemMaterial::elastic_constants() const
{
  const double e = youngs_modulus, nu = poissons_ratio, g = shear_modulus();
  const bool plane_stress = dim == 2 && plane == PlaneMode::stress;
  const double lambda = plane_stress ? e * nu / (1 - nu * nu) : e * nu / ((1 + nu) * (1 - 2 * nu));
  Stiffness<dim> c = Stiffness<dim>::Zero();
  c.template topLeftCorner<dim, dim>().setConstant(lambda);
  for (int a = 0; a < n_strains<dim>; ++a)
    c(a, a) += a < dim ? 2 * g : g;
  return {e, nu, density, c, std::sqrt((lambda + 2 * g) / density), std::sqrt(g / density)};
}
} // namespace ligament::dem
