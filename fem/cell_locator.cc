#include "fem/cell_map.h"

#include <algorithm>
#include <cmath>

namespace ligament::fem
{
namespace
{
constexpr double tolerance = 1e-10; // of the cell's size

template <int dim, typename Visit>
void for_each_bin(const Vector<dim> &from, const Vector<dim> &to, const Vector<dim> &lower,
                  const Vector<dim> &bin_size, const std::array<int, dim> &n_bins, Visit visit)
{
  std::array<int, dim> begin, end, i;
  for (int k = 0; k < dim; ++k) {
    const auto bin = [&](double x) {
      return std::clamp(int(std::floor((x - lower[k]) / bin_size[k])), 0, n_bins[k] - 1);
    };
    begin[k] = bin(from[k]);
    end[k] = bin(to[k]) + 1;
  }
  for (i = begin; i[dim - 1] < end[dim - 1];) {
    int index = 0;
    for (int k = dim - 1; k >= 0; --k)
      index = index * n_bins[k] + i[k];
    visit(index);
    for (int k = 0; k < dim && (k == 0 || i[k - 1] == end[k - 1]); ++k) {
      if (k > 0)
        i[k - 1] = begin[k - 1];
      ++i[k];
    }
  }
}
} // namespace

template <int dim>
CellLocator<dim>::CellLocator(const Mesh<dim> &mesh) : mesh_(mesh)
{
  Vector<dim> upper;
  lower_.setConstant(INFINITY);
  upper.setConstant(-INFINITY);
  double smallest = INFINITY;
  for (int c = 0; c < mesh.n_cells(); ++c) {
    lower_ = lower_.cwiseMin(mesh.cell_lower[c]);
    upper = upper.cwiseMax(mesh.cell_lower[c] + mesh.cell_size[c]);
    smallest = std::min(smallest, mesh.cell_size[c].minCoeff());
  }
  // Bins as small as the smallest cell, but never many more bins than cells.
  const double edge =
      std::max(smallest, std::pow((upper - lower_).prod() / (4. * mesh.n_cells()), 1. / dim));
  int n = 1;
  for (int k = 0; k < dim; ++k) {
    n_bins_[k] = std::max(1, int((upper[k] - lower_[k]) / edge));
    bin_size_[k] = (upper[k] - lower_[k]) / n_bins_[k];
    n *= n_bins_[k];
  }

  bin_start_.assign(n + 1, 0);
  const auto for_each_bin_of = [&](int c, auto visit) {
    const Vector<dim> margin = tolerance * mesh.cell_size[c];
    for_each_bin<dim>(mesh.cell_lower[c] - margin, mesh.cell_lower[c] + mesh.cell_size[c] + margin,
                      lower_, bin_size_, n_bins_, visit);
  };
  for (int c = 0; c < mesh.n_cells(); ++c)
    for_each_bin_of(c, [&](int bin) { ++bin_start_[bin + 1]; });
  for (int bin = 0; bin < n; ++bin)
    bin_start_[bin + 1] += bin_start_[bin];
  bin_cells_.resize(bin_start_[n]);
  std::vector<int> next(bin_start_.begin(), bin_start_.end() - 1);
  for (int c = 0; c < mesh.n_cells(); ++c)
    for_each_bin_of(c, [&](int bin) { bin_cells_[next[bin]++] = c; });
}

template <int dim>
int CellLocator<dim>::find(const Vector<dim> &p, Vector<dim> *place) const
{
  int bin = 0;
  for (int k = dim - 1; k >= 0; --k) {
    const double x = (p[k] - lower_[k]) / bin_size_[k];
    if (!(x > -1 && x < n_bins_[k] + 1)) // also NaN
      return -1;
    bin = bin * n_bins_[k] + std::clamp(int(std::floor(x)), 0, n_bins_[k] - 1);
  }
  for (int i = bin_start_[bin]; i < bin_start_[bin + 1]; ++i) {
    const int c = bin_cells_[i];
    const Vector<dim> s = (p - mesh_.cell_lower[c]).cwiseQuotient(mesh_.cell_size[c]);
    if (!(s.minCoeff() >= -tolerance && s.maxCoeff() <= 1 + tolerance))
      continue;
    if (mesh_.is_box(c)) {
      if (place)
        *place = s;
      return c;
    }
    const auto inside = unit_place<dim>(cell_corners(mesh_, c), p);
    if (inside && inside->minCoeff() >= -tolerance && inside->maxCoeff() <= 1 + tolerance) {
      if (place)
        *place = *inside;
      return c;
    }
  }
  return -1;
}

template <int dim>
int CellLocator<dim>::nearest(const Vector<dim> &p, double reach) const
{
  const auto outside = [](const Vector<dim> &s) { // of the unit cell
    return std::max({-s.minCoeff(), s.maxCoeff() - 1, 0.});
  };
  int found = -1;
  double least = reach;
  for (int c = 0; c < mesh_.n_cells(); ++c) {
    const Vector<dim> s = (p - mesh_.cell_lower[c]).cwiseQuotient(mesh_.cell_size[c]);
    if (!(outside(s) <= reach))
      continue;
    const auto place =
        mesh_.is_box(c) ? std::optional(s) : unit_place<dim>(cell_corners(mesh_, c), p);
    if (place && outside(*place) < least) {
      least = outside(*place);
      found = c;
    }
  }
  return found;
}

template class CellLocator<2>;
template class CellLocator<3>;
} // namespace ligament::fem
