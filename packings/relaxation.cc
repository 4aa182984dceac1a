#include "packings/relaxation.h"

#include "packings/clipped_cell.h"
#include "packings/power_diagram.h"
#include "packings/rank_share.h"

#include <algorithm>
#include <cmath>

namespace ligament::packings
{
namespace
{
template <int dim>
bool is_in(const Vector<dim> &x, const Vector<dim> &lower, const Vector<dim> &upper, double margin)
{
  return ((x - lower).array() >= -margin).all() && ((upper - x).array() >= -margin).all();
}

double share_of_size(double size_ratio, int k, int sweeps)
{
  return size_ratio > 1 ? std::min(1., 1.5 * (k + 1) / sweeps) : 1.;
}

/// Radii of sweep k: they grow from equal ones, so that no cell is lost before its neighbours have
/// made room for it. Weights enter by their differences alone.
template <int dim>
Seeds<dim> grown(const Seeds<dim> &seeds, double share, double bin, const core::Ranks &ranks = {})
{
  Seeds<dim> result = seeds;
  for (double &r : result.radius)
    r *= share;
  heal_radii(result, bin, ranks);
  return result;
}

/// Centroid of the cell of a seed; its own place where that is no better.
template <int dim>
Vector<dim> centroid_of_cell(const PowerDiagram<dim> &diagram, int i, const Vector<dim> &x,
                             const SpecimenShape<dim> &shape, double spacing)
{
  VoronoiCell<dim> cell(start_half_width * spacing, start_plane, 1e-13 * spacing);
  clip_by_sides(cell, shape, x);
  diagram.cut(cell, i);
  const auto [volume, moment] = clipped_volume(cell, shape, x, spacing);
  const Vector<dim> to = x + moment / volume;
  return volume > 0 && shape.distance(to) > 0 ? to : x;
}

/// `present` are the seeds with other radii, and after them their images. Each rank moves some and
/// tells the others where to.
template <int dim>
void move_to_centroids(Seeds<dim> &seeds, const Seeds<dim> &present,
                       const SpecimenShape<dim> &shape, double spacing, double bin,
                       const Vector<dim> &lower, const Vector<dim> &upper, double margin,
                       const core::Ranks &ranks = {})
{
  const PowerDiagram<dim> diagram(present, bin);
  std::vector<int> moved;
  for (int i = 0; i < seeds.size(); ++i)
    if (is_in(present.centre[i], lower, upper, margin))
      moved.push_back(i);
  const auto [first, last] = share_of(moved.size(), ranks);
  std::vector<double> to;
  to.reserve(dim * (last - first));
  for (std::size_t k = first; k < last; ++k) {
    const int i = moved[k];
    const Vector<dim> x = centroid_of_cell<dim>(diagram, i, present.centre[i], shape, spacing);
    to.insert(to.end(), x.data(), x.data() + dim);
  }
  to = ranks.gather_all(to);
  for (std::size_t k = 0; k < moved.size(); ++k)
    seeds.centre[moved[k]] = Eigen::Map<const Vector<dim>>(&to[dim * k]);
}

/// Unit vector along which the distance to the surface grows.
template <int dim>
Vector<dim> inward(const SpecimenShape<dim> &shape, const Vector<dim> &x, double step)
{
  Vector<dim> gradient;
  for (int a = 0; a < dim; ++a)
    gradient[a] = shape.distance(x + step * Vector<dim>::Unit(a)) -
                  shape.distance(x - step * Vector<dim>::Unit(a));
  return gradient.norm() > 0 ? gradient.normalized() : gradient;
}

template <int dim>
void keep_off_surfaces(Seeds<dim> &seeds, const SpecimenShape<dim> &shape, double spacing)
{
  Seeds<dim> kept;
  for (int i = 0; i < seeds.size(); ++i) {
    Vector<dim> &x = seeds.centre[i];
    const double size = std::min(spacing, 2 * seeds.radius[i]);
    for (int step = 0; step < 4; ++step)
      if (const double missing = 0.3 * size - shape.distance(x); missing > 0)
        x += (missing + 1e-6 * size) * inward(shape, x, 1e-3 * size);
    if (shape.distance(x) >= 0.25 * size)
      kept.add(x, seeds.radius[i], seeds.id[i]);
  }
  seeds = std::move(kept);
}
} // namespace

template <int dim>
Seeds<dim> relaxed_seeds(const SpecimenShape<dim> &shape, double spacing, int seed,
                         double size_ratio, int sweeps, const Vector<dim> &lower,
                         const Vector<dim> &upper, const core::Ranks &ranks)
{
  // A seed feels its neighbours' neighbours at most, in each sweep.
  const double reach = 3 * spacing * std::sqrt(size_ratio);
  const Vector<dim> all = Vector<dim>::Constant((sweeps + 2) * reach);
  Seeds<dim> seeds = draw_seeds<dim>(shape, spacing, seed, size_ratio, lower - all, upper + all);
  const double bin = mean_distance<dim>(spacing);
  for (int k = 0; k < sweeps; ++k) {
    const double share = share_of_size(size_ratio, k, sweeps);
    move_to_centroids(seeds, grown(seeds, share, bin, ranks), shape, spacing, bin, lower, upper,
                      (sweeps + 1 - k) * reach, ranks);
  }
  keep_off_surfaces(seeds, shape, spacing);
  return seeds;
}

template <int dim>
Seeds<dim> relaxed_periodic_seeds(const SpecimenParameters<dim> &p, const PeriodicBox<dim> &box,
                                  int seed, double size_ratio, int sweeps)
{
  const double size = p.spacing * std::sqrt(size_ratio), reach = 3 * size;
  const auto widened_by = [&](double margin) {
    Vector<dim> lower = p.zone_lower - Vector<dim>::Constant(margin),
                upper = p.zone_upper + Vector<dim>::Constant(margin);
    for (int a = 0; a < dim; ++a)
      if (box.period[a] > 0) {
        lower[a] = box.lower[a];
        upper[a] = lower[a] + box.period[a];
      }
    return std::pair(lower, upper);
  };
  const SpecimenShape<dim> shape(widened(p, box, size));
  const auto [lower, upper] = widened_by((sweeps + 2) * reach);
  const Seeds<dim> drawn = draw_seeds<dim>(shape, p.spacing, seed, size_ratio, lower, upper);
  Seeds<dim> seeds;
  for (int i = 0; i < drawn.size(); ++i) // cubes at joined sides reach out of the box
    if (box.image(drawn.centre[i], 0) == std::array<int, dim>{})
      seeds.add(drawn.centre[i], drawn.radius[i], drawn.id[i]);
  const auto wrap = [&] {
    for (Vector<dim> &x : seeds.centre)
      x = box.wrapped(x);
  };
  const double bin = mean_distance<dim>(p.spacing);
  for (int k = 0; k < sweeps; ++k) {
    const double share = share_of_size(size_ratio, k, sweeps);
    const auto [from, to] = widened_by((sweeps + 1 - k) * reach);
    move_to_centroids(seeds, grown(box.with_images(seeds, margin_of(size)), share, bin), shape,
                      p.spacing, bin, from, to, p.spacing);
    wrap();
  }
  keep_off_surfaces(seeds, shape, p.spacing);
  wrap();
  return seeds;
}

template Seeds<2> relaxed_periodic_seeds(const SpecimenParameters<2> &, const PeriodicBox<2> &, int,
                                         double, int);
template Seeds<3> relaxed_periodic_seeds(const SpecimenParameters<3> &, const PeriodicBox<3> &, int,
                                         double, int);
template Seeds<2> relaxed_seeds(const SpecimenShape<2> &, double, int, double, int,
                                const Vector<2> &, const Vector<2> &, const core::Ranks &);
template Seeds<3> relaxed_seeds(const SpecimenShape<3> &, double, int, double, int,
                                const Vector<3> &, const Vector<3> &, const core::Ranks &);
} // namespace ligament::packings
