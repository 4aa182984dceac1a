// The gap-band filter: takes from the coarse velocities what is too short for the mesh to pass on.
#pragma once

#include "coupling/overlap.h"

#include <Eigen/SparseCore>

namespace ligament::coupling
{
/// D = (1/dim) (1 - exp(-dim c_g (c_P/h) dt)) sum_k L_k^T diag(m^) L_k with L_k the third power of
/// [-1 2 -1]/4 along mesh direction k (theory.md eq. (C12)), in kg; V -= M_c^-1 D V each step.
/// strength: c_g; wave_speed: c_P in m/s; step: dt in s; mass_bound: m~ per near node in kg.
template <int dim>
Eigen::SparseMatrix<double> make_gap_filter(const Overlap<dim> &overlap, double strength,
                                            double wave_speed, double step,
                                            const Eigen::VectorXd &mass_bound);
} // namespace ligament::coupling
