// Displacements and velocities of a whole body as vectors, to be set and read.
#pragma once

#include "src/simulation/coupled_body.h"

namespace ligament::program
{
/// Values per vector: displacements of all particles, component by component, their rotation
/// vectors, then displacements of all nodes; velocities likewise. m and rad, m/s and rad/s.
template <int dim>
int state_size(const CoupledBody<dim> &body);

/// Rotations must be so small that their squares are round-off.
template <int dim>
void set_displacement(CoupledBody<dim> &body, const Eigen::VectorXd &u);
template <int dim>
Eigen::VectorXd displacement(const CoupledBody<dim> &body);

/// Hanging nodes are made to follow; the coupler hears of it by take_velocities().
template <int dim>
void set_velocity(CoupledBody<dim> &body, const Eigen::VectorXd &v);
template <int dim>
Eigen::VectorXd velocity(const CoupledBody<dim> &body);

/// The motion that the program makes of v: one whose velocities the coupler carries.
template <int dim>
Eigen::VectorXd admissible(CoupledBody<dim> &body, const Eigen::VectorXd &v);
} // namespace ligament::program
