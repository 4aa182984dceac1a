// Which seeds are near a point, the Laguerre cells of seeds, and how lost cells are healed.
#pragma once

#include "core/ranks.h"
#include "packings/seeds.h"
#include "packings/voronoi_cell.h"

namespace ligament::packings
{
/// Refers to the seeds: they must outlive it, and it must be made anew when they move.
template <int dim>
class PowerDiagram
{
public:
  /// `bin` in m: the mean distance of seeds is good.
  PowerDiagram(const Seeds<dim> &seeds, double bin);

  /// Cuts a cell about seed i by all other seeds; the faces carry the numbers of the seeds. Throws
  /// core::InputError when another seed lies at the same place.
  void cut(VoronoiCell<dim> &cell, int i) const;

  /// visit(j, x_j - x_i, distance) for the seeds around i, bins in order of their distance, as long
  /// as a seed at `lower_bound` may be of interest: go_on(lower_bound). Stops at 12 bins.
  template <typename GoOn, typename Visit>
  void for_each_near(int i, GoOn &&go_on, Visit &&visit) const;

private:
  using Index = Eigen::Matrix<int, dim, 1>;
  Index bin_of(const Vector<dim> &x) const;

  const Seeds<dim> &seeds_;
  double bin_, largest_radius_ = 0;
  Vector<dim> lower_ = Vector<dim>::Zero();
  Index n_bins_ = Index::Ones();
  std::vector<int> first_, seed_in_bin_; // seeds of each bin
  struct Step
  {
    double distance; // between the boxes, in bins
    Index offset;
  };
  std::vector<Step> steps_; // to other bins, nearest first
};

/// A radius much larger than a neighbour's takes the neighbour's centre into its own cell, or all
/// of its cell. Makes such radii smaller, as little as possible, until every seed lies inside its
/// own cell: away from each face by half of its radius, or a quarter of the distance of the two
/// seeds where that is less. Returns how many radii it changed. Of several ranks, which all call it
/// with the same seeds, each looks at its share of them first.
template <int dim>
int heal_radii(Seeds<dim> &seeds, double bin, const core::Ranks &ranks = {});
} // namespace ligament::packings
