#include "md/crystal_packing.h"

#include "core/check.h"
#include "packings/lattice.h"

#include <Eigen/Dense>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::md
{
namespace
{
template <int dim>
using Index = packings::LatticeIndex<dim>;

/// The bits of up to two indices of a row in turn (Morton's curve).
template <int dim>
std::uint64_t row_code(const Index<dim> &k)
{
  std::uint64_t code = 0;
  for (int c = 1; c < dim; ++c) {
    const std::uint64_t bits = std::uint64_t(std::int64_t(k[c]) + (1 << 30));
    for (int b = 0; b < 32; ++b)
      code |= ((bits >> b) & 1) << (b * (dim - 1) + c - 1);
  }
  return code;
}

template <int dim>
struct Site
{
  std::uint64_t row;
  Index<dim> k;
};

/// Indices between which all lattice points of the box lie.
template <int dim>
std::pair<Index<dim>, Index<dim>> index_range(const Matrix<dim> &inverse,
                                              const CrystalShape<dim> &shape)
{
  Vector<dim> least = Vector<dim>::Constant(1e300), most = -least;
  for (int corner = 0; corner < 1 << dim; ++corner) {
    Vector<dim> x;
    for (int c = 0; c < dim; ++c)
      x[c] = (corner >> c & 1 ? shape.upper : shape.lower)[c] - shape.anchor[c];
    least = least.cwiseMin(inverse * x);
    most = most.cwiseMax(inverse * x);
  }
  core::require(std::max(-least.minCoeff(), most.maxCoeff()) < 1e9,
                "a crystal of so many atoms cannot be numbered: make it smaller");
  Index<dim> from, to;
  for (int c = 0; c < dim; ++c) {
    from[c] = int(std::floor(least[c])) - 1;
    to[c] = int(std::ceil(most[c])) + 1;
  }
  return {from, to};
}

/// Of the indices from `least` to `most`, those between which the line of sites from x along `step`
/// lies in the box, and one more at each end.
template <int dim>
std::pair<int, int> clip(int least, int most, const Vector<dim> &x, const Vector<dim> &step,
                         const CrystalShape<dim> &shape)
{
  double from = least, to = most;
  const double length = step.norm();
  for (int c = 0; c < dim; ++c) {
    // Along an axis that the line hardly moves on it is not clipped.
    if (std::abs(step[c]) < 1e-5 * length)
      continue;
    const double a = (shape.lower[c] - x[c]) / step[c], b = (shape.upper[c] - x[c]) / step[c];
    from = std::max(from, std::min(a, b) - 1);
    to = std::min(to, std::max(a, b) + 1);
  }
  from = std::floor(std::min(from, most + 1.));
  return {int(from), from <= to ? int(std::ceil(to)) : int(from) - 1};
}

template <int dim>
double side_area(const CrystalShape<dim> &shape, int axis, double thickness)
{
  double area = dim == 2 ? thickness : 1;
  for (int c = 0; c < dim; ++c)
    if (c != axis)
      area *= shape.upper[c] - shape.lower[c];
  return area;
}

/// How far x lies inside side number `side` of the box (core/types.h).
template <int dim>
double depth_below(const CrystalShape<dim> &shape, int side, const Vector<dim> &x)
{
  const int axis = side / 2;
  return side % 2 ? shape.upper[axis] - x[axis] : x[axis] - shape.lower[axis];
}

/// Of a side: how many sites of the lattice lie in the layer that loads act on, kept or not.
template <int dim>
using SiteCounts = std::array<long, 2 * dim>;

template <int dim>
void add_outer_faces(const CrystalShape<dim> &shape, double depth, const SiteCounts<dim> &n_sites,
                     packings::Packing<dim> &packing)
{
  for (int side = 0; side < 2 * dim; ++side) {
    const int axis = side / 2;
    const bool is_outer = side % 2 ? shape.upper[axis] >= shape.specimen_upper[axis]
                                   : shape.lower[axis] <= shape.specimen_lower[axis];
    if (!is_outer || shape.periodic[axis])
      continue;
    const Vector<dim> normal = (side % 2 ? 1 : -1) * Vector<dim>::Unit(axis);
    const double area = side_area<dim>(shape, axis, packing.thickness) / double(n_sites[side]);
    for (int i = 0; i < packing.size(); ++i)
      if (const double q = depth_below<dim>(shape, side, get(packing.centre, i)); q < depth)
        packing.boundary_faces.push_back(
            {i, normal, area, std::max(q, 0.), Vector<dim>(q * normal), side});
  }
}

template <int dim>
void check_periods(const Matrix<dim> &inverse, const CrystalShape<dim> &shape)
{
  for (int c = 0; c < dim; ++c) {
    if (!shape.periodic[c])
      continue;
    const Vector<dim> k = inverse.col(c) * (shape.upper[c] - shape.lower[c]);
    for (int a = 0; a < dim; ++a)
      core::require(std::abs(k[a] - std::round(k[a])) < 1e-6,
                    fmt::format("the crystal does not repeat itself after {} m along {}: make the "
                                "box a whole number of periods long",
                                shape.upper[c] - shape.lower[c], "xyz"[c]));
  }
}
} // namespace

template <int dim>
packings::Packing<dim> cut_crystal(const Crystal<dim> &crystal, const CrystalShape<dim> &shape)
{
  const Matrix<dim> basis = crystal.basis(), inverse = basis.inverse();
  check_periods<dim>(inverse, shape);
  const double sliver = 1e-6 * crystal.spacing();
  const auto position = [&](const Index<dim> &k) {
    Vector<dim> x = shape.anchor;
    for (int c = 0; c < dim; ++c)
      x += basis.col(c) * k[c];
    return x;
  };
  const double loaded_depth = crystal.potential().cutoff();
  SiteCounts<dim> n_sites = {};
  const auto is_in = [&](const Vector<dim> &x) {
    for (int c = 0; c < dim; ++c)
      if (!(x[c] >= shape.lower[c] - sliver && x[c] < shape.upper[c] - sliver))
        return false;
    for (int side = 0; side < 2 * dim; ++side)
      n_sites[side] += depth_below<dim>(shape, side, x) < loaded_depth;
    return !shape.keep || shape.keep(x);
  };
  const auto [from, to] = index_range<dim>(inverse, shape);
  std::vector<Site<dim>> sites;
  Index<dim> k = from;
  while (k[dim - 1] <= to[dim - 1]) {
    k[0] = 0;
    const auto [first, last] = clip<dim>(from[0], to[0], position(k), basis.col(0), shape);
    for (k[0] = first; k[0] <= last; ++k[0])
      if (is_in(position(k)))
        sites.push_back({row_code<dim>(k), k});
    k[0] = to[0] + 1; // the next line
    for (int c = 0; c + 1 < dim && k[c] > to[c]; ++c) {
      k[c] = from[c];
      ++k[c + 1];
    }
  }
  core::require(!sites.empty(), "the crystal has no atom: its box is smaller than the spacing of "
                                "atoms, or nothing of it is kept");
  std::sort(sites.begin(), sites.end(), [](const auto &a, const auto &b) {
    return a.row != b.row ? a.row < b.row : a.k[0] < b.k[0];
  });

  packings::Packing<dim> packing;
  packing.spacing = crystal.spacing();
  packing.thickness = dim == 2 ? crystal.parameters().thickness : 1;
  for (int c = 0; c < dim; ++c)
    packing.period[c] = shape.periodic[c] ? shape.upper[c] - shape.lower[c] : 0;
  const int n = int(sites.size());
  for (auto &component : packing.centre)
    component.resize(n);
  packing.volume.assign(n, crystal.volume());
  for (int i = 0; i < n; ++i) {
    const Index<dim> &site = sites[i].k;
    set(packing.centre, i, position(site));
    packing.global_id.push_back(packings::Lattice<dim>::global_id(site));
    if (i == 0 || sites[i].row != sites[i - 1].row || site[0] != sites[i - 1].k[0] + 1)
      packing.row_begin.push_back(i);
  }
  packing.row_begin.push_back(n);
  add_outer_faces<dim>(shape, loaded_depth, n_sites, packing);
  return packing;
}

template <int dim>
particles::Particles<dim> make_atoms(const Crystal<dim> &crystal,
                                     const packings::Packing<dim> &packing,
                                     const std::vector<int> &species)
{
  particles::Particles<dim> atoms;
  packings::fill_particles(packing, crystal.mass_density(), atoms);
  atoms.drop_orientations();
  for (int i = 0; i < atoms.size(); ++i)
    atoms.mass[i] = crystal.potential()
                        .species(species.empty() ? crystal.parameters().species : species[i])
                        .mass;
  return atoms;
}

#define INSTANTIATE(dim)                                                                           \
  template packings::Packing<dim> cut_crystal(const Crystal<dim> &, const CrystalShape<dim> &);    \
  template particles::Particles<dim> make_atoms(                                                   \
      const Crystal<dim> &, const packings::Packing<dim> &, const std::vector<int> &);
INSTANTIATE(2)
INSTANTIATE(3)
#undef INSTANTIATE
} // namespace ligament::md
