#include "fem/body.h"

#include <Eigen/Eigenvalues>

namespace ligament::fem
{
template <int dim>
Vector<dim> normal_wave_speeds(const Body<dim> &body, int axis)
{
  using Matrix = Eigen::Matrix<double, dim, dim>;
  Matrix acoustic;
  for (int i = 0; i < dim; ++i)
    for (int k = 0; k < dim; ++k)
      acoustic(i, k) = body.stiffness(voigt_index<dim>(i, axis), voigt_index<dim>(k, axis));
  acoustic.diagonal().array() += body.stress[axis];
  acoustic /= body.density;
  if (acoustic.isDiagonal(0))
    return acoustic.diagonal().cwiseSqrt();
  return Eigen::SelfAdjointEigenSolver<Matrix>(acoustic).operatorSqrt().diagonal();
}

template Vector<2> normal_wave_speeds(const Body<2> &, int);
template Vector<3> normal_wave_speeds(const Body<3> &, int);
} // namespace ligament::fem
