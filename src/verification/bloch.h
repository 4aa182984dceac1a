// Plane waves of a packing: frequency, and displacement with the rotation that belongs to it.
#pragma once

#include "particles/particle_force.h"

#include <complex>

namespace ligament::program
{
/// u_i = Re amplitude exp(i (k x_i - omega t)), the rotation after the displacement. Without time
/// step: of the leap-frog it is sin(omega_leap dt/2) = omega dt/2.
template <int dim>
struct BlochMode
{
  double frequency;                                                       // omega, rad/s
  Eigen::Matrix<std::complex<double>, n_particle_dofs<dim>, 1> amplitude; // |displacement| = 1
};

/// Modes of the infinite packing around particle `centre`, which has all its neighbours, and whose
/// neighbours have all theirs. All particles are alike.
template <int dim>
class BlochWaves
{
public:
  /// Waves along `axis`. The body may be periodic in the other directions only.
  BlochWaves(const particles::Particles<dim> &particles, const particles::ParticleForce<dim> &force,
             int centre, int axis);

  /// The slowest branch that moves along `polarisation` (a unit vector); of degenerate ones the
  /// combination that does. wave_number in rad/m.
  BlochMode<dim> mode(double wave_number, const Vector<dim> &polarisation) const;

  /// d(omega)/dk in m/s.
  double group_velocity(double wave_number, const Vector<dim> &polarisation) const;

private:
  static constexpr int dofs = n_particle_dofs<dim>;
  using Matrix = Eigen::Matrix<std::complex<double>, dofs, dofs>;

  struct Term
  {
    double share;              // of its energy that belongs to the centre
    std::vector<double> place; // m, of the members along the axis
    Eigen::MatrixXd rows;
    Eigen::VectorXd stiffness;
  };

  std::vector<Term> terms_;
  Eigen::Matrix<double, dofs, 1> inverse_root_mass_; // 1/sqrt(kg), 1/sqrt(kg m^2)
};
} // namespace ligament::program
