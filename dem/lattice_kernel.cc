#include "dem/lattice_kernel.h"

#include <limits>

namespace ligament::dem
{
template <int dim>
LatticeKernel<dim>::LatticeKernel(const std::vector<DirectionData<dim>> &directions,
                                  double shear_modulus)
    : n_directions_(int(directions.size()))
{
  core::require(n_directions_ == 0 || n_directions_ == dim || n_directions_ == 3 * (dim - 1),
                "no kernel for a lattice with this number of directions");
  for (int k = 0; k < n_directions_; ++k) {
    const auto &d = directions[k];
    auto &c = constants_[k];
    for (int a = 0; a < dim; ++a)
      c.normal[a] = d.normal[a];
    c.half = d.distance / 2;
    c.area_r = d.area / d.distance;
    c.shear = 2 * shear_modulus * c.area_r;
    c.bending = d.bending;
    c.twist = d.twist - d.bending;
    area_[k] = d.area;
  }
}

template <int dim>
void LatticeKernel<dim>::dilatation(const LatticeArrays<dim> &arrays,
                                    const std::vector<RowSegment> &segments) const
{
  sweep_dilatation_of({arrays, &constants_, &segments, nullptr});
}

template <int dim>
void LatticeKernel<dim>::forces(const LatticeArrays<dim> &arrays,
                                const std::vector<RowSegment> &segments, double strength,
                                std::vector<RowRange> &exceeded) const
{
  auto constants = constants_;
  for (int k = 0; k < n_directions_; ++k)
    constants[k].limit2 = strength > 0 ? strength * area_[k] * strength * area_[k]
                                       : std::numeric_limits<double>::infinity();
  sweep_forces_of({arrays, &constants, &segments, &exceeded});
}

template class LatticeKernel<2>;
template class LatticeKernel<3>;
} // namespace ligament::dem
