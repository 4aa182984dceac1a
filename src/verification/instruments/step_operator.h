// The linear map that the program's own steps make of a body's state, and how much it may grow.
#pragma once

#include "src/simulation/coupled_body.h"

namespace ligament::program
{
/// The map of (displacements, velocities) over one action of the far field: m steps of the program,
/// dampers, impulses and corrections as they are. Column k is what becomes of the k-th unit state,
/// made admissible first and so small that the law is linear to round-off. The body is at rest
/// afterwards. A body that can move rigidly has defective eigenvalues 1, which round-off splits by
/// about 1e-8: hold it.
template <int dim>
Eigen::MatrixXd step_operator(CoupledBody<dim> &body);

/// Largest modulus of an eigenvalue of step_operator(body), less one, per step.
template <int dim>
double largest_growth(CoupledBody<dim> &body);
} // namespace ligament::program
