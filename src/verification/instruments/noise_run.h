// A body that moves as noise, and what its energy does meanwhile.
#pragma once

#include "src/simulation/coupled_body.h"

#include <vector>

namespace ligament::program
{
/// Random velocities of all particles and nodes, uniform in (-amplitude, amplitude) m/s. In a unit
/// body, whose waves travel at about 1, strains are of that size.
template <int dim>
void start_noise(CoupledBody<dim> &body, double amplitude);

/// The energies of a run, one sample every `interval` steps; in J.
struct EnergySeries
{
  int interval;
  std::vector<double> leap_frog; // theory.md eqs. (E1), (E2), (E5)
  std::vector<double> shadow;    // theory.md eq. (E7), where it is asked for
};

/// Steps the body from noise. `shadow_terms` is K in (E7): 0 for no shadow energy; it needs the
/// step ratio 1. Throws core::InputError as soon as an energy is not a number.
template <int dim>
EnergySeries run_noise(CoupledBody<dim> &body, double amplitude, long n_steps, int interval,
                       int shadow_terms);

/// What happened to an energy, over its mean.
struct Course
{
  double drift;       // least-squares slope of 50 block means, per 1e5 steps
  double error;       // standard error of that slope from the scatter of the block means
  double fluctuation; // largest distance of a sample from the mean
};

Course course_of(const std::vector<double> &series, int interval);

/// c_0 .. c_{terms-1} of (E7) for modes up to `fraction` of the critical step.
std::vector<double> shadow_coefficients(double fraction, int terms);
} // namespace ligament::program
