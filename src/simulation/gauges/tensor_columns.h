// Symmetric tensors as gauges write them: xx, yy, xy or xx, yy, zz, yz, xz, xy, in axes of their
// own.
#pragma once

#include "core/types.h"
#include "src/output/table.h"

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace ligament::program
{
template <int dim>
std::vector<Column> tensor_columns(const std::string &name, const char *unit)
{
  std::vector<Column> columns;
  const std::vector<const char *> components =
      dim == 2 ? std::vector<const char *>{"xx", "yy", "xy"}
               : std::vector<const char *>{"xx", "yy", "zz", "yz", "xz", "xy"};
  for (const char *c : components)
    columns.push_back({name + "_" + c, unit});
  return columns;
}

/// In axes that are turned by the angle in rad about z.
template <int dim>
void put_turned(const Eigen::Matrix<double, dim, dim> &t, double angle, double *values)
{
  using Tensor = Eigen::Matrix<double, dim, dim>;
  Tensor axes = Tensor::Identity(); // columns
  axes.template topLeftCorner<2, 2>() = Eigen::Rotation2Dd(angle).toRotationMatrix();
  const Tensor turned = axes.transpose() * t * axes;
  for (int c = 0; c < dim; ++c)
    values[c] = turned(c, c);
  if constexpr (dim == 2)
    values[2] = turned(0, 1);
  else {
    values[3] = turned(1, 2);
    values[4] = turned(0, 2);
    values[5] = turned(0, 1);
  }
}

/// From Voigt's order, of stresses.
template <int dim>
Eigen::Matrix<double, dim, dim> tensor_of(const Strain<dim> &s)
{
  Eigen::Matrix<double, dim, dim> t;
  if constexpr (dim == 2)
    t << s[0], s[2], s[2], s[1];
  else
    t << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
  return t;
}
} // namespace ligament::program
