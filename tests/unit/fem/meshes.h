// Small graded meshes and elastic constants that the far field's tests share.
#pragma once

#include "fem/mesh.h"

#include <random>

namespace ligament::fem
{
/// Isotropic stiffness, plane strain in 2D; lambda and G in Pa.
template <int dim>
Stiffness<dim> isotropic(double lambda, double g)
{
  Stiffness<dim> c = Stiffness<dim>::Zero();
  c.template topLeftCorner<dim, dim>().setConstant(lambda);
  for (int i = 0; i < n_strains<dim>; ++i)
    c(i, i) += i < dim ? 2 * g : g;
  return c;
}

/// A specimen around the origin with sections of whole base cells of size 4 h, h = 0.1 m: the inner
/// box lies inside (ring) or reaches through it in every direction but the last (band).
template <int dim>
MeshParameters<dim> ring()
{
  MeshParameters<dim> p;
  p.cell_size = 0.1;
  p.inner.resize(1);
  for (int k = 0; k < dim; ++k) {
    p.inner[0].lower[k] = -0.4;
    p.inner[0].upper[k] = k == 0 ? 0.8 : 0.4;
    p.lower[k] = p.inner[0].lower[k] - (dim == 2 ? 2.4 : 1.2);
    p.upper[k] = p.inner[0].upper[k] + (dim == 2 ? 2 : 1.2) + 0.4 * k;
  }
  p.levels = 2;
  p.fine_cells = dim == 2 ? 5 : 3;
  p.cells_per_level = dim == 2 ? 2 : 1;
  return p;
}

template <int dim>
MeshParameters<dim> band()
{
  MeshParameters<dim> p = ring<dim>();
  for (int k = 0; k + 1 < dim; ++k) {
    p.inner[0].lower[k] = p.lower[k] - 1;
    p.inner[0].upper[k] = p.upper[k] + 1;
  }
  return p;
}

/// The same with sections that no cell size divides.
template <int dim>
MeshParameters<dim> incommensurate(MeshParameters<dim> p)
{
  for (int k = 0; k < dim; ++k) {
    p.lower[k] -= 0.0713 * (k + 1);
    p.upper[k] += 0.0291 * (k + 1);
    p.inner[0].lower[k] += 0.0173;
    p.inner[0].upper[k] -= 0.0137;
  }
  return p;
}

template <int dim>
MeshParameters<dim> box(const Vector<dim> &size, double cell_size)
{
  MeshParameters<dim> p;
  p.lower.setZero();
  p.upper = size;
  p.inner.push_back({Vector<dim>::Zero(), Vector<dim>::Zero()});
  p.cell_size = cell_size;
  return p;
}
} // namespace ligament::fem
