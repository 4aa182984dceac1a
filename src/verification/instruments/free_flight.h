// What a body that nothing acts on must keep: its energy and its moment of momentum.
#pragma once

#include "src/simulation/coupled_body.h"

namespace ligament::program
{
/// Moment of momentum of theory.md (C1), (C6) about the origin, in kg m^2/s; positions and
/// velocities as they are. Either half may be missing.
template <int dim>
Spin<dim> angular_momentum(const CoupledBody<dim> &body);

/// |last/first - 1|, of the mean energies of the first and the last tenth of the run.
template <int dim>
double energy_change(CoupledBody<dim> &body, long n_steps);
} // namespace ligament::program
