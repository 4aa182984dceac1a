#include "packings/periodic_random.h"

#include "core/check.h"
#include "packings/clipped_cell.h"
#include "packings/power_diagram.h"
#include "packings/random_packing.h"
#include "packings/relaxation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ligament::packings
{
namespace
{
// Cells of drawn seeds have no neighbours farther away.
constexpr double margin = 4;
constexpr int n_sweeps = 10;

/// The bar with its nearest images beside it.
template <int dim>
SpecimenParameters<dim> surroundings(double width, double length)
{
  SpecimenParameters<dim> p;
  p.spacing = 1;
  p.lower = Vector<dim>::Constant(-margin);
  p.upper = Vector<dim>::Constant(width + margin);
  p.lower[dim - 1] = 0;
  p.upper[dim - 1] = length;
  return p;
}

/// Shift number k sideways, in widths: number 0 is none, and from the middle on they are the
/// opposites of those before.
template <int dim>
Vector<dim> shift(int k)
{
  if constexpr (dim == 2)
    return Vector<dim>(k == 0 ? 0 : k == 1 ? 1 : -1, 0);
  else {
    constexpr int steps[9][2] = {{0, 0},  {1, 0},   {0, 1},  {1, 1}, {1, -1},
                                 {-1, 0}, {-1, -1}, {-1, 1}, {0, -1}};
    return Vector<dim>(steps[k][0], steps[k][1], 0);
  }
}
template <int dim>
inline constexpr int n_shifts = dim == 2 ? 3 : 9;

/// The seeds, then their images within the margin; id: number of the shift times the number of
/// seeds, plus the seed's index.
template <int dim>
Seeds<dim> with_images(const Seeds<dim> &seeds, double width)
{
  Seeds<dim> all;
  for (int k = 0; k < n_shifts<dim>; ++k)
    for (int i = 0; i < seeds.size(); ++i) {
      const Vector<dim> x = seeds.centre[i] + width * shift<dim>(k);
      if ((x.template head<dim - 1>().array() > -margin).all() &&
          (x.template head<dim - 1>().array() < width + margin).all())
        all.add(x, seeds.radius[i], std::int64_t(k) * seeds.size() + i);
    }
  return all;
}

/// One sweep; seeds below `from` stay.
template <int dim>
void move_to_centroids(Seeds<dim> &seeds, double width, double length, double from)
{
  const SpecimenShape<dim> shape(surroundings<dim>(width, length));
  const Seeds<dim> all = with_images(seeds, width);
  const PowerDiagram<dim> diagram(all, 1);
  for (int i = 0; i < seeds.size(); ++i) {
    Vector<dim> &x = seeds.centre[i];
    if (x[dim - 1] < from)
      continue;
    VoronoiCell<dim> cell(start_half_width, start_plane, 1e-13);
    clip_by_sides(cell, shape, x);
    diagram.cut(cell, i);
    x += cell.moment() / cell.volume();
    for (int c = 0; c < dim - 1; ++c)
      x[c] -= width * std::floor(x[c] / width);
  }
}

/// Ids count along the bar.
template <int dim>
Seeds<dim> in_order(const Seeds<dim> &seeds)
{
  std::vector<int> order(seeds.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return seeds.centre[a][dim - 1] < seeds.centre[b][dim - 1]; });
  Seeds<dim> sorted;
  for (const int i : order)
    sorted.add(seeds.centre[i], seeds.radius[i], sorted.size());
  return sorted;
}
} // namespace

template <int dim>
Seeds<dim> make_periodic_seeds(double width, double length, int seed)
{
  core::require(width >= margin, "a periodic bar is at least four spacings wide");
  SpecimenParameters<dim> bar;
  bar.spacing = 1;
  bar.upper = Vector<dim>::Constant(width);
  bar.upper[dim - 1] = length;
  auto seeds = draw_seeds<dim>(SpecimenShape<dim>(bar), 1, seed, 1, bar.lower, bar.upper);
  for (int k = 0; k < n_sweeps; ++k)
    move_to_centroids(seeds, width, length, 0);
  return in_order(seeds);
}

template <int dim>
Seeds<dim> make_other_end(const Seeds<dim> &seeds, double width, double length, double from,
                          int seed)
{
  Seeds<dim> joined;
  const Seeds<dim> other = make_periodic_seeds<dim>(width, length, seed);
  for (const auto *half : {&seeds, &other})
    for (int i = 0; i < half->size(); ++i)
      if ((half->centre[i][dim - 1] < from) == (half == &seeds))
        joined.add(half->centre[i], half->radius[i], joined.size());
  for (int k = 0; k < n_sweeps; ++k)
    move_to_centroids(joined, width, length, from);
  return in_order(joined);
}

template <int dim>
Packing<dim> pack_periodic(const Seeds<dim> &seeds, double width, double length, double zone_end)
{
  auto parameters = surroundings<dim>(width, length);
  parameters.zone_upper[dim - 1] = zone_end;
  auto packing = pack_seeds<dim>(parameters, with_images(seeds, width)).packing;

  // Particles are in the order of their ids: images come last.
  const int n_seeds = seeds.size();
  int n = 0;
  std::vector<int> particle_of(n_seeds, -1);
  for (; n < packing.size() && packing.global_id[n] < n_seeds; ++n)
    particle_of[packing.global_id[n]] = n;
  std::vector<Face<dim>> faces;
  for (auto face : packing.faces) {
    const int other_side = int(packing.global_id[face.j] / n_seeds);
    if (face.i >= n || other_side > n_shifts<dim> / 2)
      continue; // seen from its other side, too
    face.j = particle_of[packing.global_id[face.j] % n_seeds];
    core::require(face.j >= 0, "the cells of a particle and of its image differ");
    faces.push_back(face);
  }
  packing.faces = std::move(faces);
  auto &outer = packing.boundary_faces;
  outer.erase(std::remove_if(outer.begin(), outer.end(), [&](const auto &f) { return f.i >= n; }),
              outer.end());
  packing.volume.resize(n);
  packing.diameter.resize(n);
  packing.global_id.resize(n);
  for (auto &x : packing.centre)
    x.resize(n);
  return packing;
}

template Seeds<2> make_periodic_seeds(double, double, int);
template Seeds<3> make_periodic_seeds(double, double, int);
template Seeds<2> make_other_end(const Seeds<2> &, double, double, double, int);
template Seeds<3> make_other_end(const Seeds<3> &, double, double, double, int);
template Packing<2> pack_periodic(const Seeds<2> &, double, double, double);
template Packing<3> pack_periodic(const Seeds<3> &, double, double, double);
} // namespace ligament::packings
