// Plane waves of a packing: frequency, and displacement with the rotation that belongs to it.
#pragma once

#include "particles/particle_force.h"
#include "src/verification/instruments/wave_modes.h"

namespace ligament::program
{
/// u_i = Re amplitude exp(i (k x_i - omega t)), the rotation after the displacement. Without time
/// step: of the leap-frog it is sin(omega_leap dt/2) = omega dt/2.
template <int dim>
struct BlochMode
{
  double frequency;           // omega, rad/s
  Eigen::VectorXcd amplitude; // |displacement| = 1
};

/// Modes of the infinite packing around particle `centre`, which has all its neighbours, and whose
/// neighbours have all theirs. All particles are alike.
template <int dim>
class BlochWaves
{
public:
  /// The short forms below are for waves along `axis`. Across it the body may repeat itself after
  /// `period` m; 0: it does not.
  BlochWaves(const particles::Particles<dim> &particles, const particles::ParticleForce<dim> &force,
             int centre, int axis, double period = 0);

  /// All modes of a wave vector in rad/m; of displacements alone where the force has no rotations.
  WaveModes modes(const Vector<dim> &wave_vector) const;

  /// The slowest branch that moves along `polarisation` (a unit vector); of degenerate ones the
  /// combination that does. wave_number in rad/m.
  BlochMode<dim> mode(double wave_number, const Vector<dim> &polarisation) const;

  /// d(omega)/dk in m/s.
  double group_velocity(double wave_number, const Vector<dim> &polarisation) const;

private:
  struct Term
  {
    double share;                   // of its energy that belongs to the centre
    std::vector<Vector<dim>> place; // m, of the members against the first
    Eigen::MatrixXd rows;
    Eigen::VectorXd stiffness;
  };

  std::vector<Term> terms_;
  Eigen::VectorXd mass_; // kg, kg m^2
  int axis_;
};
} // namespace ligament::program
