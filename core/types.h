// The vocabulary of all folders: vectors, component arrays, strains, boundary numbers.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace ligament
{
/// Rotational degrees of freedom: one angle in 2D, three in 3D.
template <int dim>
inline constexpr int n_spins = dim == 2 ? 1 : 3;

/// Degrees of freedom of one particle: displacements first, then rotations.
template <int dim>
inline constexpr int n_particle_dofs = dim + n_spins<dim>;

/// Components of a symmetric tensor in Voigt order: (xx, yy, xy) or (xx, yy, zz, yz, xz, xy).
/// Strains carry engineering shears (2 e_xy), so that e . s is work per volume.
template <int dim>
inline constexpr int n_strains = dim *(dim + 1) / 2;

/// Where the pair (i, j) stands in this order.
template <int dim>
constexpr int voigt_index(int i, int j)
{
  return i == j ? i : dim == 2 ? 2 : 6 - i - j;
}

template <int n>
using Vec = Eigen::Matrix<double, n, 1>;
template <int dim>
using Vector = Vec<dim>;
template <int dim>
using Spin = Vec<n_spins<dim>>;
template <int dim>
using Strain = Vec<n_strains<dim>>;
template <int dim>
using Stiffness = Eigen::Matrix<double, n_strains<dim>, n_strains<dim>>;

/// n numbers per particle or node, one array per component: what the kernels stream over.
template <int n>
using Components = std::array<std::vector<double>, n>;

template <std::size_t n>
Vec<int(n)> get(const std::array<std::vector<double>, n> &a, int i)
{
  Vec<int(n)> v;
  for (std::size_t c = 0; c < n; ++c)
    v[c] = a[c][i];
  return v;
}

template <std::size_t n>
void set(std::array<std::vector<double>, n> &a, int i, const Vec<int(n)> &v)
{
  for (std::size_t c = 0; c < n; ++c)
    a[c][i] = v[c];
}

template <std::size_t n>
void add(std::array<std::vector<double>, n> &a, int i, const Vec<int(n)> &v)
{
  for (std::size_t c = 0; c < n; ++c)
    a[c][i] += v[c];
}

/// Numbers of the sides of a box specimen: 2 * axis + (0 lower, 1 upper): left, right, bottom, top,
/// back, front. Surfaces of holes and notches carry inner_surface and are always free.
template <int dim>
inline constexpr int inner_surface = 2 * dim;

enum class PlaneMode
{
  strain,
  stress
};
} // namespace ligament
