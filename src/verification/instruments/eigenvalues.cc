#include "src/verification/instruments/eigenvalues.h"

#include <deal.II/lac/lapack_full_matrix.h>

namespace ligament::program
{
std::vector<std::complex<double>> eigenvalues(const Eigen::MatrixXd &matrix)
{
  const int n = int(matrix.rows());
  dealii::LAPACKFullMatrix<double> copy(n);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      copy(i, j) = matrix(i, j);
  copy.compute_eigenvalues();
  std::vector<std::complex<double>> values(n);
  for (int i = 0; i < n; ++i)
    values[i] = copy.eigenvalue(i);
  return values;
}
} // namespace ligament::program
