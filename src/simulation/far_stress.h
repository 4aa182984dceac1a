// Stress of the far field's material, from the gradient of its displacement.
#pragma once

#include "core/polar_rotation.h"
#include "fem/fem_solver.h"
#include "src/simulation/gauges/small_strain.h"

namespace ligament::program
{
/// In Pa, Voigt order, space axes. Where cells turn with their material (theory.md eq. (F6)) it is
/// that of the strain in their own axes, turned with them: as particles tell theirs.
template <int dim>
Strain<dim> far_stress(const fem::FemSolver<dim> &far,
                       const Eigen::Matrix<double, dim, dim> &gradient)
{
  using Matrix = Eigen::Matrix<double, dim, dim>;
  const auto &stiffness = far.body().stiffness;
  if (!far.is_corotated())
    return stiffness * small_strain<dim>(gradient);
  const Matrix f = Matrix::Identity() + gradient, r = core::PolarRotation<dim>(f).matrix();
  const Strain<dim> s = stiffness * small_strain<dim>(r.transpose() * f - Matrix::Identity());
  Matrix own;
  if constexpr (dim == 2)
    own << s[0], s[2], s[2], s[1];
  else
    own << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
  const Matrix t = r * own * r.transpose();
  Strain<dim> stress;
  if constexpr (dim == 2)
    stress << t(0, 0), t(1, 1), t(0, 1);
  else
    stress << t(0, 0), t(1, 1), t(2, 2), t(1, 2), t(0, 2), t(0, 1);
  return stress;
}
} // namespace ligament::program
