// Eigenvalues of matrices without symmetry.
#pragma once

#include <Eigen/Core>

#include <complex>
#include <vector>

namespace ligament::program
{
/// All eigenvalues of a square matrix, by LAPACK.
std::vector<std::complex<double>> eigenvalues(const Eigen::MatrixXd &matrix);
} // namespace ligament::program
